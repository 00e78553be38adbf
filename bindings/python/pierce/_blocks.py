# SPDX-License-Identifier: Apache-2.0
"""Blocks of rays on other processes: the scene by its file, answers as plain columns."""

from __future__ import annotations

import functools
import inspect
import math
import os
from typing import Any

import numpy as np

from . import _scene
from ._arrays import Array, did_you_mean
from ._hits import COLUMNS, TYPES

QUERIES = ("closest", "any", "count")
RAY_COLUMNS = ("ox", "oy", "oz", "dx", "dy", "dz", "t_min", "t_max")


def checked_query(query: str) -> str:
    """The query, if there is one of this name."""
    if query not in QUERIES:
        raise ValueError(f"query is {query!r}; give one of {', '.join(QUERIES)}")
    return query


_OF_EACH = ("self", "rays", "directions", "threads", "columns", "out")


def checked_options(query: str, options: dict[str, Any]) -> dict[str, Any]:
    """The options of a query, if it has them, and if each holds for all rays."""
    method = {"closest": "closest_hit", "any": "any_hit", "count": "count_hits"}[query]
    known = [name for name in inspect.signature(getattr(_scene.Scene, method)).parameters
             if name not in _OF_EACH]
    for name, value in options.items():
        if name not in known:
            raise TypeError(f"{name} is no option here; there are {', '.join(known)}"
                            f"{did_you_mean(name, known)}")
        triangles = name in ("skip", "after")
        if triangles and hasattr(value, "triangle"):  # Hits
            value = value.triangle
        parts = value if triangles and isinstance(value, tuple) else (value,)
        if any(math.prod(getattr(part, "shape", None) or np.shape(part)) != 1 for part in parts):
            cure = ", or rays (n, 8) with t_min and t_max" if name in ("t_min", "t_max") else ""
            raise ValueError(f"{name} is an array, and a block of rays cannot know which of it are "
                             f"its own; give one for all rays{cure}")
    return options


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
