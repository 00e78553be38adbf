# SPDX-License-Identifier: Apache-2.0
"""The part of pierce.trimesh that asks about points: nearest, distance, thickness."""

from __future__ import annotations

import atexit
import hashlib
from collections import OrderedDict
from typing import Any

import numpy as np

from ._arrays import Array
from ._errors import NotClosed
from ._faces import Kept, refs
from ._scene import Scene

PLANAR = 1e-5  # trimesh.tol.planar: hits nearer than this do not count for longest_ray

_recent: OrderedDict[bytes, Kept] = OrderedDict()  # for meshes that have no cache
atexit.register(_recent.clear)


def _kept(mesh: Any) -> Kept:
    """What is kept for a mesh as long as its vertices and faces are the same."""
    cache: Any = getattr(mesh, "_cache", None)
    if hasattr(cache, "verify"):  # trimesh's, which is emptied when the mesh's hash changes
        kept = cache["pierce"]
        if not isinstance(kept, Kept) or kept.scene is None:
            kept = cache["pierce"] = _made(mesh.vertices, mesh.faces)
        return kept
    vertices, faces = np.ascontiguousarray(mesh.vertices), np.ascontiguousarray(mesh.faces)
    digest = hashlib.blake2b(f"{vertices.shape}{vertices.dtype}{faces.dtype}".encode())
    digest.update(vertices.tobytes())
    digest.update(faces.tobytes())
    key = digest.digest()
    kept = _recent.get(key) or _made(vertices, faces)
    _recent[key] = kept
    while len(_recent) > 4:
        _recent.popitem(last=False)
    return kept


def _made(vertices: Any, faces: Any) -> Kept:
    return Kept(Scene(np.array(vertices, np.float64), np.array(faces), copy=False))


def scene_of(mesh: Any) -> Scene:
    """The pierce.Scene, float64, of a trimesh.Trimesh, built anew when the mesh has changed.

    >>> import types
    >>> scene_of(types.SimpleNamespace(vertices=np.eye(3), faces=[[0, 1, 2]]))
    Scene(float64, 1 triangles)
    """
    return _kept(mesh).built


def _points(points: Any, name: str = "points") -> Array:
    table = np.asarray(points, np.float64)
    if table.size == 0:
        table = table.reshape(0, 3)
    if table.ndim != 2 or table.shape[1] != 3:
        raise ValueError(f"{name} must be (n,3)!")
    return table


def closest_point(mesh: Any, points: Any) -> tuple[Array, Array, Array]:
    """The point of the mesh that is nearest to each point: closest, distance, triangle_id.

    Returns float64 (m, 3), float64 (m,) and int64 (m,), the exact numbers rounded once. Of faces
    that share the nearest point, at an edge or a vertex, the one that the point is most nearly
    above, as in trimesh; then the first. Raises ValueError for another shape and for NaN.

    >>> import types
    >>> roof = types.SimpleNamespace(vertices=[[0, 0, 0], [2, 0, 0], [0, 2, 0], [1, 1, -9]],
    ...                              faces=[[1, 2, 3], [0, 1, 2]])
    >>> closest_point(roof, [[1, 1, 0.5]])[2]
    array([1])
    """
    table = _points(points)
    near, triangle = _nearest(mesh, table)
    return near.point, near.distance, triangle


def _nearest(mesh: Any, table: Array) -> tuple[Any, Array]:
    kept = _kept(mesh)
    scene = kept.built
    near = scene.nearest(table)
    triangle = near.triangle.copy()
    rows = np.flatnonzero((near.feature < 6) & (near.distance > 0) & near.found)
    if not len(rows):
        return near, triangle
    which, found = kept.faces.around(triangle[rows], near.feature[rows])
    away = (table - near.point)[rows][which]
    cosine = np.einsum("ij,ij->i", scene._normals(refs(found)), away)
    cosine[np.isnan(cosine)] = -np.inf  # of faces without area
    order = np.lexsort((found, -cosine, which))
    first = np.flatnonzero(np.diff(which[order], prepend=-1))
    triangle[rows] = found[order][first]
    return near, triangle


def signed_distance(mesh: Any, points: Any) -> Array:
    """The distance of each point to the mesh: positive inside, negative outside, float64.

    Exact, rounded once, for closed meshes: 0 only on the surface. (trimesh has no negative numbers
    nearer than 1e-8, and takes the sign from the nearest face's normal where it can, which is wrong
    for meshes that wind inwards.) For others the nearest face's normal says it, or, where the
    nearest point is on an edge or a vertex, RayMeshIntersector.contains_points.

    >>> import types
    >>> solid = types.SimpleNamespace(vertices=[[0, 0, 0], [4, 0, 0], [0, 4, 0], [0, 0, 4]],
    ...                               faces=[[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]])
    >>> signed_distance(solid, [[1, 1, 0.5], [1, 1, -1e-9]])
    array([ 5.e-01, -1.e-09])
    """
    table = _points(points)
    scene = scene_of(mesh)
    try:
        return np.asarray(0.0 - scene.signed_distance(table))
    except NotClosed:
        pass
    near, triangle = _nearest(mesh, table)
    ahead = np.einsum("ij,ij->i", scene._normals(refs(triangle)), table - near.point)
    inside = ahead < 0
    edge = np.flatnonzero((near.feature < 6) & (near.distance > 0))
    if len(edge):
        from .trimesh import RayMeshIntersector

        inside[edge] = RayMeshIntersector(mesh).contains_points(table[edge])
    return np.asarray(np.where(inside | (near.distance == 0), near.distance, -near.distance))


