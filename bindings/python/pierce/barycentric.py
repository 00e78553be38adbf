# SPDX-License-Identifier: Apache-2.0
"""Barycentric coordinates on arrays: points as weighted means of the corners of simplices.

    p = l_0 c_0 + l_1 c_1 + ... + l_k c_k,     l_0 + l_1 + ... + l_k = 1

Points are (..., n), simplices (..., k + 1, n): k + 1 corners in n dimensions, a segment, a
triangle, a tetrahedron, ...; leading shapes broadcast. Coordinates are (..., k + 1). The formulas
are those of include/pierce/barycentric.h, in float32 or float64; with `exact=True` they run over
fractions.Fraction, in Python, and zero means zero.

>>> triangle = [[0, 0, 0], [1, 0, 0], [0, 1, 0]]
>>> weights = coordinates([0.25, 0.25, 0], triangle)
>>> weights
array([0.5 , 0.25, 0.25])
>>> interpolate(weights, [10, 20, 30])
array(17.5)
"""

from __future__ import annotations

from typing import Any, Callable

import numpy as np

from ._arrays import Array, as_array, real_type, to_real
from ._scalars import OBJECT, cross, divide, dot, fractions

__all__ = ["beyond", "carrier", "coordinates", "inside_closed", "inside_open", "interpolate"]


def _parse(points: Any, corners: Any) -> tuple[Array, Array, tuple[int, ...]]:
    arrays = [(*as_array(value, name), name)
              for value, name in ((points, "points"), (corners, "corners"))]
    dtype = real_type([a for a, typed, _ in arrays if typed],
                      [name for _, typed, name in arrays if typed])
    p, c = to_real(points, dtype, "points"), to_real(corners, dtype, "corners")
    if p.ndim < 1 or c.ndim < 2 or p.shape[-1] != c.shape[-1]:
        raise ValueError(f"points and corners have the shapes {p.shape} and {c.shape}, not "
                         "(..., n) and (..., k + 1, n)")
    if not 2 <= c.shape[-2] <= c.shape[-1] + 1:
        raise ValueError(f"{c.shape[-2]} corners in {c.shape[-1]} dimensions are no simplex; give "
                         f"2 to {c.shape[-1] + 1}")
    try:
        shape = np.broadcast_shapes(p.shape[:-1], c.shape[:-2])
    except ValueError:
        raise ValueError(f"points {p.shape[:-1]} and simplices {c.shape[:-2]} do not go together"
                         ) from None
    p, c = np.broadcast_to(p, shape + p.shape[-1:]), np.broadcast_to(c, shape + c.shape[-2:])
    return p.reshape(-1, p.shape[-1]), c.reshape(-1, *c.shape[-2:]), shape


def coordinates(points: Any, corners: Any, *, exact: bool = False) -> Array:
    """The barycentric coordinates of each point in its simplex: (..., k + 1).

    For a point beside the simplex's own plane (a triangle in space) they are those of its
    orthogonal projection. A simplex without size has none: infinite or NaN, with `exact` NaN.

    >>> coordinates([1, 1], [[0, 0], [3, 0], [0, 3]], exact=True).tolist()
    [Fraction(1, 3), Fraction(1, 3), Fraction(1, 3)]
    """
    p, c, shape = _parse(points, corners)
    if exact:
        p, c = fractions(p), fractions(c)
    count = c.shape[1]
    special: dict[Any, Callable[..., Array]] = {
        (3, 2): _in_the_plane, (3, 3): _in_space, (4, 3): _in_tetrahedron}
    formulas = special.get(c.shape[1:])
    with np.errstate(all="ignore"):
        if formulas is not None:
            result = formulas(p, *(c[:, i] for i in range(count)))
        else:
            result = _in_simplex(p, c)
    return result.reshape(*shape, count)


def _in_the_plane(p: Array, a: Array, b: Array, c: Array) -> Array:
    def twice_area(q: Array, r: Array, s: Array) -> Array:
        return np.asarray((r[..., 0] - q[..., 0]) * (s[..., 1] - q[..., 1])
                          - (r[..., 1] - q[..., 1]) * (s[..., 0] - q[..., 0]), q.dtype)

    whole = twice_area(a, b, c)
    parts = twice_area(p, b, c), twice_area(a, p, c), twice_area(a, b, p)
    return np.stack([divide(part, whole) for part in parts], axis=-1)


def _in_space(p: Array, a: Array, b: Array, c: Array) -> Array:
    n = cross(b - a, c - a)
    parts = cross(c - b, p - b), cross(a - c, p - c), cross(b - a, p - a)
    return np.stack([divide(dot(n, part), dot(n, n)) for part in parts], axis=-1)


