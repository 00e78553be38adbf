# SPDX-License-Identifier: Apache-2.0
"""Rays and points from files, hits and points to files.

    .npy .npz   NumPy
    .parquet    columns; needs pyarrow
    .zarr       an array, or a group of columns; needs zarr 3
    .las .laz   points of lidar scans; needs laspy, and lazrs for .laz

Columns of points are x y z, of rays ox oy oz dx dy dz and perhaps t_min t_max. A .laz may be a
COPC, which is read as the .laz that it is.

>>> import os, tempfile
>>> scene = pierce.Scene([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2]])
>>> with tempfile.TemporaryDirectory() as there:
...     rays, hits = os.path.join(there, "rays.npy"), os.path.join(there, "hits.npz")
...     np.save(rays, [[0.25, 0.25, 2, 0, 0, -1], [9.0, 9, 2, 0, 0, -1]])
...     write_hits(hits, (scene.closest_hit(some) for some in ray_chunks(rays, 1)))
...     np.load(hits)["t"]
array([ 2., inf])
"""

from __future__ import annotations

import math
import os
from typing import Any, Iterable, Iterator

import numpy as np

from ._arrays import POINT_COLUMNS, Array, as_array, by_name, real_type, to_real
from ._blocks import RAY_COLUMNS
from ._file_readers import Table, tables
from ._file_writers import Returns, write
from ._hits import HitLists, Hits

__all__ = ["point_chunks", "ray_chunks", "read_points", "read_rays", "write_hits", "write_points"]

ROWS = 1 << 20


def read_points(path: str | os.PathLike[str], *, dtype: Any = None) -> Array:
    """All points of a file: (n, 3).

    Args:
        path: .npy, .npz, .parquet, .zarr, .las or .laz.
        dtype: float32 or float64; None: float32 if that is what the file has, else float64. Numbers
            are rounded to it. (Coordinates of .las are whole multiples of a step, which laspy gives
            as float64: give that type, and meshes about the same origin.)

    Raises BadFile, FileNotFoundError, ImportError where the package for the format is missing.
    """
    return _joined(list(point_chunks(path, dtype=dtype)), 3, dtype)


def point_chunks(path: str | os.PathLike[str], rows: int = ROWS, *, dtype: Any = None
                 ) -> Iterator[Array]:
    """The points of a file, so many at a time: as read_points, but what is larger than memory."""
    for table in tables(path, ("points", "xyz", 3, 3), rows):
        yield _typed(table.values, dtype)


def read_rays(path: str | os.PathLike[str], *, origin: Any = None, dtype: Any = None) -> Array:
    """All rays of a file: (n, 6), or (n, 8) with t_min and t_max.

    Args:
        path: .npy, .npz, .parquet, .zarr; with `origin` also .las and .laz.
        origin: where the beams of a scan came from, whose points the file has: one point (3,), or
            one for each (n, 3), or a function that is given the times of some beams, `gps_time`,
            and returns where the scanner was, (k, 3). Each ray leads from there to the point as it
            was measured, at t = 1, and on.
        dtype: as in read_points.

    Raises what read_points raises.
    """
    return _joined(list(ray_chunks(path, origin=origin, dtype=dtype)), 6, dtype)


def ray_chunks(path: str | os.PathLike[str], rows: int = ROWS, *, origin: Any = None,
               dtype: Any = None) -> Iterator[Array]:
    """The rays of a file, so many at a time: as read_rays, but what is larger than memory."""
    if origin is None:
        for table in tables(path, ("rays", RAY_COLUMNS, 6, 8), rows):
            yield _typed(table.values, dtype)
        return
    first = 0
    for table in tables(path, ("points", "xyz", 3, 3), rows, times=callable(origin)):
        starts = _starts(origin, table, first)
        first += len(table.values)
        yield _typed(np.hstack([starts, table.values - starts]), dtype)


