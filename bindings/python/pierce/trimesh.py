# SPDX-License-Identifier: Apache-2.0
"""trimesh's ray and proximity queries with exact answers.

`install()` once, and every mesh that is made afterwards uses pierce, trimesh's own functions too;
or `mesh.ray = pierce.trimesh.RayMeshIntersector(mesh)` for one. trimesh itself is needed by
`install` and `voxelize` only: the rest takes anything that has `vertices` and `faces`. Checked
against trimesh 5.2.0.

What differs from trimesh, and who is right:

- Every hit is decided exactly for the float64 vertices and rays, locations are the exact points
  rounded once, and directions are not normalised, which would round them. trimesh with Embree
  computes in float32 and steps past each hit by 1e-6 of the mesh's size, so it loses walls thinner
  than that; with its own engine it takes hits up to 1e-6 behind the origin. Both lose rays that
  are within 1e-5 of a triangle's plane:

  >>> import types
  >>> slope = types.SimpleNamespace(vertices=[[0, 0, 0], [9, 0, 0], [0, 9, 0]], faces=[[0, 1, 2]])
  >>> engine = RayMeshIntersector(slope)
  >>> engine.intersects_location([[0.25, 0.25, 1e-6]], [[1, 1, -1e-6]])
  (array([[1.25, 1.25, 0.  ]]), array([0]), array([0]))

- `multiple_hits` has one row for each different exact t, in the order of rays and t, and no limit
  of 100 hits unless `max_hits` says so. trimesh's orders are others, and it promises none.
- `contains_points` is exact for closed meshes; points on the surface are inside. trimesh leaves
  them undefined, asks two rays, and, where they disagree, one in a random direction.
- `signed_distance` has the exact sign and is 0 only on the surface; trimesh's is positive up to
  1e-8 outside, and trusts the normal of the nearest face, which is wrong where faces wind inwards:

  >>> inwards = types.SimpleNamespace(vertices=[[0, 0, 0], [4, 0, 0], [0, 4, 0], [0, 0, 4]],
  ...                                 faces=[[0, 1, 2], [0, 3, 1], [0, 2, 3], [1, 3, 2]])
  >>> signed_distance(inwards, [[1, 1, 0.5]])  # trimesh: -0.5, outside
  array([0.5])

- Vertices that are NaN or infinite in a face raise pierce.NonFiniteVertex, a ValueError.
"""

from __future__ import annotations

import sys
from types import ModuleType
from typing import Any

import numpy as np

from ._arrays import Array
from ._errors import NotClosed
from ._scene import Scene
from ._stand_in import package
from ._trimesh_points import (ProximityQuery, closest_point, longest_ray, max_tangent_sphere,
                              scene_of, signed_distance, thickness)
from .embreex import run

__all__ = ["ProximityQuery", "RayMeshIntersector", "closest_point", "install", "longest_ray",
           "max_tangent_sphere", "scene_of", "signed_distance", "thickness", "uninstall",
           "voxelize"]

# Where a mesh is not closed, the directions that trimesh and pierce look along.
_DIRECTION = np.array([0.4395064455, 0.617598629942, 0.652231566745])
_SECOND = np.array([-0.5577350269, 0.7071067812, 0.4344782195])


