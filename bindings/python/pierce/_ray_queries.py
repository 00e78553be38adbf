# SPDX-License-Identifier: Apache-2.0
"""What rays are asked."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Any, Sequence, cast

import numpy as np

from . import _core
from ._arrays import Array, new_array, shaped
from ._filter import Filter, closest, lists
from ._hits import (COLUMNS, TYPES, Crossings, HitLists, Hits, columns_again, new_columns,
                    no_hits)
from ._question import (NONE, Progress, Question, Rays, choice, control, parse_question,
                        parse_rays)
from ._table import FEW, VECTORS

if TYPE_CHECKING:
    from typing import Union

    from ._scene import Scene


class RayQueries:
    """The part of Scene that answers rays."""

    _core: Union[_core.SceneF, _core.SceneD]
    _dtype: np.dtype[Any]

    def closest_hit(
            self, rays: Any, directions: Any = None, t_min: Any = None, t_max: Any = None, *,
            columns: Sequence[str] | None = None, open_start: bool = False, sides: str = "both",
            skip: Any = None, after: Any = None, mask: Any = None, distinct: bool = False,
            filter: Filter | None = None, invalid: str = "raise", threads: int = 0,
            progress: Progress = None, out: Hits | None = None) -> Hits:
        """The first hit of each ray: the smallest exact t, then geometry, then triangle.

        Args:
            rays: (..., 6): ox oy oz dx dy dz; or (..., 8): and t_min t_max; or, with
                `directions`, origins (..., 3). Origins, directions, t_min and t_max broadcast.
                Directions need not be unit vectors; t counts in their lengths.
            t_min, t_max: only hits with t_min <= t <= t_max count; 0 and inf if not given.
            columns: which columns are wanted, as in ("t", "triangle"), "points" and "normals" too;
                None: all of Hits but these two, which are computed when they are asked for.
            open_start: True: a hit exactly at t_min does not count.
            sides: "front": only hits of triangles' fronts (entering), "back" (leaving), "both".
            skip: a triangle for each ray, not seen: Hits, (geometry, triangle), or triangle alone.
            after: only hits that come after this triangle's, in exact order; given like skip.
            mask: 32 bits, for all rays or for each; see Scene.
            distinct: True: none at the t of `after` either.
            filter: accept(ray, hits) -> bools: which of these Hits count. Asked about many rays at
                a time, about the hits of each in exact order until one is accepted; `ray` has the
                number of each one's ray. Both are read-only. An update from elsewhere waits until
                all is answered, so do not wait for one; in the filter it raises RuntimeError.
            invalid: "raise", or "miss" for rays that are NaN or have no direction.
            threads, progress: as in Scene.
            out: Hits of an earlier call with as many rays, whose arrays are filled anew, and which
                are returned: for many calls, as new arrays cost up to a third of the time of easy
                rays. They may hold anything if the call raises.

        Raises InvalidRay, which names the first bad ray, IndexError, ValueError, TypeError. 0.1 to
        1 us a ray on one core, and no memory but the columns.

        >>> import pierce
        >>> scene = pierce.Scene([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2]])
        >>> hits = scene.closest_hit([[0, 0, 2], [2, 0, 2]], [0, 0, -1])
        >>> hits.t, hits.triangle
        (array([ 2., inf]), array([ 0, -1]))
        """
        parsed = parse_rays(self._dtype, rays, directions, t_min, t_max)
        question = parse_question(
            parsed.shape, open_start=open_start, sides=sides, skip=skip, after=after, mask=mask,
            distinct=distinct, invalid=invalid, threads=threads, progress=progress)
        if out is None and columns is None and filter is None and 0 < parsed.count <= FEW:
            return Hits._of_packed(self._scene(), parsed,
                                   *self._core.closest_packed(parsed.arrays(), question.core()))
        if out is None:
            found = new_columns(parsed.count, self._dtype, columns)
        elif columns is None:
            found = columns_again(out, parsed, self._dtype)
        else:
            raise ValueError("out has its columns; give either")
        if filter is None:
            version = self._fill(parsed, question, found)
        else:
            chosen, version = closest(self._scene(), parsed, question, filter, list(found))
            for name, column in found.items():
                column[...] = chosen[name]
        if out is None:
            return Hits(self._scene(), parsed, found, parsed.shape, version)
        out._start(self._scene(), parsed, found, parsed.shape, version)
        return out

    def any_hit(
            self, rays: Any, directions: Any = None, t_min: Any = None, t_max: Any = None, *,
            open_start: bool = False, sides: str = "both", skip: Any = None, after: Any = None,
            mask: Any = None, distinct: bool = False, filter: Filter | None = None,
            invalid: str = "raise", threads: int = 0, progress: Progress = None) -> Array:
        """Whether each ray hits anything: bool, in the shape of the rays.

        Arguments and errors: closest_hit's. Faster than that, as any triangle will do.

        >>> import pierce
        >>> scene = pierce.Scene([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2]])
        >>> scene.any_hit([[0, 0, 2], [2, 0, 2]], [0, 0, -1], t_max=10)
        array([ True, False])
        """
        parsed = parse_rays(self._dtype, rays, directions, t_min, t_max)
        question = parse_question(
            parsed.shape, open_start=open_start, sides=sides, skip=skip, after=after, mask=mask,
            distinct=distinct, invalid=invalid, threads=threads, progress=progress)
        if filter is not None:
            found, _ = closest(self._scene(), parsed, question, filter, COLUMNS)
            return np.asarray(found["triangle"] >= 0).reshape(parsed.shape)
        result = np.zeros(parsed.count, np.bool_)
        if parsed.count:
            self._core.any_hits(parsed.arrays(), result, question.core())
        return shaped(result, parsed.shape)

    def all_hits(
            self, rays: Any, directions: Any = None, t_min: Any = None, t_max: Any = None, *,
            max_hits: int | None = None, open_start: bool = False, sides: str = "both",
            skip: Any = None, after: Any = None, mask: Any = None, distinct: bool = False,
            filter: Filter | None = None, invalid: str = "raise", threads: int = 0,
            progress: Progress = None) -> HitLists:
        """Every hit of each ray in exact order, as offsets and columns.

        Args:
            max_hits: of each ray no more than these, the first ones; None: all.
            distinct: True: of hits at the same exact t only the first in order counts, the first
                accepted one if there is a filter.

        Otherwise closest_hit's arguments and errors; a filter is asked about all hits at once. A
        ray through an edge hits both its triangles. 49 bytes a hit in float64, 33 in float32.

        >>> import pierce
        >>> square = [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]]
        >>> scene = pierce.Scene(square, [[0, 1, 2], [0, 2, 3]])
        >>> hits = scene.all_hits([[0.5, 0.5, 1], [9, 9, 1], [0.5, 0.2, 1]], [0, 0, -1])
        >>> hits.offsets, hits.triangle, hits.ray
        (array([0, 2, 2, 3]), array([0, 1, 0]), array([0, 0, 2]))
        """
        parsed = parse_rays(self._dtype, rays, directions, t_min, t_max)
        question = parse_question(
            parsed.shape, open_start=open_start, sides=sides, skip=skip, after=after, mask=mask,
            distinct=distinct, invalid=invalid, max_hits=max_hits, threads=threads,
            progress=progress)
        if filter is not None:
            return lists(self._scene(), parsed, question, filter)
        return self._all(parsed, question)

    def count_hits(
            self, rays: Any, directions: Any = None, t_min: Any = None, t_max: Any = None, *,
            open_start: bool = False, sides: str = "both", skip: Any = None, after: Any = None,
            mask: Any = None, distinct: bool = False, filter: Filter | None = None,
            invalid: str = "raise", threads: int = 0, progress: Progress = None) -> Array:
        """How many hits all_hits has: uint32, in the shape of the rays. Its arguments and errors.

        >>> import pierce
        >>> square = [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]]
        >>> scene = pierce.Scene(square, [[0, 1, 2], [0, 2, 3]])
        >>> scene.count_hits([[0.5, 0.5, 1], [9, 9, 1]], [0, 0, -1])
        array([2, 0], dtype=uint32)
        """
        parsed = parse_rays(self._dtype, rays, directions, t_min, t_max)
        question = parse_question(
            parsed.shape, open_start=open_start, sides=sides, skip=skip, after=after, mask=mask,
            distinct=distinct, invalid=invalid, threads=threads, progress=progress)
        if filter is not None:
            return lists(self._scene(), parsed, question, filter).counts.astype(np.uint32)
        result = np.zeros(parsed.count, np.uint32)
        if parsed.count:
            self._core.count_hits(parsed.arrays(), result, question.core())
        return shaped(result, parsed.shape)

    def crossings(
            self, rays: Any, directions: Any = None, t_min: Any = None, t_max: Any = None, *,
            sides: str = "both", skip: Any = None, mask: Any = None, invalid: str = "raise",
            threads: int = 0, progress: Progress = None) -> Crossings:
        """How often each ray passes through the surface, each passage once.

        A passage through an edge or a vertex is one, a touch none (or two). Arguments and errors:
        closest_hit's; of a passage `sides` says "front" (entering) or "back" (leaving). There is no
        filter, as passages are the surface's and not hits: `skip` and `mask` take triangles out.

        >>> import pierce
        >>> square = [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]]
        >>> scene = pierce.Scene(square, [[0, 1, 2], [0, 2, 3]])
        >>> scene.crossings([[0.5, 0.5, 1], [9, 9, 1]], [0, 0, -1]).count
        array([1, 0], dtype=uint32)
        """
        parsed = parse_rays(self._dtype, rays, directions, t_min, t_max)
        question = parse_question(parsed.shape, sides=sides, skip=skip, mask=mask, invalid=invalid,
                                  threads=threads, progress=progress)
        n = parsed.count
        count, signed, on = np.zeros(n, np.uint32), np.zeros(n, np.int32), np.zeros(n, np.bool_)
        if n:
            self._core.crossings(parsed.arrays(), (count, signed, on), question.core())
        return Crossings({"count": count, "signed_count": signed, "origin_on_surface": on},
                         parsed.shape)

    def step(self, hits: Hits, *, columns: Sequence[str] | None = None, sides: str = "both",
             skip: Any = None, mask: Any = None, distinct: bool = False, invalid: str = "raise",
             threads: int = 0, progress: Progress = None) -> Hits:
        """The next hit of each ray after the one in `hits`; what missed misses again.

        Loses no hit at equal t; distinct=True goes on to the next t. Options: closest_hit's. The
        rays are those that `hits` came from, as their arrays are now.

        >>> import pierce
        >>> square = [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]]
        >>> scene = pierce.Scene(square, [[0, 1, 2], [0, 2, 3]])
        >>> hits = scene.closest_hit([[0.5, 0.5, 1], [9, 9, 1]], [0, 0, -1])
        >>> while hits.hit.any():
        ...     print(hits.triangle)
        ...     hits = scene.step(hits)
        [ 0 -1]
        [ 1 -1]
        """
        self._mine(hits, "step")
        rays, refs = hits._asked(), hits._refs()
        question = parse_question(hits.shape, sides=sides, skip=skip, mask=mask, distinct=distinct,
                                  invalid=invalid, threads=threads, progress=progress)
        question = replace(question, after=refs, version=hits._version)
        live = np.flatnonzero(refs[:, 1] != NONE)
        found = new_columns(len(refs), self._dtype, columns)
        no_hits(found)
        some = new_columns(len(live), self._dtype, columns)
        self._fill(rays.take(live), question.take_at(live), some)
        for name, column in found.items():
            column[live] = some[name]
        row = hits._row
        return Hits(self._scene(), hits._rays, found, hits.shape, hits._version, row)

    def next_origin(self, hits: Hits, side: str = "before", *, threads: int = 0,
                    progress: Progress = None) -> Array:
        """Where to start the next ray from each hit, without an epsilon: (..., 3).

        A point next to the hit, on the side where the ray comes from ("before": shadows,
        reflections) or beyond it ("beyond": what passes through), that no triangle parts from it.
        NaN for misses, and where there is no such number. About 2 us.

        >>> import pierce
        >>> scene = pierce.Scene([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2]])
        >>> hits = scene.closest_hit([0.25, 0.25, 1, 0, 0, -1])
        >>> bool(scene.next_origin(hits)[2] > 0), bool(scene.next_origin(hits, "beyond")[2] < 0)
        (True, True)
        """
        self._mine(hits, "next_origin")
        beyond = choice(side, ("before", "beyond"), "side") == 1
        refs, rays = hits._refs(), hits._asked()
        points = np.full((len(refs), 3), np.nan, self._dtype)
        if len(refs):
            self._core.next_origins(rays.arrays(), refs, beyond, points, hits._version,
                                    control(threads, progress))
        return points.reshape((*hits.shape, 3))

    def _scene(self) -> Scene:
        return cast("Scene", self)

    def _mine(self, hits: Hits, name: str) -> None:
        if not isinstance(hits, Hits):
            raise TypeError(f"{name} is given {type(hits).__name__}; give the Hits of a query")
        if hits._alive(name) is not self:
            raise ValueError(f"{name}: these hits are of another scene")

    def _fill(self, rays: Rays, question: Question, columns: dict[str, Array]) -> int:
        """The version of the scene that answered."""
        if not rays.count:
            return self._core.version
        given = tuple(columns.get(name) for name in COLUMNS + VECTORS)
        return self._core.closest_hits(rays.arrays(), given, question.core())

    def _all(self, rays: Rays, question: Question) -> HitLists:
        offsets = np.zeros(rays.count + 1, np.int64)
        if not rays.count:
            return HitLists(self._scene(), rays, new_columns(0, self._dtype), offsets, rays.shape,
                            self._core.version)
        found, version = self._core.all_hits(rays.arrays(), offsets, question.core())
        if isinstance(found, bytearray):
            return HitLists._of_packed_lists(self._scene(), rays, found, offsets, version)
        columns = {name: column.view(TYPES.get(name, self._dtype))
                   for name, column in zip(COLUMNS, found)}
        return HitLists(self._scene(), rays, columns, offsets, rays.shape, version)

    def _hit_points(self, rays: Rays, refs: Array, version: int) -> Array:
        points = new_array((len(refs), 3), self._dtype)
        if len(refs):
            self._core.hit_points(rays.arrays(), refs, points, version, control(0, None))
        return points

    def _normals(self, refs: Array, version: int = 0) -> Array:
        normals = new_array((len(refs), 3), self._dtype)
        if len(refs):
            self._core.normals(refs, True, normals, version, control(0, None))
        return normals
