# SPDX-License-Identifier: Apache-2.0
"""Rows of numbers from files of several formats, so many at a time."""

from __future__ import annotations

import os
from typing import Any, Iterator, NamedTuple, Sequence

import numpy as np

from ._arrays import Array
from ._errors import BadFile, Error
from ._stand_in import package
from ._vectors import count

FORMATS = (".npy", ".npz", ".parquet", ".zarr", ".las", ".laz")


class Table(NamedTuple):
    """Rows (n, k), and when they were measured, if that was asked for."""

    values: Array
    times: Array | None = None


def format_of(path: str) -> str:
    """The ending of the file's name, which says what it is."""
    ending = os.path.splitext(path.rstrip("/"))[1].lower()
    if ending not in FORMATS:
        raise ValueError(f"{path}: ends in {ending!r}; give a file of {' '.join(FORMATS)}")
    return ending


def tables(path: str | os.PathLike[str], kind: tuple[str, Sequence[str], int, int], rows: int,
           times: bool = False) -> Iterator[Table]:
    """The rows of a file, `rows` at a time; with `times` also `gps_time`."""
    name = os.fspath(path)
    ending = format_of(name)
    count(rows, "rows")
    if not os.path.exists(name):
        raise FileNotFoundError(f"{name}: there is no such file")
    reader = {".npy": _npy, ".npz": _npz, ".parquet": _parquet, ".zarr": _zarr}.get(ending, _las)
    try:
        yield from reader(name, kind, rows, times)
    except (Error, ImportError):
        raise
    except MemoryError as error:
        raise MemoryError(f"{name}: {error}; formats but .npz are read {rows} rows at a time"
                          ) from None
    except Exception as error:  # each package has errors of its own for what is damaged
        line = (str(error).splitlines() or [type(error).__name__])[0]
        raise BadFile(f"{name}: cannot be read: {line}") from error


def _no_times(path: str, times: bool) -> None:
    if times:
        raise BadFile(f"{path}: has no gps_time; give origin as points, (3,) or (n, 3)")


def _sliced(path: str, array: Any, kind: tuple[str, Sequence[str], int, int], rows: int
            ) -> Iterator[Table]:
    """An array (..., k), or one of records with these columns."""
    what, names, least, most = kind
    if array.dtype.names is not None:
        given = _chosen(path, array.dtype.names, kind)
        flat = array.reshape(-1)
        for first in range(0, len(flat), rows):
            yield Table(_stacked(path, [flat[name][first:first + rows] for name in given], given))
        return
    width = array.shape[-1] if array.ndim else 0
    if array.ndim < 2 or width not in (least, most) or array.dtype.kind not in "fiu":
        sizes = str(least) if least == most else f"{least} or {most}"
        raise BadFile(f"{path}: holds {array.dtype} of the shape {array.shape}; {what} are numbers "
                      f"of the shape (n, {sizes})")
    flat = array.reshape(-1, width) if array.ndim != 2 else array
    for first in range(0, flat.shape[0], rows):
        yield Table(np.asarray(flat[first:first + rows]))


def _chosen(path: str, there: Sequence[str], kind: tuple[str, Sequence[str], int, int]
            ) -> list[str]:
    what, names, least, most = kind
    given = list(names[:most] if any(name in there for name in names[least:]) else names[:least])
    missing = [name for name in given if name not in there]
    if missing:
        raise BadFile(f"{path}: has no column {missing[0]!r} but {', '.join(there) or 'none'}; "
                      f"{what} have the columns {' '.join(given)}")
    return given


def _stacked(path: str, columns: list[Any], names: Sequence[str]) -> Array:
    for name, column in zip(names, columns):
        if column.ndim != 1 or column.dtype.kind not in "fiu" or len(column) != len(columns[0]):
            raise BadFile(f"{path}: the column {name!r} is {column.dtype} of the shape "
                          f"{column.shape}; give {len(columns[0])} numbers")
    return np.stack([np.asarray(column) for column in columns], axis=1)


def _npy(path: str, kind: Any, rows: int, times: bool) -> Iterator[Table]:
    _no_times(path, times)
    yield from _sliced(path, np.load(path, mmap_mode="r"), kind, rows)


def _npz(path: str, kind: Any, rows: int, times: bool) -> Iterator[Table]:
    _no_times(path, times)
    with np.load(path) as file:
        if not file.files:
            raise BadFile(f"{path}: holds no array; {kind[0]} have the columns "
                          f"{' '.join(kind[1][:kind[2]])}")
        if kind[0] in file or len(file.files) == 1:
            yield from _sliced(path, file[kind[0] if kind[0] in file else file.files[0]], kind,
                               rows)
            return
        given = _chosen(path, file.files, kind)
        whole = _stacked(path, [file[name] for name in given], given)
    yield from _sliced(path, whole, kind, rows)


def _parquet(path: str, kind: Any, rows: int, times: bool) -> Iterator[Table]:
    parquet = package("pyarrow.parquet", "a .parquet file")
    with parquet.ParquetFile(path) as file:
        there = file.schema_arrow.names
        given = _chosen(path, there, kind)
        if times and "gps_time" not in there:
            _no_times(path, times)
        for batch in file.iter_batches(rows, columns=given + ["gps_time"] * times):
            empty = [name for name in batch.schema.names if batch.column(name).null_count]
            if empty:
                raise BadFile(f"{path}: the column {empty[0]!r} has rows without a value; fill "
                              "them or leave them out")
            columns = [batch.column(name).to_numpy(zero_copy_only=False) for name in given]
            yield Table(_stacked(path, columns, given),
                        np.asarray(batch.column("gps_time")) if times else None)


def _zarr(path: str, kind: Any, rows: int, times: bool) -> Iterator[Table]:
    zarr = package("zarr", "a .zarr folder")
    node = zarr.open(path, mode="r")
    if isinstance(node, zarr.Array):
        _no_times(path, times)
        yield from _sliced(path, node, kind, rows)
        return
    given = _chosen(path, sorted(node.array_keys()), kind)
    if times and "gps_time" not in node:
        _no_times(path, times)
    columns = [node[name] for name in given]
    for first in range(0, columns[0].shape[0], rows):
        part = slice(first, first + rows)
        yield Table(_stacked(path, [column[part] for column in columns], given),
                    np.asarray(node["gps_time"][part]) if times else None)


def _las(path: str, kind: Any, rows: int, times: bool) -> Iterator[Table]:
    laspy = package("laspy", "a .las file")
    what, names, least, most = kind
    if what != "points":
        raise BadFile(f"{path}: holds points; say from where the beams came, origin=")
    with laspy.open(path) as file:
        if file.header.are_points_compressed and not laspy.LazBackend.detect_available():
            package("lazrs", "a .laz file")
        count = 0
        for chunk in file.chunk_iterator(rows):
            if times and "gps_time" not in chunk.point_format.dimension_names:
                _no_times(path, times)
            count += len(chunk)
            yield Table(np.stack([np.asarray(chunk[name], np.float64) for name in names], axis=1),
                        np.asarray(chunk["gps_time"], np.float64) if times else None)
        if count != file.header.point_count:
            raise BadFile(f"{path}: is cut short: {count} of {file.header.point_count} points")
