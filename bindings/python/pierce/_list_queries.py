# SPDX-License-Identifier: Apache-2.0
"""What points, segments and boxes are asked that may have several answers each."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from . import _core
from ._hits import Nearest
from ._lists import NearestLists, TriangleLists, padded
from ._question import Progress, control, number, parse_points, parse_radius

if TYPE_CHECKING:
    from typing import Union

NEAREST = ("point", "distance", "u", "v", "w", "geometry", "triangle", "feature")
MOST = 2**64 - 1
ALWAYS = 1000  # so many are made room for, however few triangles there are


class ListQueries:
    """The part of Scene that answers with lists of triangles."""

    _core: Union[_core.SceneF, _core.SceneD]
    _dtype: np.dtype[Any]

    def _near(self, points: Any, most: int, radius: Any, threads: int, progress: Progress
              ) -> NearestLists:
        flat, shape = parse_points(self._dtype, points)
        reach = parse_radius(self._dtype, radius, shape)
        if len(reach) != 1 and not len(flat):  # no points, no radii
            reach = np.zeros(1, self._dtype)
        offsets = np.zeros(len(flat) + 1, np.int64)
        columns = self._core.nearest_triangles(flat, most, reach, offsets,
                                               control(threads, progress))
        return NearestLists(dict(zip(NEAREST, columns)), offsets, shape)

    def k_nearest(self, points: Any, k: int, radius: Any = None, *, threads: int = 0,
                  progress: Progress = None) -> Nearest:
        """The k triangles nearest to each point (..., 3), and their nearest points: (..., k).

        Args:
            k: how many, the nearest first; in order of the exact distances, then of (geometry,
                triangle).
            radius: as in `nearest`.
            threads, progress: as in Scene.

        Where there are fewer, distance is inf, geometry and triangle are -1 and the point NaN.
        Raises InvalidPoint, ValueError for a negative radius and for a k above both 1000 and the
        number of triangles, TypeError. About 10 us a point for k = 8.

        >>> import pierce
        >>> scene = pierce.Scene([[0, 0, 0], [4, 0, 0], [0, 4, 0], [0, 0, 4]],
        ...                      [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]])
        >>> near = scene.k_nearest([[1, 2, -1], [0.5, 1, 1]], 2)
        >>> near.triangle.tolist(), near.distance[1].round(3)
        ([[0, 3], [2, 3]], array([0.5  , 0.866]))
        """
        most = number(k, "k", 2**31 - 1)
        there = sum(len(mesh.triangles) for mesh in self._core.known)
        if most > max(there, ALWAYS):
            raise ValueError(f"k is {most}, but the scene has {there} triangles; give no more")
        return padded(self._near(points, most, radius, threads, progress), most)

    def within(self, points: Any, radius: Any, *, threads: int = 0, progress: Progress = None
               ) -> NearestLists:
        """All triangles that are no farther from each point (..., 3) than the radius, exactly.

        Args:
            radius: a number, or one for each point. What is exactly so far away counts.
            threads, progress: as in Scene.

        Nearest first, in the order of `k_nearest`. Raises what that raises.

        >>> import pierce
        >>> scene = pierce.Scene([[0, 0, 0], [4, 0, 0], [0, 4, 0], [0, 0, 4]],
        ...                      [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]])
        >>> near = scene.within([[1, 1, -1], [9, 9, 9]], 1)
        >>> near
        NearestLists(queries=2, rows=1)
        >>> near.counts.tolist(), near.of(0).triangle.tolist()
        ([1, 0], [0])
        """
        if radius is None:
            raise TypeError("radius is None; give a number, or one for each point")
        return self._near(points, MOST, radius, threads, progress)

    def _touching(self, query: Any, first: Any, second: Any, names: tuple[str, str],
                  threads: int, progress: Progress) -> TriangleLists:
        one, shape = parse_points(self._dtype, first, names[0])
        other, other_shape = parse_points(self._dtype, second, names[1])
        if shape != other_shape:
            raise ValueError(f"{names[0]} and {names[1]} have the shapes {(*shape, 3)} and "
                             f"{(*other_shape, 3)}; give as many of each")
        offsets = np.zeros(len(one) + 1, np.int64)
        geometry, triangle = query(one, other, offsets, control(threads, progress))
        return TriangleLists({"geometry": geometry, "triangle": triangle}, offsets, shape)

    def touching_segments(self, starts: Any, ends: Any, *, threads: int = 0,
                          progress: Progress = None) -> TriangleLists:
        """The triangles that have a point in common with each closed segment, exactly.

        Args:
            starts, ends: (..., 3); they may be the same point.
            threads, progress: as in Scene.

        Touching counts, in line with the segment as well. (Where along the segment is a question
        for rays: all_hits of rays.between.) Raises InvalidPoint, ValueError, TypeError.

        >>> import pierce
        >>> scene = pierce.Scene([[0, 0, 0], [4, 0, 0], [0, 4, 0], [0, 0, 4]],
        ...                      [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]])
        >>> touched = scene.touching_segments([[1, 1, -1], [1, 1, 1]], [[1, 1, 0], [1, 1, 1.5]])
        >>> touched.counts.tolist(), touched.of(0).tolist()
        ([1, 0], [[0, 0]])
        """
        return self._touching(self._core.touching_segments, starts, ends, ("starts", "ends"),
                              threads, progress)

    def touching_boxes(self, lower: Any, upper: Any, *, threads: int = 0,
                       progress: Progress = None) -> TriangleLists:
        """The triangles that have a point in common with each closed box, exactly.

        Args:
            lower, upper: (..., 3), opposite corners. A box whose lower end is above its upper one
                holds nothing.
            threads, progress: as in Scene.

        Raises InvalidPoint, ValueError, TypeError.

        >>> import pierce
        >>> scene = pierce.Scene([[0, 0, 0], [4, 0, 0], [0, 4, 0], [0, 0, 4]],
        ...                      [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]])
        >>> scene.touching_boxes([1, 1, -1], [2, 3, 0.5]).triangle.tolist()
        [0, 3]
        """
        return self._touching(self._core.touching_boxes, lower, upper, ("lower", "upper"), threads,
                              progress)
