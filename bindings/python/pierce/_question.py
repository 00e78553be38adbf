# SPDX-License-Identifier: Apache-2.0
"""What the queries are given: rays, and what is asked of them beyond that."""

from __future__ import annotations

import atexit
import math
import operator
import sys
from dataclasses import dataclass, field, replace
from typing import Any, Callable, Union

import numpy as np

from . import _core
from ._arrays import POINT_COLUMNS, Array, as_array, by_name, did_you_mean, rows, to_real, whole

Progress = Union[bool, Callable[[float], Any], None]

SIDES = ("both", "front", "back")
INVALID = ("raise", "miss")
NONE = 0xFFFFFFFF

ORIGIN_COLUMNS = {"ox": None, "oy": None, "oz": None}
DIRECTION_COLUMNS = {"dx": None, "dy": None, "dz": None}
RAY_COLUMNS = {"ox": None, "oy": None, "oz": None, "dx": None, "dy": None, "dz": None,
               "t_min": 0.0, "t_max": np.inf}


def choice(value: Any, among: tuple[str, ...], name: str) -> int:
    if isinstance(value, str) and value in among:
        return among.index(value)
    words = ", ".join(repr(word) for word in among)
    hint = did_you_mean(value.lower(), list(among)) if isinstance(value, str) else ""
    raise ValueError(f"{name} is {value!r}; give one of {words}{hint}")


def number(value: Any, name: str, highest: int) -> int:
    """A whole number from 0 to `highest`."""
    try:
        result = operator.index(value)
    except TypeError:
        raise TypeError(f"{name} is {value!r}; give a whole number") from None
    if not 0 <= result <= highest:
        raise ValueError(f"{name} is {result}; give a number from 0 to {highest}")
    return result


def real_number(value: Any, name: str) -> float:
    """A single number as float64."""
    if type(value) is float:
        return value
    if value is None or isinstance(value, (str, bytes)):
        raise TypeError(f"{name} is {value!r}; give one number")
    array, _ = as_array(value, name)
    if array.ndim:
        raise TypeError(f"{name} has the shape {array.shape}; give one number")
    return float(array)


def _bar(fraction: float) -> None:
    end = "\n" if fraction >= 1 else ""
    sys.stderr.write(f"\rpierce: {100 * fraction:3.0f} %{end}")
    sys.stderr.flush()


_QUIET: dict[int, _core.Control] = {}  # by the number of threads
atexit.register(_QUIET.clear)  # others may keep this module longer than nanobind is there


def control(threads: int, progress: Progress) -> _core.Control:
    if progress is None and type(threads) is int:
        if threads not in _QUIET:
            _QUIET[threads] = _core.Control(number(threads, "threads", 65535), None)
        return _QUIET[threads]
    tell: Callable[[float], Any] | None = None
    if progress is None or progress is False:
        pass
    elif progress is True:
        tell = _bar
    elif callable(progress):
        tell = progress
    else:
        raise TypeError(f"progress is {progress!r}; give True or a function of the fraction done")
    return _core.Control(number(threads, "threads", 65535), tell)


class Rays:
    """The rays of a call: arrays with a row for each, or a single one that holds for all.

    Or one table of all, (n, 6) or (n, 8), n > 0, for most come so.
    """

    __slots__ = ("shape", "count", "_table", "_parts")

    def __init__(self, shape: tuple[int, ...], table: Array | None,
                 parts: tuple[Array, Array, Array | None, Array | None] | None = None):
        self.shape = shape
        self._table, self._parts = table, parts
        self.count: int = math.prod(shape) if table is None else len(table)

    @property
    def parts(self) -> tuple[Array, Array, Array | None, Array | None]:
        """Origins, directions, t_min, t_max."""
        if self._parts is None:
            table = self._table
            assert table is not None
            ranges = (table[:, 6], table[:, 7]) if table.shape[1] == 8 else (None, None)
            self._parts = (table[:, :3], table[:, 3:6], *ranges)
        return self._parts

    def arrays(self) -> tuple[Array, Array, Array | None, Array | None] | tuple[Array]:
        """As the core takes them: at least one array has `count` rows."""
        if self._table is not None:
            return (self._table,)
        n, given = self.count, self.parts
        if any(a is not None and len(a) == n for a in given):
            return given
        return (np.broadcast_to(given[0], (n, 3)), *given[1:])

    def take(self, index: Array) -> Rays:
        def some(array: Array | None) -> Array | None:
            return array if array is None or len(array) == 1 else array[index]

        origins, directions, low, high = (some(part) for part in self.parts)
        assert origins is not None and directions is not None
        return Rays((len(index),), None, (origins, directions, low, high))


