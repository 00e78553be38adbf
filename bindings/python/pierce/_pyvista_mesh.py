# SPDX-License-Identifier: Apache-2.0
"""Scenes of pyvista's meshes, kept while these do not change."""

from __future__ import annotations

import atexit
from typing import Any, NamedTuple

import numpy as np

from ._arrays import Array
from ._faces import Kept
from ._mesh import triangles_of_faces, triangles_of_strips
from ._scene import Scene
from ._stand_in import package


class Looks(NamedTuple):
    """What a pyvista.PolyData consists of, as far as its triangles and their numbers go."""

    points: Array
    before: int  #: how many cells are counted before those of faces: vertices and lines
    faces: Array
    strips: Array

    def same(self, other: Looks) -> bool:
        return (self.before == other.before and self.points.dtype == other.points.dtype
                and all(np.array_equal(getattr(self, one), getattr(other, one))
                        for one in ("points", "faces", "strips")))

    def copied(self) -> Looks:
        return Looks(self.points.copy(), self.before, self.faces.copy(), self.strips.copy())


class Surface(Kept):
    """A mesh as it was when it was looked at last, and what was made of it."""

    def __init__(self, looks: Looks, scene: Scene, cell: Array | None):
        super().__init__(scene)
        self.looks = looks
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
    before = getattr(mesh, "n_verts", 0) + getattr(mesh, "n_lines", 0)
    looks = Looks(np.asarray(mesh.points), before, np.asarray(mesh.faces), np.asarray(mesh.strips))
    for known in _recent:
        if known.looks.same(looks):
            return known
    made = _made(looks.copied())
    _recent.insert(0, made)
    del _recent[4:]
    return made


def _made(looks: Looks) -> Surface:
    corners = looks.points.astype(np.float64)
    faces = triangles_of_faces(looks.faces)
    plain = faces is not None and not looks.before and not len(looks.strips)
    if faces is not None:
        cell, count = np.arange(len(faces)), len(faces)
    else:  # polygons, as VTK has them triangulated
        polygons = package("pyvista", "a mesh of polygons").PolyData(corners, faces=looks.faces)
        polygons.cell_data["pierce"] = np.arange(polygons.n_cells)
        split = polygons.triangulate()
        faces = np.asarray(split.faces).reshape(-1, 4)[:, 1:]
        cell = np.asarray(split.cell_data["pierce"])
        corners, count = np.asarray(split.points, np.float64), polygons.n_cells
    if plain:
        return Surface(looks, Scene(corners, faces, copy=False), None)
    more, strip = triangles_of_strips(looks.strips)
    cell = looks.before + np.concatenate([cell, count + strip])
    return Surface(looks, Scene(corners, np.concatenate([faces, more]), copy=False), cell)


def scene_of(mesh: Any) -> Scene:
    """The pierce.Scene, float64, of a pyvista.PolyData: all else that pierce can answer.

    Its triangles are the cells of the mesh if these are all triangles.
    """
    return surface_of(mesh).built
