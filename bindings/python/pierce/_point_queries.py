# SPDX-License-Identifier: Apache-2.0
"""What points are asked."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from . import _core
from ._arrays import Array, new_array, shaped, to_real
from ._hits import Nearest
from ._question import (Progress, choice, control, number, parse_points, parse_radius,
                        real_number)
from ._table import FEW

if TYPE_CHECKING:
    from typing import Union

RULES = ("odd", "nonzero", "unique", "winding")  # in the order of InsideRule


def _question(rule: str, open_mesh: bool, threads: int, progress: Progress
              ) -> _core.PointQuestion:
    question = _core.PointQuestion()
    question.rule = choice(rule, RULES, "rule")
    question.open_mesh = bool(open_mesh)
    question.control = control(threads, progress)
    return question


class PointQueries:
    """The part of Scene that answers points."""

    _core: Union[_core.SceneF, _core.SceneD]
    _dtype: np.dtype[Any]

    def locate(self, points: Any, *, rule: str = "odd", open_mesh: bool = False, threads: int = 0,
               progress: Progress = None) -> Array:
        """Where each point (..., 3) lies: int8, 1 inside, 0 on the surface, -1 outside. Exact.

        Args:
            rule: what is inside where a surface passes through itself or lies in another one:
                "odd": where a ray leaves through an odd number of surfaces; "nonzero": where the
                surface winds around, so that overlapping solids unite; "unique": as "odd", but of
                triangles in the same place, whichever way they face, only the first counts, for
                meshes that have every face twice; "winding": where the
                winding number is above 1/2, whatever holes the mesh has.
            open_mesh: True does not ask whether the mesh is closed; then what a ray along +z
                crosses says what is inside.
            threads, progress: as in Scene.

        Raises NotClosed, naming the first open edge, InvalidPoint, TypeError, ValueError. The first
        call finds out whether the mesh is closed, 0.1 s a million triangles; then about 0.2 us a
        point.

        >>> import pierce
        >>> corners = [[0, 0, 0], [4, 0, 0], [0, 4, 0], [0, 0, 4]]
        >>> scene = pierce.Scene(corners, [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]])
        >>> scene.locate([[1, 1, 1], [2, 2, 0], [5, 5, 5]])
        array([ 1,  0, -1], dtype=int8)
        """
        flat, shape = parse_points(self._dtype, points)
        question = _question(rule, open_mesh, threads, progress)
        result = np.zeros(len(flat), np.int8)
        if len(flat):
            self._core.locate(flat, result, question)
        return shaped(result, shape)

    def signed_distance(self, points: Any, *, rule: str = "odd", open_mesh: bool = False,
                        threads: int = 0, progress: Progress = None) -> Array:
        """The distance of each point (..., 3) to the surface, negative inside; rounded once.

        Arguments and errors: locate's. Of the scene's type and in the units of its vertices; 0 on
        the surface, inf in an empty scene. About 1 us a point.

        >>> import pierce
        >>> corners = [[0, 0, 0], [4, 0, 0], [0, 4, 0], [0, 0, 4]]
        >>> scene = pierce.Scene(corners, [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]])
        >>> scene.signed_distance([[0.5, 1, 1], [0, 0, -3]])
        array([-0.5,  3. ])
        """
        flat, shape = parse_points(self._dtype, points)
        question = _question(rule, open_mesh, threads, progress)
        result = np.zeros(len(flat), self._dtype)
        if len(flat):
            self._core.signed_distances(flat, result, question)
        return shaped(result, shape)

    def winding_number(self, points: Any, tolerance: float = 1e-6, *, threads: int = 0,
                       progress: Progress = None) -> tuple[Array, Array]:
        """How often the surface winds around each point (..., 3), and how far off that may be at
        most: two arrays of float64. The mesh need not be closed.

        Args:
            tolerance: how far off a number may be. One that is finer than double arithmetic gets is
                come as near to as it can: see the second array.
            threads, progress: as in Scene.

        On the surface it is the mean of both sides. Raises InvalidPoint, TypeError, ValueError.
        About 2 us a point if few edges are open. Among 120,000 loose triangles, 30 us a point for a
        tolerance of 0.1, 350 for 0.001, 6,000 for the default.

        >>> import pierce
        >>> corners = [[0, 0, 0], [4, 0, 0], [0, 4, 0], [0, 0, 4]]
        >>> scene = pierce.Scene(corners, [[0, 2, 1], [0, 1, 3], [0, 3, 2]])  # a wall is missing
        >>> number, error = scene.winding_number([[1, 1, 1], [0.1, 0.1, 0.1], [2, 2, 2]])
        >>> number.round(3), bool((error < 1e-6).all())
        (array([0.64 , 0.862, 0.25 ]), True)
        """
        far = real_number(tolerance, "tolerance")
        flat, shape = parse_points(self._dtype, points)
        numbers, errors = np.zeros(len(flat)), np.zeros(len(flat))
        if len(flat):
            self._core.winding_numbers(flat, numbers, errors, far,
                                       control(threads, progress))
        return numbers.reshape(shape), errors.reshape(shape)

    def nearest(self, points: Any, radius: Any = None, *, threads: int = 0,
                progress: Progress = None) -> Nearest:
        """The point of the surface that is nearest to each point (..., 3).

        Args:
            radius: a number, or one for each point: what is farther away does not count; what is
                exactly so far does.
            threads, progress: as in Scene.

        Of equally near triangles the smallest (geometry, triangle). Raises InvalidPoint, ValueError
        for a negative radius, TypeError. About 1 us a point.

        >>> import pierce
        >>> scene = pierce.Scene([[0, 0, 0], [4, 0, 0], [0, 4, 0]], [[0, 1, 2]])
        >>> near = scene.nearest([[1, 1, 2], [-1, 1, 0]])
        >>> near.distance, near.feature
        (array([2., 1.]), array([6, 5], dtype=uint8))
        """
        flat, shape = parse_points(self._dtype, points)
        n = len(flat)
        reach = None if radius is None else parse_radius(self._dtype, radius, shape)
        if 0 < n <= FEW:
            packed = self._core.nearest_packed(flat, reach, control(threads, progress))
            return Nearest._of_packed(self._dtype, packed, shape)
        numbers = {name: new_array(n, self._dtype) for name in ("distance", "u", "v", "w")}
        columns = {"point": new_array((n, 3), self._dtype), **numbers,
                   "geometry": new_array(n, np.int64), "triangle": new_array(n, np.int64),
                   "feature": new_array(n, np.uint8)}
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
            rule, open_mesh, threads, progress: as in locate.

        Raises what locate raises. 512 x 512 x 512 cells of a mesh of 70,000 triangles take 0.1 s.

        >>> import pierce
        >>> corners = [[0, 0, 0], [4, 0, 0], [0, 4, 0], [0, 0, 4]]
        >>> scene = pierce.Scene(corners, [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]])
        >>> scene.voxelise([0, 0, 0], 1, [4, 1, 1]).ravel()
        array([ 1,  1,  1, -1], dtype=int8)
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
        try:
            cells = np.zeros(x * y * z, np.int8)
        except (MemoryError, ValueError):  # of more bytes than NumPy can count
            raise MemoryError(f"a grid of {x} x {y} x {z} cells takes {x * y * z:,} bytes; ask "
                              "for fewer cells, or for a part of them at a time") from None
        if len(cells):
            self._core.voxelise(grid, x, y, z, cells,
                                _question(rule, open_mesh, threads, progress))
        return cells.reshape(x, y, z)
