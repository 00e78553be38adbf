# SPDX-License-Identifier: Apache-2.0
"""Rays in Dask arrays, cast block by block where the blocks are; from zarr, to zarr.

The scene is a file (`Scene.save`, `pierce build`) that every worker sees; each process opens it
once and shares its pages with the others. Only its path is in the graph.
"""

from __future__ import annotations

import os
from typing import Any

import numpy as np

from ._arrays import Array
from ._blocks import answers as answers_of
from ._blocks import checked_options, checked_query, file_of, opened, types
from ._stand_in import package


def cast(scene: Any, rays: Any, *, query: str = "closest", threads: int = 1, **options: Any) -> Any:
    """The answers for a Dask array of rays, as a Dask array.

    Args:
        scene: the path of a scene file, or a Scene that `pierce.open` opened.
        rays: a Dask array (n, 6) or (n, 8), as in Scene.closest_hit, in chunks along n alone;
            float32 for a scene of float32; a NumPy array is cut into chunks. Or the path of a zarr
            array of them.
        query: "closest": records of t, u, v, w, geometry, triangle, facing; "any": bool; "count":
            uint32.
        threads: how many each block takes; 1 as Dask has its own.
        options: those of closest_hit, any_hit or count_hits that are the same for all rays. Ranges
            of their own are columns of rays (n, 8).

    Nothing is cast until the array is computed, or stored: see `store`. Raises ValueError,
    TypeError; when it is computed what the query raises, and BadFile if the file is not the one
    that it was.
    """
    checked_options(checked_query(query), options)
    file, real = file_of(scene)
    array = package("dask.array", "pierce.dask")
    if isinstance(rays, (str, os.PathLike)):
        rays = array.from_zarr(os.fspath(rays))
    elif isinstance(rays, np.ndarray):
        rays = array.from_array(rays)
    elif not isinstance(rays, array.Array):
        raise TypeError(f"rays are {type(rays).__name__}; give a Dask array, say "
                        "dask.array.from_array(np.asarray(rays)), or the path of a zarr array")
    if rays.ndim != 2 or rays.shape[1] not in (6, 8):
        raise ValueError(f"rays have the shape {rays.shape}; give (n, 6) or (n, 8)")
    dtype = _dtype(query, real)
    whole = rays.rechunk({1: -1})
    return array.map_blocks(_cast_block, whole, *file, query, threads, options, dtype=dtype,
                            drop_axis=1, meta=np.empty(0, dtype))


def store(answers: Any, path: str | os.PathLike[str], *, compute: bool = True) -> Any:
    """Computes what `cast` gave and writes it to zarr, each block where it is cast.

    Args:
        answers: of `cast`. Records become a group with an array for each column, others an array.
        path: the zarr group or array, which is made.
        compute: False: what this returns does it, when it is computed.

    A block is cast once, for all columns, and written by who cast it; a worker that dies costs the
    blocks that it had. Raises FileExistsError if the path is there.
    """
    array = package("dask.array", "pierce.dask.store")
    zarr = package("zarr", "pierce.dask.store")
    name = os.fspath(path)
    if os.path.exists(name):
        raise FileExistsError(f"{name}: is there already; remove it or give another path")
    size = max(answers.chunks[0], default=1) or 1
    even = answers.rechunk(size)  # as workers must not share a chunk of zarr
    if answers.dtype.names is None:
        target = zarr.create_array(name, shape=even.shape, chunks=(size,), dtype=even.dtype)
        return array.store(even, target, lock=False, compute=compute)
    group = zarr.create_group(name)
    targets = [group.create_array(column, shape=even.shape, chunks=(size,),
                                  dtype=even.dtype[column]) for column in even.dtype.names]
    return array.store([even[column] for column in even.dtype.names], targets, lock=False,
                       compute=compute)


def _dtype(query: str, real: np.dtype[Any]) -> np.dtype[Any]:
    columns = types(query, real)
    return np.dtype(list(columns.items())) if query == "closest" else next(iter(columns.values()))


def _cast_block(rays: Array, path: str, fingerprint: int, query: str, threads: int,
                options: dict[str, Any]) -> Array:
    scene = opened(path, fingerprint)
    columns = answers_of(scene, rays, query, threads, options)
    if query != "closest":
        return next(iter(columns.values()))
    records = np.zeros(len(rays), _dtype(query, scene.dtype))
    for name, column in columns.items():
        records[name] = column
    return records