def _table(array: Array, name: str, columns: tuple[int, ...]) -> Array:
    if array.shape == (0,):  # an empty list
        return array.reshape(0, columns[0])
    if array.ndim == 0 or array.shape[-1] not in columns:
        words = " or ".join(f"(..., {n})" for n in columns)
        hint = "; give origins and directions, or rows of both" if columns == (6, 8) else ""
        if array.ndim == 2 and array.shape[0] in columns:
            hint = f"; give {name}.T"
        elif columns == (6, 8) and array.shape[-2:] == (2, 3):
            hint = f"; give {name}[..., 0, :], {name}[..., 1, :]"
        raise ValueError(f"{name} has the shape {array.shape}, not {words}{hint}")
    return array


def parse_rays(dtype: np.dtype[Any], rays: Any, directions: Any, t_min: Any, t_max: Any) -> Rays:
    # Most calls have them as they are wanted.
    if (t_min is None and t_max is None and type(rays) is np.ndarray and rays.dtype is dtype
            and rays.ndim == 2):
        if directions is None:
            if rays.shape[1] in (6, 8):
                return _rays_of(rays, rays.shape[:1])
        elif (rays.shape[1] == 3 and type(directions) is np.ndarray and directions.dtype is dtype
                and directions.shape in (rays.shape, (3,))):
            return Rays(rays.shape[:1], None, (rays, directions.reshape(-1, 3), None, None))
    if directions is None:
        rays = by_name(rays, "rays", RAY_COLUMNS)
        table = _table(to_real(rays, dtype, "rays"), "rays", (6, 8))
        if table.shape[-1] == 8 and (t_min is not None or t_max is not None):
            raise ValueError("rays of eight columns have their t_min and t_max; give rays[..., :6]")
        if t_min is None and t_max is None:
            return _rays_of(table.reshape(-1, table.shape[-1]), table.shape[:-1])
        origins, directions_of = table[..., :3], table[..., 3:]
        shapes = {"rays": table.shape[:-1]}
    else:
        rays = by_name(rays, "origins", ORIGIN_COLUMNS, POINT_COLUMNS)
        directions = by_name(directions, "directions", DIRECTION_COLUMNS, POINT_COLUMNS)
        origins = _table(to_real(rays, dtype, "origins"), "origins", (3,))
        directions_of = _table(to_real(directions, dtype, "directions"), "directions", (3,))
        shapes = {"origins": origins.shape[:-1], "directions": directions_of.shape[:-1]}
    low = None if t_min is None else to_real(t_min, dtype, "t_min")
    high = None if t_max is None else to_real(t_max, dtype, "t_max")
    shapes.update({name: a.shape for name, a in (("t_min", low), ("t_max", high))
                   if a is not None})
    try:
        shape = np.broadcast_shapes(*shapes.values())
    except ValueError:
        words = ", ".join(f"{one} of {name}" for name, one in shapes.items())
        raise ValueError(f"leading shapes that do not go together: {words}") from None
    low = None if low is None else rows(low, shape, ())
    high = None if high is None else rows(high, shape, ())
    return Rays(shape, None,
                (rows(origins, shape, (3,)), rows(directions_of, shape, (3,)), low, high))


def _rays_of(table: Array, shape: tuple[int, ...]) -> Rays:
    if len(table):
        return Rays(shape, table)
    return Rays(shape, None, (table[:, :3], table[:, 3:6], None, None))


def parse_points(dtype: np.dtype[Any], points: Any, name: str = "points"
                 ) -> tuple[Array, tuple[int, ...]]:
    points = by_name(points, name, POINT_COLUMNS)
    array = _table(to_real(points, dtype, name), name, (3,))
    shape = array.shape[:-1]
    return array.reshape(-1, 3), shape


def parse_radius(dtype: np.dtype[Any], radius: Any, shape: tuple[int, ...]) -> Array:
    """One for all points, none being infinite, or one for each of them, as (1,) or (n,)."""
    if radius is None:
        return np.full(1, np.inf, dtype)
    radii = to_real(radius, dtype, "radius")
    if radii.ndim and radii.shape != shape:
        raise ValueError(f"radius has the shape {radii.shape}, the points {shape}")
    return np.ascontiguousarray(radii.reshape(-1))


