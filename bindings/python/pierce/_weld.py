# SPDX-License-Identifier: Apache-2.0
"""Vertices that are at one place, or nearly, made one."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from . import _core, _mesh
from ._arrays import FLOAT32, Array, as_array
from ._errors import IndexOutOfRange
from ._scene import Scene


@dataclass(frozen=True, eq=False)
class Welded:
    """A mesh as `weld` made it, which Scene, `measure` and others take as it is.

    Attributes:
        vertices: (n, 3) float32 or float64, those that were kept, with their coordinates.
        triangles: (m, 3) uint32, in the order that they had.
        vertex_of: int64, for each vertex that there was: which one it is now.
        collapsed: how many triangles were left out, two corners of which are one vertex now.
        farthest: how far a vertex was moved, at most.
    """

    vertices: Array
    triangles: Array
    vertex_of: Array
    collapsed: int
    farthest: float

    def __repr__(self) -> str:
        return (f"Welded({self.vertices.dtype.name}, {len(self.vertices)} of "
                f"{len(self.vertex_of)} vertices, {len(self.triangles)} triangles)")


def weld(mesh: Any, triangles: Any = None, *, distance: float | None = None) -> Welded:
    """One mesh whose vertices at equal, or nearly equal, positions are one vertex.

    For files that give each triangle corners of its own (STL), and for parts that rounding has put
    apart: what leaked is closed then. A list of meshes becomes one mesh, joined where they touch.

    Args:
        mesh, triangles: as in Scene, also a list, none of them placed by a matrix; or a Scene.
        distance: how far a vertex may move, at most, in the units of the mesh; None or 0: only
            equal positions become one, -0 and 0 being equal.

    In the order of the vertices each becomes the first kept one that is at most `distance` away, or
    else is kept itself. So there are no new coordinates, none moves further than that, kept ones
    are further apart, and the result is the same on every machine. Distances are compared exactly.
    `vertex_of` carries over what is known at the vertices.

    Raises ValueError for a distance that is negative, infinite or NaN, IndexOutOfRange for a
    triangle that names no vertex, and what reading a mesh raises. One core, 0.3 us a vertex.

    >>> import pierce
    >>> corners = [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1e-9, 0], [1, 1, 0], [0, 1, 0]]
    >>> halves = [[0, 1, 2], [3, 4, 5]]
    >>> pierce.weld(corners, halves)
    Welded(float64, 5 of 6 vertices, 2 triangles)
    >>> square = pierce.weld(corners, halves, distance=1e-6)
    >>> square.triangles.tolist(), square.vertex_of.tolist(), square.farthest
    ([[0, 1, 2], [0, 2, 3]], [0, 1, 2, 0, 2, 3], 1e-09)
    >>> pierce.Scene(square)
    Scene(float64, 2 triangles)
    """
    meshes = mesh._meshes if isinstance(mesh, Scene) else _mesh.read_all(mesh, triangles)
    if any(one.transform is not None for one in meshes):
        raise ValueError("a placed mesh cannot be welded, as its vertices would be rounded; give "
                         "vertices where they are")
    if not isinstance(mesh, Scene):
        _mesh.finish(meshes, False)
    vertices, corners = _together(meshes)
    ask = _core.weld_float if vertices.dtype == FLOAT32 else _core.weld_double
    return Welded(*ask(vertices, corners, 0.0 if distance is None else _number(distance)))


def _together(meshes: list[_mesh.Mesh]) -> tuple[Array, Array]:
    if not meshes:
        return np.zeros((0, 3)), np.zeros((0, 3), np.uint32)
    if len(meshes) == 1:
        return meshes[0].vertices, meshes[0].triangles
    count = np.cumsum([0, *(len(one.vertices) for one in meshes)])
    if count[-1] > 2**32 - 1:
        raise ValueError(f"{count[-1]} vertices are more than triangles can name, 2**32 - 1; weld "
                         "fewer meshes at once")
    for one in meshes:  # before their numbers are shifted, which might hide it
        bad = np.flatnonzero((one.triangles >= len(one.vertices)).any(axis=1))
        if len(bad):
            raise IndexOutOfRange(
                f"{one.name}triangles: triangle {bad[0]} names vertex "
                f"{one.triangles[bad[0]].max()}, but there are {len(one.vertices)} vertices; "
                f"{len(bad)} such triangles: drop them, or give indices from 0 on")
    return (np.concatenate([one.vertices for one in meshes]),
            np.concatenate([one.triangles + np.uint32(first)
                            for one, first in zip(meshes, count)]))


def _number(distance: Any) -> float:
    array, _ = as_array(distance, "distance")
    if array.ndim:
        raise ValueError(f"distance has the shape {array.shape}; give one number")
    return float(array)
