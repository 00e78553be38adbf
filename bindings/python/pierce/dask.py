# SPDX-License-Identifier: Apache-2.0
"""Rays in Dask arrays, cast block by block where the blocks are.

The scene is a file (`Scene.save`, `pierce build`) that every worker sees; each process opens it
once and shares its pages with the others. Only its path is in the graph.
"""

from __future__ import annotations

import functools
import importlib
import os
from typing import Any

import numpy as np

from . import _scene
from ._arrays import Array

QUERIES = ("closest", "any", "count")


def cast(scene: Any, rays: Any, *, query: str = "closest", threads: int = 1, **options: Any) -> Any:
    """The answers for a Dask array of rays, as a Dask array.

    Args:
        scene: the path of a scene file, or a Scene that `pierce.open` opened.
        rays: a Dask array (n, 6) or (n, 8), as in Scene.closest_hit, in chunks along n alone;
            float32 for a scene of float32.
        query: "closest": records of t, u, v, w, geometry, triangle, facing; "any": bool; "count":
            uint32.
        threads: how many each block takes; 1 as Dask has its own.
        options: those of closest_hit, any_hit or count_hits that are the same for all rays.

    Nothing is cast until the array is computed, or stored, say to zarr. Raises ValueError,
    TypeError; when it is computed what the query raises, and BadFile if the file is not the one
    that it was.
    """
    if query not in QUERIES:
        raise ValueError(f"query is {query!r}; give one of {', '.join(QUERIES)}")
    if not isinstance(scene, _scene.Scene):
        scene = _scene.open(scene)
    if scene._file is None or scene._version != 0:
        raise ValueError("the scene is not in a file; save it and give the path")
    if rays.ndim != 2 or rays.shape[1] not in (6, 8):
        raise ValueError(f"rays have the shape {rays.shape}; give (n, 6) or (n, 8)")
    array = importlib.import_module("dask.array")
    dtype = _dtype(query, scene.dtype)
    whole = rays.rechunk({1: -1})
    return array.map_blocks(_cast_block, whole, *scene._file, query, threads, options, dtype=dtype,
                            drop_axis=1, meta=np.empty(0, dtype))


def _dtype(query: str, real: np.dtype[Any]) -> np.dtype[Any]:
    if query != "closest":
        return np.dtype(bool if query == "any" else np.uint32)
    return np.dtype([("t", real), ("u", real), ("v", real), ("w", real), ("geometry", np.int64),
                     ("triangle", np.int64), ("facing", np.uint8)])


@functools.lru_cache(maxsize=4)
def _opened(path: str, fingerprint: int) -> _scene.Scene:
    return _scene._reopen(path, fingerprint)


def _cast_block(rays: Array, path: str, fingerprint: int, query: str, threads: int,
                options: dict[str, Any]) -> Array:
    scene = _opened(os.fspath(path), fingerprint)
    if query == "any":
        return np.asarray(scene.any_hit(rays, threads=threads, **options))
    if query == "count":
        return np.asarray(scene.count_hits(rays, threads=threads, **options)).astype(np.uint32)
    hits = scene.closest_hit(rays, threads=threads, **options)
    records = np.zeros(len(rays), _dtype(query, scene.dtype))
    for name in records.dtype.names or ():
        records[name] = getattr(hits, name)
    return records
