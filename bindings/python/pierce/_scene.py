# SPDX-License-Identifier: Apache-2.0
"""Scene: meshes made ready to be asked which triangles rays pierce."""

from __future__ import annotations

from typing import Any, Sequence, Union

import numpy as np

from . import _core, _mesh
from ._arrays import FLOAT32, Array, to_real, whole
from ._filter import Filter, closest, lists
from ._hits import Crossings, HitLists, Hits, Nearest, new_columns, no_hits
from ._question import (NONE, Progress, Question, Rays, choice, control, number, parse_points,
                        parse_question, parse_rays)

QUALITIES = ("fast", "balanced", "high", "compact")
RULES = ("odd", "nonzero")


def _rebuild(dtype: Any, meshes: list[Any], quality: str, masks: Any) -> Scene:
    scene = Scene.__new__(Scene)
    made = [_mesh.Mesh(v, t, m, "") for v, t, m in meshes]
    scene._build(made, dtype, quality, masks, 0, None)
    return scene


class Scene:
    """Meshes made ready to be asked. Every answer is exact for the numbers given.

    Args:
        mesh: vertices (n, 3) with `triangles`; or a tuple (vertices, triangles); or a mesh of
            trimesh, pyvista, Open3D or manifold3d; or the path of a PLY, STL, OBJ or OFF file; or
            the corners of each triangle (n, 3, 3); or a tuple (any of these, 4x4 matrix), which
            places it; or a list of all these, geometry i being the i-th.
        triangles: (n, 3) integers, indices of vertices from 0 on.
        quality: "fast" builds quickest, "high" answers quickest, "compact" takes least memory.
        masks: None, or 32 bits for each geometry: rays with a `mask` see those that share a bit.
        threads: how many to build with; 0: as many as the machine has.
        progress: True shows a bar on stderr; or a function of the fraction done.
        copy: False looks at arrays that already lie right (float32 or float64 vertices, uint32
            triangles, both in one piece) in place; they must then not change.

    float32 vertices make a scene whose rays and answers are float32, float64 one of float64;
    integers count as float64. A mixture raises TypeError: nothing is rounded unasked.

    Raises NonFiniteVertex, IndexOutOfRange, TypeError, ValueError. Threads may share a scene. About
    0.3 s and 60 bytes beside the arrays for a million triangles.

    >>> scene = Scene([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2]])
    >>> scene.closest_hit([0.25, 0.25, 1, 0, 0, -2])
    Hits(t=0.5, u=0.25, v=0.25, w=0.5, geometry=0, triangle=0, facing=0)
    """

    def __init__(self, mesh: Any, triangles: Any = None, *, quality: str = "balanced",
                 masks: Any = None, threads: int = 0, progress: Progress = None,
                 copy: bool = True):
        meshes = _mesh.read_all(mesh, triangles)
        self._build(meshes, _mesh.finish(meshes, copy), quality, masks, threads, progress)

    def _build(self, meshes: list[_mesh.Mesh], dtype: np.dtype[Any], quality: str, masks: Any,
               threads: int, progress: Progress) -> None:
        level = choice(quality, QUALITIES, "quality")
        if masks is not None:
            masks = whole(masks, "masks", 0, NONE).astype(np.uint32).reshape(-1)
            if len(masks) != len(meshes):
                raise ValueError(f"{len(masks)} masks for {len(meshes)} geometries; give one each")
        core: type[Any] = _core.SceneF if dtype == FLOAT32 else _core.SceneD
        self._meshes, self._dtype = meshes, np.dtype(dtype)
        self._quality, self._masks, self._version = quality, masks, 0
        self._core: Union[_core.SceneF, _core.SceneD] = core(
            _core_meshes(meshes), level, masks, control(threads, progress))

    # What it is.

    @property
    def dtype(self) -> np.dtype[Any]:
        """float32 or float64: the type of its vertices, rays and answers."""
        return self._dtype

    @property
    def geometries(self) -> list[tuple[Array, Array]]:
        """(vertices, triangles) of each geometry, not to be written to; before its matrix."""
        return [(mesh.vertices, mesh.triangles) for mesh in self._meshes]

    def info(self) -> dict[str, Any]:
        """Figures: triangles, vertices, degenerate triangles, nodes, leaves, sah_cost, bytes."""
        return dict(self._core.info())

    def __repr__(self) -> str:
        count = sum(len(mesh.triangles) for mesh in self._meshes)
        geometries = f"{len(self._meshes)} geometries, " if len(self._meshes) != 1 else ""
        return f"Scene({self._dtype.name}, {geometries}{count} triangles)"

    def _repr_html_(self) -> str:
        rows = "".join(f"<tr><th>{key}</th><td>{value:,}</td></tr>"
                       for key, value in self.info().items())
        return f"<table><tr><th>type</th><td>{self._dtype.name}</td></tr>{rows}</table>"

    def __reduce__(self) -> Any:
        meshes = [(mesh.vertices, mesh.triangles, mesh.transform) for mesh in self._meshes]
        return _rebuild, (self._dtype, meshes, self._quality, self._masks)

    def update(self, vertices: Any = None, *, transforms: Any = None, threads: int = 0,
               progress: Progress = None, copy: bool = True) -> None:
        """Moves the vertices, or the placed meshes; triangles stay.

        A third of the time of building anew, or less; answers are those of a new scene.
        Queries get slower as neighbours part: build anew when info()["sah_cost"] has doubled.

        Args:
            vertices: (n, 3), in a scene of several geometries a list of these.
            transforms: a list of 4x4 matrices, one for each geometry.

        If it raises, the scene is as it was. Waits for other threads' queries to end.
        """
        meshes = [_mesh.Mesh(m.vertices, m.triangles, m.transform, m.name) for m in self._meshes]
        if vertices is not None:
            several = vertices if len(meshes) != 1 else [vertices]
            if not isinstance(several, list) or len(several) != len(meshes):
                raise ValueError(f"give a list of {len(meshes)} arrays of vertices, one for each "
                                 "geometry")
            for i, (mesh, new) in enumerate(zip(meshes, several)):
                name = mesh.name + "vertices"
                array = to_real(new, self._dtype, name)
                if array.shape != mesh.vertices.shape:
                    raise ValueError(f"{name} have the shape {array.shape}, but there were "
                                     f"{mesh.vertices.shape}; build a new scene")
                mesh.vertices = _mesh.kept(array, self._dtype, copy and array is new)
        if transforms is not None:
            if len(transforms) != len(meshes):
                raise ValueError(f"{len(transforms)} transforms for {len(meshes)} geometries")
            for mesh, matrix in zip(meshes, transforms):
                mesh.transform = _mesh.transform(matrix, mesh.name)
                mesh.place(self._dtype)
        self._core.refit(_core_meshes(meshes), control(threads, progress))
        self._meshes = meshes
        self._version += 1

    # What rays are asked.

    def _parse(self, rays: Any, directions: Any, t_min: Any, t_max: Any, options: dict[str, Any]
               ) -> tuple[Rays, Question]:
        parsed = parse_rays(self._dtype, rays, directions, t_min, t_max)
        return parsed, parse_question(parsed.shape, **options)

    def _closest(self, rays: Rays, question: Question, wanted: Sequence[str] | None = None
                 ) -> dict[str, Array]:
        columns = new_columns(rays.count, self._dtype, wanted)
        if rays.count:
            given = tuple(columns.get(name) for name in
                          ("t", "u", "v", "w", "geometry", "triangle", "facing"))
            self._core.closest_hits(rays.arrays(), given, question.core())
        return columns

    def closest_hit(self, rays: Any, directions: Any = None, t_min: Any = None, t_max: Any = None,
                    *, columns: Sequence[str] | None = None, filter: Filter | None = None,
                    **options: Any) -> Hits:
        """The first hit of each ray: the smallest exact t, then geometry, then triangle.

        Args:
            rays: (..., 6): ox oy oz dx dy dz; or (..., 8): and t_min t_max; or, with
                `directions`, origins (..., 3). Origins, directions, t_min and t_max broadcast.
                Directions need not be unit vectors; t counts in their lengths.
            t_min, t_max: only hits with t_min <= t <= t_max count; 0 and inf if not given.
            columns: which columns are wanted, say ("t", "triangle"); None: all.
            filter: accept(ray, hits) -> bools: which of these hits count. Asked about many rays at
                a time, about each hit in exact order until one is accepted; `ray` is the
                number of each one's ray.
            open_start: True: a hit exactly at t_min does not count.
            sides: "front": only hits of triangles' fronts (entering), "back" (leaving), "both".
            skip: a triangle for each ray, not seen: Hits, (geometry, triangle), or triangle alone.
            after: only hits that come after this triangle's, in exact order; given like skip.
            mask: 32 bits, for all rays or for each; see Scene.
            distinct: True: none at the t of `after` either.
            invalid: "raise", or "miss" for rays that are NaN or have no direction.
            threads, progress: as in Scene.

        Raises InvalidRay, TypeError, ValueError, IndexError. 0.1 to 1 us a ray on one core.

        >>> scene = Scene([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2]])
        >>> hits = scene.closest_hit([[0, 0, 2], [2, 0, 2]], [0, 0, -1])
        >>> hits.t, hits.triangle
        (array([ 2., inf]), array([ 0, -1]))
        """
        parsed, question = self._parse(rays, directions, t_min, t_max, options)
        if filter is not None:
            found = closest(self, parsed, question, filter)
            if columns is not None:
                kept = new_columns(0, self._dtype, columns)
                found = {name: column for name, column in found.items() if name in kept}
        else:
            found = self._closest(parsed, question, columns)
        return Hits(self, parsed, found, parsed.shape)

    def step(self, hits: Hits, **options: Any) -> Hits:
        """The next hit of each ray after the one in `hits`; what missed misses again.

        Loses no hit at equal t; `distinct=True` goes on to the next t. Options: closest_hit's.
        """
        rays, refs = hits._asked(), hits._refs()
        question = parse_question(hits.shape, **options)
        question.after = refs
        live = np.flatnonzero(refs[:, 1] != NONE)
        columns = new_columns(len(refs), self._dtype)
        no_hits(columns)
        found = self._closest(rays.take(live), question.take_at(live))
        for name, column in columns.items():
            column[live] = found[name]
        result = Hits(self, hits._rays, columns, hits.shape, hits._row)
        return result

    def any_hit(self, rays: Any, directions: Any = None, t_min: Any = None, t_max: Any = None,
                *, filter: Filter | None = None, **options: Any) -> Array:
        """Whether each ray hits anything: bool. Arguments: closest_hit's; faster than that."""
        parsed, question = self._parse(rays, directions, t_min, t_max, options)
        if filter is not None:
            return (closest(self, parsed, question, filter)["triangle"] >= 0).reshape(parsed.shape)
        result = np.zeros(parsed.count, np.bool_)
        if parsed.count:
            self._core.any_hits(parsed.arrays(), result.view(np.uint8), question.core())
        return result.reshape(parsed.shape)

    def _all(self, rays: Rays, question: Question) -> HitLists:
        offsets = np.zeros(rays.count + 1, np.int64)
        if not rays.count:
            return HitLists(self, rays, new_columns(0, self._dtype), offsets)
        found = self._core.all_hits(rays.arrays(), offsets, question.core())
        names = ("t", "u", "v", "w", "geometry", "triangle", "facing")
        return HitLists(self, rays, dict(zip(names, found)), offsets)

    def all_hits(self, rays: Any, directions: Any = None, t_min: Any = None, t_max: Any = None,
                 *, filter: Filter | None = None, **options: Any) -> HitLists:
        """Every hit of each ray, in exact order. Arguments: closest_hit's, and

        Args:
            max_hits: of each ray no more than these, the first ones.
            distinct: True: one hit at each exact t, the first.

        >>> scene = Scene([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]], [[0, 1, 2], [0, 2, 3]])
        >>> through_the_edge = [0.25, 0.25, 1, 0, 0, -1]
        >>> scene.all_hits(through_the_edge).triangle
        array([0, 1])
        >>> scene.all_hits(through_the_edge, distinct=True).triangle
        array([0])
        """
        parsed, question = self._parse(rays, directions, t_min, t_max, options)
        if filter is not None:
            return lists(self, parsed, question, filter)
        return self._all(parsed, question)

    def count_hits(self, rays: Any, directions: Any = None, t_min: Any = None, t_max: Any = None,
                   *, filter: Filter | None = None, **options: Any) -> Array:
        """How many hits each ray has: uint32. Arguments: all_hits's without max_hits."""
        _without_max_hits(options, "count_hits")
        parsed, question = self._parse(rays, directions, t_min, t_max, options)
        if filter is not None:
            return lists(self, parsed, question, filter).counts.astype(np.uint32)
        result = np.zeros(parsed.count, np.uint32)
        if parsed.count:
            self._core.count_hits(parsed.arrays(), result, question.core())
        return result.reshape(parsed.shape)

    def crossings(self, rays: Any, directions: Any = None, t_min: Any = None, t_max: Any = None,
                  **options: Any) -> Crossings:
        """How often each ray passes through the surface, each passage once.

        A passage through an edge or a vertex is one, a touch none (or two). Arguments: sides, skip,
        mask, invalid, threads, progress of closest_hit's.
        """
        _without_max_hits(options, "crossings")
        parsed, question = self._parse(rays, directions, t_min, t_max, options)
        n = parsed.count
        found = (np.zeros(n, np.uint32), np.zeros(n, np.int32), np.zeros(n, np.bool_))
        if n:
            self._core.crossings(parsed.arrays(), (found[0], found[1], found[2].view(np.uint8)),
                                 question.core())
        return Crossings(*(column.reshape(parsed.shape) for column in found))

    def next_origin(self, hits: Hits, side: str = "before", *, threads: int = 0,
                    progress: Progress = None) -> Array:
        """Where to start the next ray from each hit, without an epsilon: (..., 3).

        A point next to the hit, on the side where the ray comes from ("before": shadows,
        reflections) or beyond it ("beyond": what passes through), that no triangle parts from it.
        NaN for misses, and where there is no such number. About 2 us.
        """
        beyond = choice(side, ("before", "beyond"), "side") == 1
        refs, rays = hits._refs(), hits._asked()
        points = np.full((len(refs), 3), np.nan, self._dtype)
        if len(refs):
            self._core.next_origins(rays.arrays(), refs, beyond, points,
                                    control(threads, progress))
        return points.reshape((*hits.shape, 3))

    def _hit_points(self, rays: Rays, refs: Array, hit: Array, shape: tuple[int, ...]) -> Array:
        points = np.empty((len(refs), 3), self._dtype)
        if len(refs):
            self._core.hit_points(rays.arrays(), refs, points, control(0, None))
        points[~hit.reshape(-1)] = np.nan
        return points.reshape((*shape, 3))

    def _normals(self, refs: Array, shape: tuple[int, ...]) -> Array:
        normals = np.zeros((len(refs), 3), self._dtype)
        if len(refs):
            self._core.normals(refs, True, normals, control(0, None))
        return normals.reshape((*shape, 3))

    # What points are asked.

    def _point_question(self, rule: str, open_mesh: bool, threads: int, progress: Progress
                        ) -> _core.PointQuestion:
        question = _core.PointQuestion()
        question.non_zero = choice(rule, RULES, "rule") == 1
        question.open_mesh = bool(open_mesh)
        question.control = control(threads, progress)
        return question

    def locate(self, points: Any, *, rule: str = "odd", open_mesh: bool = False, threads: int = 0,
               progress: Progress = None) -> Array:
        """Where each point (..., 3) lies: int8, 1 inside, 0 on the surface, -1 outside. Exact.

        Args:
            rule: what is inside where a surface passes through itself or lies in another one:
                "odd": where a ray leaves through an odd number of surfaces; "nonzero": where the
                surface winds around, so that overlapping solids unite.
            open_mesh: True does not ask whether the mesh is closed.

        Raises NotClosed, naming the first open edge, and InvalidPoint.
        """
        flat, shape = parse_points(self._dtype, points)
        question = self._point_question(rule, open_mesh, threads, progress)
        result = np.zeros(len(flat), np.int8)
        if len(flat):
            self._core.locate(flat, result, question)
        return result.reshape(shape)

    def signed_distance(self, points: Any, *, rule: str = "odd", open_mesh: bool = False,
                        threads: int = 0, progress: Progress = None) -> Array:
        """The distance of each point (..., 3) to the surface, negative inside; rounded once.

        Arguments and errors: locate's. inf in an empty scene.
        """
        flat, shape = parse_points(self._dtype, points)
        question = self._point_question(rule, open_mesh, threads, progress)
        result = np.zeros(len(flat), self._dtype)
        if len(flat):
            self._core.signed_distances(flat, result, question)
        return result.reshape(shape)

    def nearest(self, points: Any, radius: Any = None, *, threads: int = 0,
                progress: Progress = None) -> Nearest:
        """The point of the surface that is nearest to each point (..., 3).

        Args:
            radius: a number, or one for each point: what is farther away does not count.

        Of equally near triangles the smallest (geometry, triangle). About 1 us a point.
        """
        flat, shape = parse_points(self._dtype, points)
        n = len(flat)
        reach = np.full(1, np.inf, self._dtype)
        if radius is not None:
            reach = to_real(radius, self._dtype, "radius")
            if reach.ndim and reach.shape != shape:
                raise ValueError(f"radius has the shape {reach.shape}, the points {shape}")
            reach = np.ascontiguousarray(reach.reshape(-1))
        numbers = {name: np.empty(n, self._dtype) for name in ("distance", "u", "v", "w")}
        columns = {"point": np.empty((n, 3), self._dtype), **numbers,
                   "geometry": np.empty(n, np.int64), "triangle": np.empty(n, np.int64),
                   "feature": np.empty(n, np.uint8)}
        if n:
            self._core.nearest_points(flat, reach, tuple(columns.values()),
                                      control(threads, progress))
        return Nearest(columns, shape)

    def voxelise(self, origin: Any, spacing: Any, shape: Any, *, rule: str = "odd",
                 open_mesh: bool = False, threads: int = 0, progress: Progress = None) -> Array:
        """The closed mesh as a grid: int8 of the given shape (x, y, z), as locate says of each
        cell's centre, `origin + (index + 1/2) spacing`, rounded once.

        Args:
            origin: (3,), the lower corner of the first cell.
            spacing: a number or (3,), from one cell to the next.
            shape: three numbers of cells, each at most 2^21.
        """
        corner = to_real(origin, self._dtype, "origin")
        step = to_real(spacing, self._dtype, "spacing")
        if corner.shape != (3,) or step.shape not in ((), (3,)):
            raise ValueError(f"origin and spacing have the shapes {corner.shape} and {step.shape}; "
                             "give (3,) and (3,), or one spacing")
        if np.shape(shape) != (3,):
            raise ValueError(f"shape is {shape!r}; give three numbers of cells")
        x, y, z = (number(size, "shape", 2**21) for size in shape)
        grid = np.concatenate([corner, np.broadcast_to(step, 3)])
        cells = np.zeros(x * y * z, np.int8)
        if len(cells):
            self._core.voxelise(grid, x, y, z, cells,
                                self._point_question(rule, open_mesh, threads, progress))
        return cells.reshape(x, y, z)


def _without_max_hits(options: dict[str, Any], query: str) -> None:
    if "max_hits" in options:
        raise TypeError(f"{query} has no max_hits")


def _core_meshes(meshes: list[_mesh.Mesh]) -> list[tuple[Array, Array, Array | None]]:
    return [(mesh.vertices, mesh.triangles,
             None if mesh.transform is None else np.ascontiguousarray(mesh.transform))
            for mesh in meshes]
