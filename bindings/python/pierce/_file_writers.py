# SPDX-License-Identifier: Apache-2.0
"""Columns of numbers to files of several formats, table after table."""

from __future__ import annotations

import errno
import os
import shutil
from typing import Any, Iterable, Iterator, Optional

import numpy as np

from ._arrays import Array
from ._file_readers import format_of
from ._stand_in import package

# Of each row the number of its return, and how many there are.
Returns = Optional["tuple[Array, Array]"]

MOST_RETURNS = 15  # that LAS can tell


def write(path: str | os.PathLike[str], tables: Iterable[tuple[dict[str, Array], Returns]],
          scale: float) -> None:
    """Writes tables of the same columns one after the other, under a temporary name until done."""
    name = os.fspath(path)
    ending = format_of(name)
    tables = _alike(tables)
    temporary = f"{name.rstrip('/')}.{os.getpid()}.part"
    if ending == ".zarr":
        if os.path.exists(name):
            raise FileExistsError(f"{name}: is there already; remove it or give another path")
        try:
            _write_zarr(temporary, tables)
            os.rename(temporary, name)
        finally:
            shutil.rmtree(temporary, ignore_errors=True)
        return
    folder = os.path.dirname(name) or "."
    if not os.path.isdir(folder):
        raise FileNotFoundError(errno.ENOENT, f"there is no folder {folder!r} for the file", name)
    try:
        if ending == ".parquet":
            _write_parquet(temporary, tables)
        elif ending in (".las", ".laz"):
            _write_las(temporary, tables, scale, ending == ".laz")
        else:
            _write_numpy(temporary, tables, ending)
        os.replace(temporary, name)
    except OSError as error:
        if error.filename != temporary:
            raise
        raise type(error)(error.errno, error.strerror, name) from None
    finally:
        if os.path.exists(temporary):
            os.remove(temporary)


def _alike(tables: Iterable[tuple[dict[str, Array], Returns]]
           ) -> Iterator[tuple[dict[str, Array], Returns]]:
    """The same tables, which have all the columns of the first one, of its types."""
    known: dict[str, np.dtype[Any]] | None = None
    for number, (columns, returns) in enumerate(tables):
        types = {name: column.dtype for name, column in columns.items()}
        known = known or types
        if types.keys() != known.keys():
            raise ValueError(f"hits {number} have the columns {' '.join(types)}, those before "
                             f"{' '.join(known)}; give all of them the same")
        for name, kind in types.items():
            if kind != known[name]:
                raise ValueError(f"{name} is {kind.name} in hits {number}, and was "
                                 f"{known[name].name} before; give all of them one type")
        yield columns, returns


def _write_numpy(path: str, tables: Iterable[tuple[dict[str, Array], Returns]], ending: str
                 ) -> None:
    parts = [table for table, _ in tables]
    columns = {name: np.concatenate([part[name] for part in parts])
               for name in (parts[0] if parts else {})}
    with open(path, "wb") as file:
        if ending == ".npz":
            np.savez(file, allow_pickle=False, **columns)
            return
        count = len(next(iter(columns.values()), ()))
        records = np.zeros(count, [(name, column.dtype) for name, column in columns.items()])
        for name, column in columns.items():
            records[name] = column
        np.save(file, records)


def _write_parquet(path: str, tables: Iterable[tuple[dict[str, Array], Returns]]) -> None:
    arrow = package("pyarrow", "a .parquet file")
    parquet = package("pyarrow.parquet", "a .parquet file")
    writer = None
    try:
        for columns, _ in tables:
            table = arrow.table(columns)
            if writer is None:
                writer = parquet.ParquetWriter(path, table.schema)
            writer.write_table(table)
        if writer is None:
            parquet.write_table(arrow.table({}), path)
    finally:
        if writer is not None:
            writer.close()


def _write_zarr(path: str, tables: Iterable[tuple[dict[str, Array], Returns]]) -> None:
    zarr = package("zarr", "a .zarr folder")
    group = zarr.create_group(path)
    for columns, _ in tables:
        for name, column in columns.items():
            if name in group:
                group[name].append(column)
            else:
                size = max(len(column), 1)
                group.create_array(name, shape=column.shape, chunks=(size,), dtype=column.dtype)
                group[name][:] = column


def _write_las(path: str, tables: Iterable[tuple[dict[str, Array], Returns]], scale: float,
               compress: bool) -> None:
    laspy = package("laspy", "a .las file")
    if compress and not laspy.LazBackend.detect_available():
        package("lazrs", "a .laz file")
    writer = None
    header = _las_header(laspy, None, scale)
    try:
        for columns, returns in tables:
            if writer is None:
                header = _las_header(laspy, columns, scale)
                writer = laspy.open(path, mode="w", header=header, do_compress=compress)
            writer.write_points(_las_points(laspy, header, columns, returns))
        if writer is None:
            writer = laspy.open(path, mode="w", header=header, do_compress=compress)
    finally:
        if writer is not None:
            writer.close()


def _las_header(laspy: Any, columns: dict[str, Array] | None, scale: float) -> Any:
    if not scale > 0:
        raise ValueError(f"scale is {scale!r}; give the step of coordinates, such as 0.001")
    header = laspy.LasHeader(version="1.4", point_format=6)
    header.scales = np.full(3, float(scale))
    if columns is None:
        return header
    if len(columns["x"]):
        with np.errstate(invalid="ignore"):
            header.offsets = np.array([np.floor(np.float64(columns[axis].min()))
                                       for axis in "xyz"])
    header.offsets[~np.isfinite(header.offsets)] = 0  # what is wrong is said of the points
    known = set(header.point_format.dimension_names) | set("xyz")
    extra = [laspy.ExtraBytesParams(name, _las_type(name, column.dtype))
             for name, column in columns.items() if name not in known]
    header.add_extra_dims(extra)
    return header


def _las_type(name: str, dtype: np.dtype[Any]) -> np.dtype[Any]:
    if name in ("geometry", "triangle"):
        return np.dtype(np.uint32)  # there are no misses
    return np.dtype(np.uint8) if dtype.kind == "b" else dtype


def _las_points(laspy: Any, header: Any, columns: dict[str, Array], returns: Returns) -> Any:
    count = len(columns["x"])
    points = laspy.ScaleAwarePointRecord.zeros(count, header=header)
    for number, axis in enumerate("xyz"):
        with np.errstate(invalid="ignore", over="ignore"):
            steps = np.asarray(columns[axis], np.float64) - header.offsets[number]
            steps = np.rint(steps / header.scales[number])
            bad = ~(np.abs(steps) < 2**31)
        if bad.any():
            row = int(np.flatnonzero(bad)[0])
            raise ValueError(f"{axis}: {columns[axis][row]} at {row} is no point that LAS can hold "
                             f"in steps of {header.scales[number]:g} from "
                             f"{header.offsets[number]:g}; {int(bad.sum())} such points; give a "
                             "larger scale, or leave them out")
        points[axis.upper()] = steps.astype(np.int32)
    for name, column in columns.items():
        if name in "xyz":
            continue
        points[name] = column
        if not np.array_equal(np.asarray(points[name]), column):
            raise ValueError(f"{name}: there are numbers that LAS does not have in this place, "
                             f"{points[name].dtype}; give the column another name")
    if returns is not None:
        points["return_number"] = np.minimum(returns[0], MOST_RETURNS)
        points["number_of_returns"] = np.minimum(returns[1], MOST_RETURNS)
    return points