def _in_tetrahedron(p: Array, r1: Array, r2: Array, r3: Array, r4: Array) -> Array:
    t1, t2, t3, r = r1 - r4, r2 - r4, r3 - r4, p - r4
    rows = cross(t2, t3), cross(t3, t1), cross(t1, t2)
    det = dot(t1, rows[0])
    l1, l2, l3 = (divide(dot(row, r), det) for row in rows)
    return np.stack([l1, l2, l3, np.asarray(1 - l1 - l2 - l3, p.dtype)], axis=-1)


def _in_simplex(p: Array, c: Array) -> Array:
    """E l = p - c_0 with the edges as columns, or E^T E l = E^T (p - c_0)."""
    first = c[..., 0, :]
    edges = np.swapaxes(c[..., 1:, :] - first[..., None, :], -1, -2)
    right = (p - first)[..., None]
    if edges.shape[-1] != edges.shape[-2]:
        transposed = np.swapaxes(edges, -1, -2)
        edges, right = _times(transposed, edges), _times(transposed, right)
    solution = _solve(edges, right[..., 0])
    rest = np.asarray(1, p.dtype)
    for i in range(solution.shape[-1]):
        rest = np.asarray(rest - solution[..., i], p.dtype)
    return np.concatenate([rest[..., None], solution], axis=-1)


def _times(x: Array, y: Array) -> Array:
    total = x[..., :, 0, None] * y[..., None, 0, :]
    for i in range(1, x.shape[-1]):
        total = total + x[..., :, i, None] * y[..., None, i, :]
    return total


def _solve(matrix: Array, right: Array) -> Array:
    """By elimination with the largest pivots; NaN where the matrix is singular."""
    m = np.concatenate([matrix, right[..., None]], axis=-1)
    k = m.shape[-2]
    for step in range(k):
        column = np.abs(m[..., step:, step])
        pivot = np.asarray(np.argmax(column, axis=-1)) + step
        rows = pivot[..., None, None]
        upper = np.take_along_axis(m, np.broadcast_to(rows, (*m.shape[:-2], 1, k + 1)), axis=-2)
        np.put_along_axis(m, rows, m[..., step:step + 1, :].copy(), axis=-2)
        m[..., step, :] = upper[..., 0, :]
        for row in range(step + 1, k):
            factor = divide(m[..., row, step], m[..., step, step])
            m[..., row, step + 1:] = m[..., row, step + 1:] - factor[..., None] * m[
                ..., step, step + 1:]
    x = m[..., k].copy()
    for row in reversed(range(k)):
        for column_after in range(row + 1, k):
            x[..., row] = x[..., row] - m[..., row, column_after] * x[..., column_after]
        x[..., row] = divide(x[..., row], m[..., row, row])
    return np.asarray(x)


def _given(weights: Any) -> Array:
    array = np.asarray(weights)
    if array.dtype != OBJECT:
        array, _ = as_array(weights, "coordinates")
    if array.ndim == 0:
        raise ValueError("coordinates is a single number; give (..., k + 1)")
    return array


def beyond(weights: Any) -> Array:
    """Beyond the face opposite which corners each point lies: bools (..., k + 1)."""
    with np.errstate(invalid="ignore"):
        return np.asarray(_given(weights) < 0, bool)


def inside_closed(weights: Any) -> Array:
    """Whether each point lies in the closed simplex: faces, edges and corners belong to it."""
    with np.errstate(invalid="ignore"):
        return np.asarray(np.asarray(_given(weights) >= 0, bool).all(axis=-1))


def inside_open(weights: Any) -> Array:
    """Whether each point lies in the open simplex, on no face."""
    with np.errstate(invalid="ignore"):
        return np.asarray(np.asarray(_given(weights) > 0, bool).all(axis=-1))


def carrier(weights: Any) -> Array:
    """The corners of the smallest face that holds each point, bools; none for points outside.

    One corner: the point is that vertex; two: it is on that edge; all: in the open simplex.

    >>> carrier([0.5, 0.5, 0.0]).tolist()
    [True, True, False]
    """
    array = _given(weights)
    with np.errstate(invalid="ignore"):
        return np.asarray(array > 0, bool) & inside_closed(array)[..., None]


def interpolate(weights: Any, values: Any) -> Array:
    """What is known at the corners, at the points: the mean of the values, weighted.

    `values` is (k + 1,), a number at each corner, or (..., k + 1, d), a vector at each, whose
    leading shape broadcasts with that of the points. Exact, up to rounding, for what varies
    linearly over the simplex, positions included.
    """
    w, v = _given(weights), np.asarray(values)
    axis = 0 if v.ndim == 1 else v.ndim - 2
    if v.ndim == 0 or v.shape[axis] != w.shape[-1]:
        raise ValueError(f"coordinates and values have the shapes {w.shape} and {v.shape}; give "
                         f"values as {w.shape[-1:]}, or as (..., {w.shape[-1]}, d)")
    total: Any = 0
    for i in range(w.shape[-1]):
        term = w[..., i] * v[i] if v.ndim == 1 else w[..., i, None] * v[..., i, :]
        total = term if i == 0 else total + term
    return np.asarray(total)
