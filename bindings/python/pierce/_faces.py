# SPDX-License-Identifier: Apache-2.0
"""Which faces share a vertex or an edge, and which way the surface looks there."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from ._arrays import Array

if TYPE_CHECKING:
    from ._hits import Nearest
    from ._scene import Scene

# The corners of an edge, and a corner twice, by pierce.Nearest.feature.
_FIRST = np.array([0, 1, 2, 0, 1, 2])
_SECOND = np.array([0, 1, 2, 1, 2, 0])


class Faces:
    """Which faces there are around a vertex; vertices at the same place are one."""

    def __init__(self, vertices: Array, faces: Array):
        order = np.lexsort(vertices.T)
        new = np.ones(len(order), np.bool_)
        new[1:] = (vertices[order[1:]] != vertices[order[:-1]]).any(axis=1)
        place = np.empty(len(order), np.int64)
        place[order] = np.cumsum(new) - 1
        self.corners = place[faces]
        flat = self.corners.reshape(-1)
        self.faces = np.argsort(flat, kind="stable") // 3
        self.starts = np.searchsorted(np.sort(flat), np.arange(len(order) + 1))

    def around(self, face: Array, feature: Array) -> tuple[Array, Array]:
        """Faces that share these features of these faces: (which of those, face)."""
        first = self.corners[face, _FIRST[feature]]
        second = self.corners[face, _SECOND[feature]]
        count = self.starts[first + 1] - self.starts[first]
        which = np.repeat(np.arange(len(face)), count)
        within = np.arange(len(which)) - np.repeat(np.cumsum(count) - count, count)
        found = self.faces[self.starts[first][which] + within]
        keep = (self.corners[found] == second[which, None]).any(axis=1)
        return which[keep], found[keep]


class Kept:
    """What is kept for a mesh while it does not change. Pickled without that: it is made anew."""

    def __init__(self, scene: Scene | None = None):
        self.scene = scene
        self._faces: Faces | None = None

    @property
    def built(self) -> Scene:
        assert self.scene is not None
        return self.scene

    @property
    def faces(self) -> Faces:
        if self._faces is None:
            self._faces = Faces(*self.built.geometries[0])
        return self._faces

    def __reduce__(self) -> Any:
        return Kept, ()


def refs(triangles: Array) -> Array:
    """Triangles of the first geometry, as the core takes them."""
    result = np.zeros((len(triangles), 2), np.uint32)
    result[:, 1] = triangles
    return result


def above(scene: Scene, faces: Faces, near: Nearest, points: Array) -> Array:
    """Whether points are on the side of the surface where its normals point, of an open one too.

    By the normal of the nearest face; at an edge by the sum of both faces', at a vertex by the sum
    of all around it, each times its angle there: the sign is right wherever the surface is a
    manifold. Ordinary float64.
    """
    normals = scene._normals(refs(near.triangle))
    rows = np.flatnonzero(near.feature < 6)
    if len(rows):
        which, found = faces.around(near.triangle[rows], near.feature[rows])
        vertices, triangles = scene.geometries[0]
        weight = np.where((near.feature[rows] < 3)[which],
                          _angles(vertices[triangles[found]], near.point[rows][which]), 1.0)
        part = np.nan_to_num(scene._normals(refs(found))) * weight[:, None]
        for axis in range(3):
            normals[rows, axis] = np.bincount(which, part[:, axis], minlength=len(rows))
    return np.asarray(np.einsum("ij,ij->i", np.nan_to_num(normals), points - near.point) > 0)


def _angles(corners: Array, at: Array) -> Array:
    """The angle of each triangle (n, 3, 3) at the corner that is nearest to `at`."""
    row = np.arange(len(corners))
    corner = np.abs(corners - at[:, None]).sum(axis=2).argmin(axis=1)
    here = corners[row, corner]
    one, two = (corners[row, (corner + step) % 3] - here for step in (1, 2))
    cross = np.linalg.norm(np.cross(one, two), axis=1)
    return np.asarray(np.arctan2(cross, np.einsum("ij,ij->i", one, two)))