def write_hits(path: str | os.PathLike[str], hits: Hits | Iterable[Hits], *, points: bool = False,
               scale: float = 0.001, **columns: Any) -> None:
    """Writes hits to a file, which appears when it is complete.

    Args:
        path: .npy (records), .npz, .parquet, .zarr (a group, which must not be there), .las, .laz.
        hits: of closest_hit, a row for each ray; or of all_hits, a row for each hit, with `ray`; or
            many of either, say from a generator over `ray_chunks`: they are written one after the
            other, without keeping them (but for .npy and .npz), and `ray` counts on.
        points: True: also x, y, z, the exact points rounded once. In .las always.
        scale: .las has whole multiples of this, 1 mm in metres.
        columns: more columns, as long as the hits: intensity=..., gps_time=....

    A .las has only what was hit, with `ray` to tell which; from all_hits also the number of each
    return and how many there are, no more than 15 of which it can tell; what has no place in LAS,
    such as t and triangle, is in extra bytes.

    Raises ValueError (also where some have other columns, or numbers of another type, than those
    before), TypeError, BadFile, FileExistsError, OSError, ImportError.
    """
    many = [hits] if isinstance(hits, Hits) else hits
    if not hasattr(many, "__iter__"):
        raise TypeError(f"hits are {type(hits).__name__}; give Hits, or many of them")
    if columns and not isinstance(hits, Hits):
        raise ValueError("more columns go with one Hits; write these in one piece")
    wanted = {name: np.asarray(column) for name, column in columns.items()}
    write(path, _hit_tables(many, points, os.fspath(path), wanted), scale)


def write_points(path: str | os.PathLike[str], points: Any, *, scale: float = 0.001,
                 **columns: Any) -> None:
    """Writes points (n, 3) and what is known of them to a file: columns x y z, and more.

    Args:
        path, scale: as in write_hits.
        points: (..., 3).
        columns: as many numbers each: distance=scene.signed_distance(points).

    Raises what write_hits raises.
    """
    array, _ = as_array(by_name(points, "points", POINT_COLUMNS), "points")
    if array.shape[-1:] != (3,):
        raise ValueError(f"points have the shape {array.shape}; give (..., 3)")
    table = dict(zip("xyz", array.reshape(-1, 3).T))
    _add(table, {name: np.asarray(column) for name, column in columns.items()}, array.shape[:-1])
    write(path, [(table, None)], scale)


def _typed(array: Array, dtype: Any) -> Array:
    kind = real_type([array], ["the file"]) if dtype is None else np.dtype(dtype)
    if kind not in (np.float32, np.float64):
        raise TypeError(f"dtype is {kind.name}; give float32 or float64")
    return array.astype(kind, copy=False)


def _joined(chunks: list[Array], width: int, dtype: Any) -> Array:
    return np.concatenate(chunks) if chunks else np.zeros((0, width), dtype or np.float64)


def _starts(origin: Any, table: Table, first: int) -> Array:
    count = len(table.values)
    if callable(origin):
        starts = to_real(origin(table.times), np.dtype(np.float64), "origin", "the scan")
    else:
        starts = to_real(np.asarray(origin, np.float64), np.dtype(np.float64), "origin", "the scan")
        if starts.shape == (3,):
            return np.broadcast_to(starts, (count, 3))
        starts = starts[first:first + count]
    if starts.shape != (count, 3):
        raise ValueError(f"origin has the shape {starts.shape} for {count} points; give one point, "
                         "or one for each")
    return starts


def _hit_tables(many: Iterable[Hits], points: bool, path: str, more: dict[str, Array]
                ) -> Iterator[tuple[dict[str, Array], Returns]]:
    las = path.lower().endswith((".las", ".laz"))
    first = 0
    kind: type[Hits] | None = None
    for number, hits in enumerate(many):
        if not isinstance(hits, Hits):
            raise TypeError(f"hits {number} are {type(hits).__name__}; give what closest_hit or "
                            "all_hits gave")
        kind = kind or type(hits)
        if type(hits) is not kind:
            raise ValueError(f"hits {number} are {type(hits).__name__}, those before "
                             f"{kind.__name__}; a file holds those of closest_hit or of all_hits")
        returns: Returns = None
        if isinstance(hits, HitLists):
            ray, rays = hits.ray, len(hits.offsets) - 1
            returns = np.arange(len(ray)) - hits.offsets[ray] + 1, np.diff(hits.offsets)[ray]
        else:
            rays = math.prod(hits.shape)
            ray = np.arange(rays)
        table = {"ray": ray + first, **hits._frame()}
        table["ray"] = ray + first
        if points or las:
            table.update(zip("xyz", hits.points.reshape(-1, 3).T))
        _add(table, more, hits.shape)
        if las:
            seen = table["triangle"] >= 0
            table = {name: column[seen] for name, column in table.items()}
        elif not isinstance(hits, HitLists):
            del table["ray"]  # the row says it
        first += rays
        yield table, returns


def _add(table: dict[str, Array], more: dict[str, Array], shape: tuple[int, ...]) -> None:
    for name, column in more.items():
        if name in table:
            raise ValueError(f"there is a column {name!r} already; give it another name")
        if column.shape != shape or column.dtype.kind not in "fiub":
            raise ValueError(f"{name}: {column.dtype} of the shape {column.shape}; give numbers of "
                             f"the shape {shape}")
        table[name] = column.reshape(-1)