class RayMeshIntersector:
    """Asks which faces of a mesh rays meet, as both of trimesh's classes of this name do.

    Args:
        geometry: a trimesh.Trimesh, or anything with `vertices` and `faces`. When the vertices or
            faces change, the next question sees it.
        scale_to_box: as in trimesh; makes no difference.
        mesh: the same as `geometry`.

    Origins and directions are (n, 3) each, of any length, in float64; other shapes raise
    ValueError. Rays that are NaN, or whose directions are zero, miss.

    >>> import types
    >>> square = types.SimpleNamespace(vertices=[[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]],
    ...                                faces=[[0, 1, 2], [0, 2, 3]])
    >>> engine = RayMeshIntersector(square)
    >>> engine.intersects_first([[0.5, 0.5, 2], [5, 5, 2]], [[0, 0, -1], [0, 0, -1]])
    array([ 0, -1])
    """

    _order: tuple[str, ...] = ("multiple_hits", "max_hits", "return_locations")

    def __init__(self, geometry: Any = None, scale_to_box: bool = True, *, mesh: Any = None):
        self.mesh = mesh if geometry is None else geometry
        if self.mesh is None:
            raise TypeError("RayMeshIntersector needs a mesh")
        self._scale_to_box = scale_to_box

    @property
    def scene(self) -> Scene:
        """The pierce.Scene of the mesh as it is now: everything else that pierce can answer."""
        return scene_of(self.mesh)

    def intersects_id(self, ray_origins: Any, ray_directions: Any, *flags: Any,
                      multiple_hits: bool | None = None, max_hits: int | None = None,
                      return_locations: bool | None = None) -> tuple[Array, ...]:
        """The faces that rays meet: index_tri, index_ray[, locations].

        Args:
            multiple_hits: True: one row for each different exact t, in order; False: the first.
            max_hits: of each ray no more than these, the first ones; None: all.
            return_locations: True: (m, 3) points too.
            flags: these by place, in the order of whichever of trimesh's classes the caller had in
                mind: (multiple_hits, max_hits, return_locations) with Embree, or
                (return_locations, multiple_hits) without. A second one that is a bool, or one that
                is given by name as well, tells; a single one is taken as the class takes it that
                is stood in for, with Embree multiple_hits.

        Returns int64 (m,), int64 (m,) and float64 (m, 3), ray after ray.
        """
        named = {"multiple_hits": multiple_hits, "max_hits": max_hits,
                 "return_locations": return_locations}
        self._take(flags, named)
        multiple = named["multiple_hits"] is None or bool(named["multiple_hits"])
        most = named["max_hits"]
        origins, directions = _rays(ray_origins, ray_directions)
        scene = self.scene
        hits: Any
        if multiple:
            hits = scene.all_hits(origins, directions, distinct=True, invalid="miss",
                                  max_hits=None if most is None else int(most))
            ray = hits.ray
        else:
            hits = scene.closest_hit(origins, directions, columns=("triangle",), invalid="miss")
            ray = np.flatnonzero(hits.hit)
            hits = hits[ray]
        if named["return_locations"]:
            return hits.triangle, ray, hits.points
        return hits.triangle, ray

    def _take(self, flags: tuple[Any, ...], named: dict[str, Any]) -> None:
        """Gives flags by place their names."""
        with_embree = ("multiple_hits", "max_hits", "return_locations")
        without = ("return_locations", "multiple_hits")
        order = self._order
        if len(flags) > 1:
            order = without if isinstance(flags[1], (bool, np.bool_)) else with_embree
        elif len(flags) == 1 and named[order[0]] is not None:
            order = without if order == with_embree else with_embree
        if len(flags) > len(order):
            raise TypeError(f"intersects_id takes the flags {', '.join(order)}; {len(flags)} are "
                            "given")
        for name, flag in zip(order, flags):
            if named[name] is not None:
                raise TypeError(f"intersects_id got {name} twice")
            named[name] = flag

    def intersects_location(self, ray_origins: Any, ray_directions: Any,
                            multiple_hits: bool = True, **options: Any
                            ) -> tuple[Array, Array, Array]:
        """Where rays meet the mesh: locations (m, 3), index_ray (m,), index_tri (m,).

        Options: those of intersects_id. Rows as there.
        """
        options["return_locations"] = True
        triangles, rays, locations = self.intersects_id(ray_origins, ray_directions,
                                                        multiple_hits=multiple_hits, **options)
        return locations, rays, triangles

    def intersects_first(self, ray_origins: Any, ray_directions: Any, **options: Any) -> Array:
        """The first face that each ray meets, -1 for none: int64 (n,)."""
        hits = self.scene.closest_hit(*_rays(ray_origins, ray_directions), columns=("triangle",),
                                      invalid="miss")
        return hits.triangle

    def intersects_any(self, ray_origins: Any, ray_directions: Any, **options: Any) -> Array:
        """Whether each ray meets the mesh: bool (n,)."""
        return self.scene.any_hit(*_rays(ray_origins, ray_directions), invalid="miss")

    def contains_points(self, points: Any) -> Array:
        """Which points (n, 3) are inside: bool (n,); on the surface counts as inside.

        Exact for closed meshes, by parity: where a mesh overlaps itself is outside. Of one that is
        not closed nothing is inside for sure; as in trimesh, what two opposite rays say if they
        agree, and if not, what another one says unless one of the two met nothing. NaN is outside.
        """
        table = np.asarray(points, np.float64)
        if table.size == 0:
            table = table.reshape(0, 3)
        if table.ndim != 2 or table.shape[1] != 3:
            raise ValueError("points must be (n,3)")
        good = np.isfinite(table).all(axis=1)
        result = np.zeros(len(table), np.bool_)
        scene = self.scene
        if len(scene.geometries[0][1]):
            try:
                result[good] = scene.locate(table[good]) >= 0
            except NotClosed:
                result[good] = _inside_open(scene, table[good])
        return result

    @property
    def _scale(self) -> float:
        return 1.0

    @property
    def _scene(self) -> _Run:
        return _Run(self)

    @property
    def _cache(self) -> Any:
        return self.mesh._cache

    def __copy__(self, *args: Any) -> RayMeshIntersector:
        return type(self)(self.mesh, self._scale_to_box)

    __deepcopy__ = __copy__


class _TriangleOrder(RayMeshIntersector):
    """Stands in for the class of trimesh.ray.ray_triangle, whose flags have another order."""

    _order = ("return_locations", "multiple_hits")