class ProximityQuery:
    """Asks about points near a mesh, as trimesh.proximity.ProximityQuery does.

    >>> import types
    >>> square = types.SimpleNamespace(vertices=[[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]],
    ...                                faces=[[0, 1, 2], [0, 2, 3]])
    >>> ProximityQuery(square).on_surface([[0.5, 0.25, 2]])
    (array([[0.5 , 0.25, 0.  ]]), array([2.]), array([0]))
    """

    def __init__(self, mesh: Any):
        self._mesh = mesh

    def on_surface(self, points: Any) -> tuple[Array, Array, Array]:
        """closest_point of this mesh."""
        return closest_point(self._mesh, points)

    def vertex(self, points: Any) -> tuple[Array, Array]:
        """The nearest vertex of each point: distance, vertex_id, by trimesh's k-d tree."""
        distance, index = self._mesh.kdtree.query(points)
        return distance, index

    def signed_distance(self, points: Any) -> Array:
        """signed_distance of this mesh."""
        return signed_distance(self._mesh, points)


def longest_ray(mesh: Any, points: Any, directions: Any) -> Array:
    """How far one gets from each point in its direction before the mesh is in the way: (n,).

    In units of the mesh; inf where nothing is. As in trimesh, hits within 1e-5 of the point do not
    count, so that points of the surface can be asked about. Raises ValueError for other shapes.

    >>> import types
    >>> square = types.SimpleNamespace(vertices=[[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]],
    ...                                faces=[[0, 1, 2], [0, 2, 3]])
    >>> longest_ray(square, [[0.5, 0.25, 2], [0.5, 0.25, 0]], [[0, 0, -4], [0, 0, -4]])
    array([ 2., inf])
    """
    table, along = _points(points), _points(directions, "directions")
    if len(table) != len(along):
        raise ValueError("number of points must equal number of directions!")
    length = np.linalg.norm(along, axis=1)
    with np.errstate(all="ignore"):
        start = PLANAR / length
    hits = scene_of(mesh).closest_hit(table, along, start, columns=("t", "triangle"),
                                      open_start=True, invalid="miss")
    return np.asarray(np.where(hits.hit, hits.t * np.where(hits.hit, length, 1), np.inf))


def max_tangent_sphere(mesh: Any, points: Any, inwards: bool = True, normals: Any = None,
                       threshold: float = 1e-6, max_iter: int = 100) -> tuple[Array, Array]:
    """The largest sphere that touches the mesh at each point and lies on one side: centers, radii.

    Args:
        mesh, points: as in closest_point; points of the surface.
        inwards: True: on the side where normals do not point.
        normals: (n, 3) unit normals at the points; None: those of the nearest faces.
        threshold: it ends where a radius shrinks by less than this part of the mesh's diagonal.
        max_iter: steps at most.

    A sphere shrinks until the nearest point to its centre, which is exact, is not inside of it; the
    steps are ordinary float64. Radii are inf, and centers NaN, where nothing is in the way.
    """
    table = _points(points)
    toward = _outward(mesh, table, normals)
    toward = -toward if inwards else toward
    radii = 0.5 * longest_ray(mesh, table, toward)
    vertices = scene_of(mesh).geometries[0][0]
    for i in np.flatnonzero(np.isinf(radii)):  # no hit: start with what is farthest ahead
        span = vertices - table[i]
        ahead = span @ toward[i]
        far = int(ahead.argmax()) if len(ahead) else 0
        if len(ahead) and ahead[far] >= PLANAR:
            radii[i] = (span[far] @ span[far]) / (2 * ahead[far])
    live = np.flatnonzero(np.isfinite(radii))
    smallest = threshold * float(np.linalg.norm(np.ptp(vertices, axis=0))) if len(vertices) else 0
    for _ in range(max_iter):
        if not len(live):
            break
        centers = table[live] + toward[live] * radii[live, None]
        near = scene_of(mesh).nearest(centers)
        live_on = near.distance < np.linalg.norm(centers - table[live], axis=1) - PLANAR
        live, found = live[live_on], near.point[live_on]
        span = found - table[live]
        before = radii[live]
        with np.errstate(all="ignore"):
            radii[live] = (span * span).sum(axis=1) / (2 * (span * toward[live]).sum(axis=1))
        live = live[before - radii[live] >= smallest]
    with np.errstate(invalid="ignore"):
        centers = table + toward * radii[:, None]
    centers[~np.isfinite(radii)] = np.nan
    return centers, radii


def thickness(mesh: Any, points: Any, exterior: bool = False, normals: Any = None,
              method: str = "max_sphere") -> Array:
    """How thick the mesh is at points of its surface, or how far it is to the next wall: (n,).

    Args:
        mesh, points: as in closest_point.
        exterior: True: outwards.
        normals: (n, 3) unit normals; None: those of the nearest faces.
        method: "max_sphere": the diameter of max_tangent_sphere; "ray": longest_ray.

    >>> import types
    >>> solid = types.SimpleNamespace(vertices=[[0, 0, 0], [4, 0, 0], [0, 4, 0], [0, 0, 4]],
    ...                               faces=[[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]])
    >>> thickness(solid, [[1, 1, 0]], method="ray")
    array([2.])
    """
    table = _points(points)
    toward = _outward(mesh, table, normals)
    if method == "max_sphere":
        return 2 * max_tangent_sphere(mesh, table, not exterior, toward)[1]
    if method == "ray":
        return longest_ray(mesh, table, toward if exterior else -toward)
    raise ValueError('Invalid method, use "max_sphere" or "ray"')


def _outward(mesh: Any, table: Array, normals: Any) -> Array:
    if normals is None:
        return scene_of(mesh)._normals(refs(_nearest(mesh, table)[1]))
    given = _points(normals, "normals")
    if len(given) != len(table):
        raise ValueError("number of points must equal number of normals!")
    return given