def parse_triangles(value: Any, shape: tuple[int, ...], name: str) -> Array | None:
    """Triangles of a scene, one for each ray, as (n, 2) uint32: geometry, triangle."""
    if value is None:
        return None
    if hasattr(value, "geometry") and hasattr(value, "triangle"):
        geometry, triangle = value.geometry, value.triangle
    elif isinstance(value, tuple) and len(value) == 2:
        geometry, triangle = value
    else:
        geometry, triangle = 0, value
    geometries = whole(geometry, f"{name}.geometry", -1, NONE)
    triangles = whole(triangle, f"{name}.triangle", -1, NONE)
    result = np.empty((*shape, 2), np.uint32)
    try:
        result[..., 0] = geometries.astype(np.uint32)
        result[..., 1] = triangles.astype(np.uint32)
    except ValueError:
        raise ValueError(f"{name} has the shape {triangles.shape}, the rays {shape}") from None
    return result.reshape(-1, 2)


@dataclass
class Question:
    """What is asked of rays, as arrays of the core. It stays as it is: calls may share one."""

    open_start: bool
    sides: int
    skip: Array | None
    after: Array | None
    mask: int
    masks: Array | None
    distinct: bool
    invalid_miss: bool
    max_hits: int
    control: _core.Control
    version: int = 0  # of the scene that must answer; 0: any
    _made: _core.Question | None = field(default=None, init=False, repr=False)

    def core(self) -> _core.Question:
        if self._made is None:
            self._made = self._make_core()
        return self._made

    def _make_core(self) -> _core.Question:
        q = _core.Question()
        q.open_start, q.sides = self.open_start, self.sides
        q.distinct, q.invalid_miss = self.distinct, self.invalid_miss
        q.max_hits, q.mask, q.masks = self.max_hits, self.mask, self.masks
        q.skip, q.after, q.control = self.skip, self.after, self.control
        q.version = self.version
        return q

    def take_at(self, index: Array) -> Question:
        """The same of some of the rays."""
        def some(array: Array | None) -> Array | None:
            return None if array is None else np.ascontiguousarray(array[index])

        return replace(self, skip=some(self.skip), after=some(self.after), masks=some(self.masks))

    def going_on(self, count: int, rays: Array, refs: Array) -> Question:
        """The same after these hits of these rays, and of hits at their t as well."""
        after = np.full((count, 2), NONE, np.uint32)
        after[rays] = refs
        return replace(self, after=after, distinct=False)


_PLAIN: dict[int, Question] = {}  # without options, by the number of threads
atexit.register(_PLAIN.clear)


def parse_question(shape: tuple[int, ...], *, open_start: bool = False, sides: str = "both",
                   skip: Any = None, after: Any = None, mask: Any = None, distinct: bool = False,
                   invalid: str = "raise", max_hits: int | None = None, threads: int = 0,
                   progress: Progress = None) -> Question:
    plain = (skip is None and after is None and mask is None and progress is None
             and max_hits is None and open_start is False and distinct is False
             and type(threads) is int and sides is SIDES[0] and invalid is INVALID[0])
    if plain and threads in _PLAIN:
        return _PLAIN[threads]
    one_mask, masks = NONE, None
    if mask is not None:
        bits = whole(mask, "mask", 0, NONE, ValueError)
        if bits.ndim == 0:
            one_mask = int(bits)
        else:
            try:
                bits = np.broadcast_to(bits, shape)
            except ValueError:
                raise ValueError(f"mask has the shape {bits.shape}, the rays {shape}") from None
            masks = np.ascontiguousarray(bits, np.uint32).reshape(-1)
    most = 2**64 - 1
    question = Question(
        open_start=bool(open_start), sides=choice(sides, SIDES, "sides"),
        skip=parse_triangles(skip, shape, "skip"), after=parse_triangles(after, shape, "after"),
        mask=one_mask, masks=masks, distinct=bool(distinct),
        invalid_miss=choice(invalid, INVALID, "invalid") == 1,
        max_hits=most if max_hits is None else number(max_hits, "max_hits", most),
        control=control(threads, progress))
    if plain:
        _PLAIN[threads] = question
    return question