class _Run:
    """What programs find at `mesh.ray._scene`: embreex's `run`, in the mesh's units."""

    def __init__(self, engine: RayMeshIntersector):
        self._engine = engine

    def run(self, origins: Any, normals: Any, **options: Any) -> Any:
        """EmbreeScene.run of float64; see pierce.embreex."""
        return run(self._engine.scene, np.asarray(origins, np.float64),
                   np.asarray(normals, np.float64), **options)


def _rays(origins: Any, directions: Any) -> tuple[Array, Array]:
    o, d = np.asarray(origins, np.float64), np.asarray(directions, np.float64)
    if o.shape != d.shape:
        raise ValueError(f"Ray origin and direction don't match! {o.shape} and {d.shape}")
    if o.size == 0:
        o, d = o.reshape(0, 3), d.reshape(0, 3)
    if o.ndim != 2 or o.shape[1] != 3:
        raise ValueError(f"ray origins and directions have the shape {o.shape}, not (n, 3)")
    return o, d


def _inside_open(scene: Scene, points: Array) -> Array:
    ahead = scene.crossings(points, _DIRECTION).count
    behind = scene.crossings(points, -_DIRECTION).count
    inside = np.asarray(ahead % 2 == 1)
    unsure = np.flatnonzero((inside != (behind % 2 == 1)) & (ahead > 0) & (behind > 0))
    inside &= behind % 2 == 1
    if len(unsure):
        inside[unsure] = scene.crossings(points[unsure], _SECOND).count % 2 == 1
    return inside


def voxelize(mesh: Any, pitch: float, **options: Any) -> Any:
    """The closed mesh as a solid trimesh.voxel.VoxelGrid; needs trimesh.

    Args:
        mesh: as in RayMeshIntersector.
        pitch: the edge of a voxel.
        options: none yet; trimesh passes what it is given.

    A voxel is filled if its centre, a multiple of the pitch, is inside or on the surface: exactly.
    trimesh's own voxelizers fill those that the surface passes through. After `install()`
    `mesh.voxelized(pitch, method="pierce")` does the same. Raises pierce.NotClosed.
    """
    if options:
        raise TypeError(f"voxelize has no option {next(iter(options))!r}")
    base = package("trimesh.voxel.base", "pierce.trimesh.voxelize")
    scene, step = scene_of(mesh), float(pitch)
    if not step > 0:
        raise ValueError(f"pitch is {pitch}; give a positive number")
    vertices, faces = scene.geometries[0]
    if not len(faces):
        raise ValueError("the mesh has no faces")
    used = vertices[faces].reshape(-1, 3)
    low = np.floor(used.min(axis=0) / step)
    shape = (np.ceil(used.max(axis=0) / step) - low + 1).astype(np.int64).tolist()
    cells = scene.voxelise((low - 0.5) * step, step, shape) >= 0
    transform = np.diag([step, step, step, 1.0])
    transform[:3, 3] = low * step
    return base.VoxelGrid(cells, transform=transform)


_ORIGINALS: list[tuple[Any, str, Any]] = []
_MISSING = object()


def _set(where: Any, name: str, value: Any) -> None:
    _ORIGINALS.append((where, name, getattr(where, name, _MISSING)))
    setattr(where, name, value)


def install() -> None:
    """Makes trimesh use pierce, until `uninstall`: for every mesh that is made from now on.

    `mesh.ray`, `mesh.contains`, `mesh.nearest`, the functions of trimesh.proximity and what calls
    them, and `mesh.voxelized(pitch, method="pierce")`. With `use_embree=False` too; embreex need
    not be installed. Meshes made before keep the `ray` that they have.
    """
    if _ORIGINALS:
        return
    what = "pierce.trimesh.install"
    ray, proximity = package("trimesh.ray", what), package("trimesh.proximity", what)
    if isinstance(ray.ray_pyembree, ModuleType):
        _set(ray.ray_pyembree, "RayMeshIntersector", RayMeshIntersector)
    else:
        module = ModuleType("trimesh.ray.ray_pyembree")
        module.RayMeshIntersector = RayMeshIntersector  # type: ignore[attr-defined]
        _set(ray, "ray_pyembree", module)
        sys.modules[module.__name__] = module
    _set(ray, "has_embree", True)
    _set(ray.ray_triangle, "RayMeshIntersector", _TriangleOrder)
    for function in (ProximityQuery, closest_point, longest_ray, max_tangent_sphere,
                     signed_distance, thickness):
        _set(proximity, function.__name__, function)
    package("trimesh.voxel.creation", what).voxelizers["pierce"] = voxelize


def uninstall() -> None:
    """Undoes `install`. Meshes that were made in between keep pierce."""
    while _ORIGINALS:
        where, name, value = _ORIGINALS.pop()
        setattr(where, name, value)
        if name == "ray_pyembree":
            sys.modules.pop("trimesh.ray.ray_pyembree", None)
    creation = sys.modules.get("trimesh.voxel.creation")
    if creation is not None:
        creation.voxelizers._dict.pop("pierce", None)
