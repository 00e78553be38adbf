# SPDX-License-Identifier: Apache-2.0
"""Scenes of pyvista's meshes, kept while these do not change."""

from __future__ import annotations

import atexit
from typing import Any

import numpy as np

from ._arrays import Array
from ._faces import Kept
from ._scene import Scene


class Surface(Kept):
    """A mesh as it was when it was looked at last, and what was made of it."""

    def __init__(self, points: Array, cells: Array, scene: Scene, cell: Array | None):
        super().__init__(scene)
        self.points, self.cells = points, cells
        self.cell = cell  #: the mesh's cell of each triangle, None if they are the same

    def cells_of(self, triangle: Array) -> Array:
        return triangle if self.cell is None else self.cell[triangle]


_recent: list[Surface] = []
atexit.register(_recent.clear)


def surface_of(mesh: Any) -> Surface:
    """A pyvista.PolyData as it is now; of the last four, what was made of it before."""
    if not hasattr(mesh, "faces") or not hasattr(mesh, "n_open_edges"):
        raise TypeError(f"{type(mesh).__name__} is no surface; give a PolyData: "
                        "mesh.extract_surface()")
    points = np.asarray(mesh.points)
    cells = np.concatenate([np.asarray(mesh.faces), np.asarray(mesh.strips)])
    for known in _recent:
        if (known.points.dtype == points.dtype and np.array_equal(known.points, points)
                and np.array_equal(known.cells, cells)):
            return known
    made = _made(mesh, points.copy(), cells.copy())
    _recent.insert(0, made)
    del _recent[4:]
    return made


def _made(mesh: Any, points: Array, cells: Array) -> Surface:
    corners = points.astype(np.float64)
    plain = mesh.n_cells == 0 or (mesh.is_all_triangles and not len(mesh.strips)
                                  and 4 * mesh.n_cells == len(mesh.faces))
    if plain:
        triangles = np.asarray(mesh.faces).reshape(-1, 4)[:, 1:]
        return Surface(points, cells, Scene(corners, triangles, copy=False), None)
    numbered = mesh.copy(deep=False)
    numbered.clear_data()
    numbered.cell_data["pierce"] = np.arange(mesh.n_cells)
    split = numbered.triangulate()
    triangles = np.asarray(split.faces).reshape(-1, 4)[:, 1:]
    scene = Scene(np.asarray(split.points, np.float64), triangles)
    return Surface(points, cells, scene, np.asarray(split.cell_data["pierce"]))


def scene_of(mesh: Any) -> Scene:
    """The pierce.Scene, float64, of a pyvista.PolyData: all else that pierce can answer.

    Its triangles are the cells of the mesh if these are all triangles.
    """
    return surface_of(mesh).built
