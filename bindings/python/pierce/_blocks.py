# SPDX-License-Identifier: Apache-2.0
"""Blocks of rays on other processes: the scene by its file, answers as plain columns."""

from __future__ import annotations

import functools
import os
from typing import Any

import numpy as np

from . import _scene
from ._arrays import Array
from ._hits import COLUMNS, TYPES

QUERIES = ("closest", "any", "count")
RAY_COLUMNS = ("ox", "oy", "oz", "dx", "dy", "dz", "t_min", "t_max")


def checked_query(query: str) -> str:
    """The query, if there is one of this name."""
    if query not in QUERIES:
        raise ValueError(f"query is {query!r}; give one of {', '.join(QUERIES)}")
    return query


def file_of(scene: Any) -> tuple[tuple[str, int], np.dtype[Any]]:
    """(path, fingerprint) and type of a scene that is in a file; a path is opened to see."""
    if not isinstance(scene, _scene.Scene):
        scene = _scene.open(scene)
    if scene._file is None or scene._is_changed():
        raise ValueError("the scene is not in a file; save it and give the path")
    return scene._file, scene.dtype


@functools.lru_cache(maxsize=4)
def opened(path: str, fingerprint: int) -> _scene.Scene:
    """The scene, opened once in each process."""
    return _scene._reopen(os.fspath(path), fingerprint)


def types(query: str, real: np.dtype[Any]) -> dict[str, np.dtype[Any]]:
    """The columns of a query's answers."""
    if query == "closest":
        return {name: np.dtype(TYPES.get(name, real)) for name in COLUMNS}
    return {"hit": np.dtype(bool)} if query == "any" else {"hits": np.dtype(np.uint32)}


def answers(scene: _scene.Scene, rays: Array, query: str, threads: int,
            options: dict[str, Any]) -> dict[str, Array]:
    """The columns for a block of rays (n, 6) or (n, 8)."""
    if query == "any":
        return {"hit": scene.any_hit(rays, threads=threads, **options)}
    if query == "count":
        return {"hits": scene.count_hits(rays, threads=threads, **options)}
    hits = scene.closest_hit(rays, threads=threads, **options)
    return {name: getattr(hits, name) for name in COLUMNS}
