# SPDX-License-Identifier: Apache-2.0
"""Scenes as pages for a browser: Scene.view."""

from __future__ import annotations

import html
import os
from typing import TYPE_CHECKING, Any

import numpy as np

from . import _core
from ._arrays import FLOAT32, Array
from ._errors import BadFile
from ._hits import HitLists, Hits
from ._question import NONE, Rays, choice, parse_rays

if TYPE_CHECKING:
    from ._scene import Scene

#: More than a page can be asked to draw.
MOST = 1 << 20


class View:
    """A page for a browser. A notebook shows it; `save` writes it; `html` is its text."""

    def __init__(self, page: bytes, words: str, height: int):
        self._page, self._words, self._height = page, words, height

    @property
    def html(self) -> str:
        """The whole page, which refers to nothing outside of it."""
        return self._page.decode()

    def save(self, path: str | os.PathLike[str]) -> None:
        """Writes the page to a file, .html by custom. Raises BadFile if it cannot be written."""
        try:
            with open(path, "wb") as file:
                file.write(self._page)
        except OSError as error:
            raise BadFile(f"{os.fspath(path)}: {error.strerror}") from None

    def _repr_html_(self) -> str:
        return (f'<iframe title="pierce" srcdoc="{html.escape(self.html)}" width="100%" '
                f'height="{self._height}" style="border: 0" sandbox="allow-scripts"></iframe>')

    def __repr__(self) -> str:
        return f"View({self._words})"


def make_view(scene: Scene, meshes: list[Any], names: list[str], rays: Any, hits: Any, up: str,
              height: int) -> View:
    axis = choice(up, ("y", "z"), "up")
    if hits is not None and not isinstance(hits, Hits):
        raise TypeError("hits are what closest_hit or all_hits gave; there is a "
                        f"{type(hits).__name__}")
    if hits is not None and hits._scene is scene:
        hits._alive("view")
    parsed: Rays | None = None
    if rays is not None:
        parsed = parse_rays(scene.dtype, rays, None, None, None)
    elif hits is not None:
        parsed = hits._rays
    table = _rows(parsed, scene.dtype)
    if parsed is not None and hits is None:
        hits = scene.closest_hit(table)
    numbers, named = _columns(hits, scene.dtype)
    for count, name in ((len(table), "rays"), (len(numbers), "hits")):
        if count > MOST:
            raise ValueError(f"{count} {name} are more than a page shows: give {MOST} or fewer")
    page = _core.view_page_float if scene.dtype == FLOAT32 else _core.view_page_double
    titles = [name.strip(" :,") or f"geometry {i}" for i, name in enumerate(names)]
    triangles = sum(len(mesh[1]) for mesh in meshes)
    found = int((named[:, 2] != NONE).sum())
    words = f"{triangles} triangles" + (f", {len(table)} rays" if parsed is not None else "") + (
        f", {found} hits" if hits is not None else "")
    title = titles[0] if len(titles) == 1 and names[0].strip() else f"Scene of {scene.dtype.name}"
    return View(page(title, axis == 1, meshes, titles, table, numbers, named), words, height)


def _rows(rays: Rays | None, dtype: np.dtype[Any]) -> Array:
    """As the core takes them: (n, 8)."""
    if rays is None:
        return np.empty((0, 8), dtype)
    table = np.empty((rays.count, 8), dtype)
    origins, directions, low, high = rays.parts
    table[:, :3], table[:, 3:6] = origins, directions
    table[:, 6] = 0 if low is None else low
    table[:, 7] = np.inf if high is None else high
    return table


def _columns(hits: Hits | None, dtype: np.dtype[Any]) -> tuple[Array, Array]:
    """t, u, v, w of each hit; and its ray, geometry and triangle."""
    if hits is None:
        return np.empty((0, 4), dtype), np.empty((0, 3), np.uint32)
    columns = [column.reshape(-1) for column in (hits.t, hits.u, hits.v, hits.w)]
    ray = hits.ray if isinstance(hits, HitLists) else hits._row
    names = np.empty((len(columns[0]), 3), np.uint32)
    names[:, 0] = np.arange(len(names)) if ray is None else ray
    names[:, 1:] = hits._refs()
    return np.stack(columns, 1).astype(dtype), names
