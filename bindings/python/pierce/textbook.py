# SPDX-License-Identifier: Apache-2.0
"""The classic ways to intersect a ray with a triangle, on arrays, with their intermediate numbers.

Each function takes `rays` (..., 6) or (..., 8) and `triangles` (..., 3, 3), the corners a, b, c;
the leading shapes broadcast. It returns a structured array of that shape: `hit`, a bool, then the
numbers that the method computes, by name, in their order, `t`, `u` and `v` among them. All numbers
are computed for every pair, also those that the method would not have reached after it had seen a
miss; what a division by 0 leaves is infinite or NaN.

float32 arrays are computed in float32, float64 in float64, operation by operation as the templates
of include/pierce/textbook.h do it, to the last bit; `test` calls those. With `exact=True` the same
formulas run over fractions.Fraction, in Python: then all of them return the same, the definition of
a hit (moller_trumbore with epsilon=0). Scene gives that answer without being asked, at full speed;
these methods are here to be compared and taught. docs/textbook.md does.

>>> ray, triangle = [0.25, 0.25, 1, 0, 0, -3], [[0, 0, 0], [1, 0, 0], [0, 1, 0]]
>>> found = determinants(ray, triangle)
>>> found.dtype.names
('hit', 'd0', 'dt', 'du', 'dv', 't', 'u', 'v')
>>> float(found["d0"]), float(found["dt"]), float(found["t"])
(3.0, 1.0, 0.3333333333333333)
>>> determinants(ray, triangle, exact=True)["t"].item()
Fraction(1, 3)
"""

from __future__ import annotations

from typing import Any, Callable, NamedTuple

import numpy as np

from . import _core
from ._arrays import FLOAT32, FLOAT64, Array, as_array, real_type, to_real
from ._scalars import OBJECT, component, cross, divide, dot, fractions, longest_axis

__all__ = ["METHODS", "baldwin_weber", "cramer", "determinants", "moller_trumbore",
           "moller_trumbore_culling", "plane_then_barycentric", "plane_then_edges",
           "precomputed_normal", "test", "watertight"]

METHODS: tuple[str, ...] = tuple(_core.textbook_methods())
"""What `test` knows: each method, the two forms of moller_trumbore also with epsilon 0."""


class _Pair(NamedTuple):
    """As many rays as triangles, (n, ...) each, of one type of number."""

    o: Array
    d: Array
    t_min: Array
    t_max: Array
    a: Array
    b: Array
    c: Array

    def in_range(self, t: Array) -> Array:
        return np.asarray((self.t_min <= t) & (t <= self.t_max), bool)


_Numbers = dict[str, Array]


def _parse(rays: Any, triangles: Any) -> tuple[_Pair, tuple[int, ...]]:
    arrays = [(*as_array(value, name), name)
              for value, name in ((rays, "rays"), (triangles, "triangles"))]
    dtype = real_type([array for array, typed, _ in arrays if typed],
                      [name for _, typed, name in arrays if typed])
    table = to_real(rays, dtype, "rays", "the other")
    corners = to_real(triangles, dtype, "triangles", "the other")
    if table.ndim < 1 or table.shape[-1] not in (6, 8):
        raise ValueError(f"rays has the shape {table.shape}, not (..., 6) or (..., 8)")
    if corners.ndim < 2 or corners.shape[-2:] != (3, 3):
        raise ValueError(f"triangles has the shape {corners.shape}, not (..., 3, 3)")
    try:
        shape = np.broadcast_shapes(table.shape[:-1], corners.shape[:-2])
    except ValueError:
        raise ValueError(f"rays {table.shape[:-1]} and triangles {corners.shape[:-2]} do not go "
                         "together") from None
    table = np.broadcast_to(table, (*shape, table.shape[-1])).reshape(-1, table.shape[-1])
    corners = np.broadcast_to(corners, (*shape, 3, 3)).reshape(-1, 3, 3)
    if table.shape[-1] == 8:
        ends = table[:, 6], table[:, 7]
    else:
        ends = np.zeros(len(table), dtype), np.full(len(table), np.inf, dtype)
    pair = _Pair(table[:, 0:3], table[:, 3:6], *ends, corners[:, 0], corners[:, 1], corners[:, 2])
    return pair, shape


def _run(formulas: Callable[..., _Numbers], rays: Any, triangles: Any, exact: bool, **options: Any
         ) -> Array:
    pair, shape = _parse(rays, triangles)
    if exact:
        pair = _Pair(*(fractions(x) for x in pair))
    with np.errstate(all="ignore"):
        numbers = formulas(pair, **options)
    result = np.empty(len(pair.o), [(name, x.dtype, x.shape[1:]) for name, x in numbers.items()])
    for name, x in numbers.items():
        result[name] = x
    return result.reshape(shape)


def test(method: str, rays: Any, triangles: Any) -> Array:
    """The library's own template of this name, one of METHODS: `hit`, `t`, `u`, `v` alone.

    Tens of times faster than the functions here, and the same to the last bit. Misses are NaN.

    >>> test("cramer", [0.25, 0.25, 1, 0, 0, -3], [[0, 0, 0], [1, 0, 0], [0, 1, 0]])["u"].item()
    0.25
    """
    if method not in METHODS:
        raise ValueError(f"method is {method!r}; give one of METHODS: {'; '.join(METHODS)}")
    pair, shape = _parse(rays, triangles)
    dtype = pair.o.dtype
    found = np.empty(len(pair.o), [("hit", bool), ("t", dtype), ("u", dtype), ("v", dtype)])
    hit, numbers = np.zeros(len(found), np.uint8), np.full((len(found), 3), np.nan, dtype)
    call = _core.textbook_float if dtype == FLOAT32 else _core.textbook_double
    call(METHODS.index(method), tuple(np.ascontiguousarray(x) for x in pair), hit, numbers)
    found["hit"] = hit
    found["t"], found["u"], found["v"] = numbers.T
    return found.reshape(shape)


def _inside(u: Array, v: Array) -> Array:
    return np.asarray(~((u < 0) | (u > 1) | (v < 0) | (u + v > 1)), bool)


def cramer(rays: Any, triangles: Any, *, exact: bool = False) -> Array:
    """Cramer's rule with shared sub-determinants (Shirley): m; ei_hf ... bl_kc; t, u, v."""
    return _run(_cramer, rays, triangles, exact)


def _cramer(p: _Pair) -> _Numbers:
    a, b, c = np.moveaxis(p.a - p.b, -1, 0)
    d, e, f = np.moveaxis(p.a - p.c, -1, 0)
    g, h, i = np.moveaxis(p.d, -1, 0)
    j, k, l = np.moveaxis(p.a - p.o, -1, 0)  # noqa: E741: the book's letter
    ei_hf, gf_di, dh_eg = e * i - h * f, g * f - d * i, d * h - e * g
    m = a * ei_hf + b * gf_di + c * dh_eg
    ak_jb, jc_al, bl_kc = a * k - j * b, j * c - a * l, b * l - k * c
    t = divide(-(f * ak_jb + e * jc_al + d * bl_kc), m)
    gamma = divide(i * ak_jb + h * jc_al + g * bl_kc, m)
    beta = divide(j * ei_hf + k * gf_di + l * dh_eg, m)
    outside = (gamma < 0) | (gamma > 1) | (beta < 0) | (beta > 1 - gamma)
    hit = np.asarray((m != 0) & p.in_range(t) & ~np.asarray(outside, bool), bool)
    return {"hit": hit, "ei_hf": ei_hf, "gf_di": gf_di, "dh_eg": dh_eg, "m": m, "ak_jb": ak_jb,
            "jc_al": jc_al, "bl_kc": bl_kc, "t": t, "v": gamma, "u": beta}


def determinants(rays: Any, triangles: Any, *, exact: bool = False) -> Array:
    """Four determinants of columns, nothing shared: d0, dt, du, dv; t, u, v are their ratios."""
    return _run(_determinants, rays, triangles, exact)


def _determinants(p: _Pair) -> _Numbers:
    a, b, c, d = -p.d, p.b - p.a, p.c - p.a, p.o - p.a
    d0, dt = dot(a, cross(b, c)), dot(d, cross(b, c))
    du, dv = dot(a, cross(d, c)), dot(a, cross(b, d))
    t, u, v = divide(dt, d0), divide(du, d0), divide(dv, d0)
    hit = np.asarray(d0 != 0, bool) & p.in_range(t) & _inside(u, v)
    return {"hit": hit, "d0": d0, "dt": dt, "du": du, "dv": dv, "t": t, "u": u, "v": v}


def plane_then_edges(rays: Any, triangles: Any, *, exact: bool = False) -> Array:
    """First the plane (n, n_d, t, the point p), then the side of each edge: side_ab, bc, ca."""
    return _run(_plane_then_edges, rays, triangles, exact)


def _plane_then_edges(q: _Pair) -> _Numbers:
    a, b, c = q.a, q.b, q.c
    n = cross(b - a, c - a)
    n_d = dot(n, q.d)
    t = divide(dot(n, a - q.o), n_d)
    p = q.o + t[..., None] * q.d
    ab = dot(n, cross(b - a, p - a))
    bc = dot(n, cross(c - b, p - b))
    ca = dot(n, cross(a - c, p - c))
    hit = np.asarray((n_d != 0) & ~((ab < 0) | (bc < 0) | (ca < 0)), bool) & q.in_range(t)
    n_n = dot(n, n)
    return {"hit": hit, "n": n, "n_d": n_d, "t": t, "p": p, "side_ab": ab, "side_bc": bc,
            "side_ca": ca, "n_n": n_n, "u": divide(ca, n_n), "v": divide(ab, n_n)}


def plane_then_barycentric(rays: Any, triangles: Any, *, exact: bool = False) -> Array:
    """The plane, then two dimensions (Badouel 1990): n, n_d, t, p - a, dropped axis, area."""
    return _run(_plane_then_barycentric, rays, triangles, exact)


def _plane_then_barycentric(q: _Pair) -> _Numbers:
    e1, e2 = q.b - q.a, q.c - q.a
    n = cross(e1, e2)
    n_d = dot(n, q.d)
    t = divide(dot(n, q.a - q.o), n_d)
    p = q.o + t[..., None] * q.d - q.a
    dropped = longest_axis(n)
    x, y = (dropped + 1) % 3, (dropped + 2) % 3

    def cross_2d(r: Array, s: Array) -> Array:
        return np.asarray(component(r, x) * component(s, y) - component(r, y) * component(s, x))

    area = component(n, dropped)
    u, v = divide(cross_2d(p, e2), area), divide(cross_2d(e1, p), area)
    outside = np.asarray((u < 0) | (v < 0) | (u + v > 1), bool)
    hit = np.asarray(n_d != 0, bool) & q.in_range(t) & ~outside
    return {"hit": hit, "n": n, "n_d": n_d, "t": t, "p_a": p, "dropped": dropped, "area": area,
            "u": u, "v": v}


def moller_trumbore(rays: Any, triangles: Any, *, epsilon: float = 1e-5, exact: bool = False
                    ) -> Array:
    """Moller and Trumbore 1997, two-sided: q, det, f = 1 / det, s, r.

    |det| < epsilon is taken for parallel; with 0, only what is exactly 0.
    """
    return _run(_moller_trumbore, rays, triangles, exact, epsilon=epsilon)


def _limit(p: _Pair, epsilon: float) -> Any:
    return epsilon if p.o.dtype == OBJECT else p.o.dtype.type(epsilon)


def _moller_trumbore(p: _Pair, epsilon: float) -> _Numbers:
    limit = _limit(p, epsilon)
    e1, e2 = p.b - p.a, p.c - p.a
    q = cross(p.d, e2)
    det = dot(e1, q)
    f = divide(1, det)
    s = p.o - p.a
    u = np.asarray(f * dot(s, q))
    r = cross(s, e1)
    v, t = np.asarray(f * dot(r, p.d)), np.asarray(f * dot(r, e2))
    parallel = np.asarray((det == 0) | ((-limit < det) & (det < limit)), bool)
    hit = ~parallel & _inside(u, v) & p.in_range(t)
    return {"hit": hit, "q": q, "det": det, "f": f, "s": s, "u": u, "r": r, "v": v, "t": t}


def moller_trumbore_culling(rays: Any, triangles: Any, *, epsilon: float = 1e-5,
                            exact: bool = False) -> Array:
    """The one-sided form, only fronts are hit: q, det, s, u_det = u det, r, v_det, f."""
    return _run(_moller_trumbore_culling, rays, triangles, exact, epsilon=epsilon)


def _moller_trumbore_culling(p: _Pair, epsilon: float) -> _Numbers:
    e1, e2 = p.b - p.a, p.c - p.a
    q = cross(p.d, e2)
    det = dot(e1, q)
    s = p.o - p.a
    u = dot(s, q)
    r = cross(s, e1)
    v = dot(r, p.d)
    f = divide(1, det)
    t = np.asarray(f * dot(r, e2))
    away = np.asarray((det <= 0) | (det < _limit(p, epsilon)), bool)
    outside = np.asarray((u < 0) | (u > det) | (v < 0) | (u + v > det), bool)
    hit = ~away & ~outside & p.in_range(t)
    return {"hit": hit, "q": q, "det": det, "s": s, "u_det": u, "r": r, "v_det": v, "f": f, "t": t,
            "u": np.asarray(f * u), "v": np.asarray(f * v)}


def precomputed_normal(rays: Any, triangles: Any, *, exact: bool = False) -> Array:
    """Moller and Trumbore's ratios with the normal kept: n, minus_n_d, s, m."""
    return _run(_precomputed_normal, rays, triangles, exact)


def _precomputed_normal(p: _Pair) -> _Numbers:
    e1, e2 = p.b - p.a, p.c - p.a
    n = cross(e1, e2)
    minus_n_d = -dot(n, p.d)
    s = p.o - p.a
    t = divide(dot(n, s), minus_n_d)
    m = cross(s, p.d)
    u, v = divide(dot(m, e2), minus_n_d), divide(-dot(m, e1), minus_n_d)
    hit = np.asarray(minus_n_d != 0, bool) & p.in_range(t) & _inside(u, v)
    return {"hit": hit, "n": n, "minus_n_d": minus_n_d, "s": s, "t": t, "m": m, "u": u, "v": v}


def watertight(rays: Any, triangles: Any, *, exact: bool = False) -> Array:
    """Woop, Benthin and Wald 2013: axis kz, shear sx sy sz, edge functions U V W, det, T."""
    return _run(_watertight, rays, triangles, exact)


def _watertight(p: _Pair) -> _Numbers:
    kz = longest_axis(p.d)
    dz = component(p.d, kz)
    ahead = np.asarray(dz >= 0, bool)
    kx = np.where(ahead, (kz + 1) % 3, (kz + 2) % 3)  # the other way round keeps the winding
    ky = np.where(ahead, (kz + 2) % 3, (kz + 1) % 3)
    sx, sy, sz = divide(component(p.d, kx), dz), divide(component(p.d, ky), dz), divide(1, dz)
    xs, ys, zs = [], [], []
    for corner in (p.a - p.o, p.b - p.o, p.c - p.o):
        z = component(corner, kz)
        xs.append(component(corner, kx) - sx * z)
        ys.append(component(corner, ky) - sy * z)
        zs.append(sz * z)
    pairs = ((2, 1), (0, 2), (1, 0))  # each edge, as U, V, W belong to a, b, c
    edges = [xs[i] * ys[j] - ys[i] * xs[j] for i, j in pairs]
    wider = {FLOAT32: np.dtype(np.float64), FLOAT64: np.dtype(np.longdouble)}.get(p.o.dtype)
    if wider is not None:  # a 0 that rounding may have made is computed again
        again = (edges[0] == 0) | (edges[1] == 0) | (edges[2] == 0)
        wide_x, wide_y = [x.astype(wider) for x in xs], [y.astype(wider) for y in ys]
        wide = [(wide_x[i] * wide_y[j] - wide_y[i] * wide_x[j]).astype(p.o.dtype)
                for i, j in pairs]
        edges = [np.where(again, x, y) for x, y in zip(wide, edges)]
    u, v, w = edges
    mixed = ((u < 0) | (v < 0) | (w < 0)) & ((u > 0) | (v > 0) | (w > 0))
    det = np.asarray(u + v + w)
    f = divide(1, det)
    height = np.asarray(u * zs[0] + v * zs[1] + w * zs[2])
    t = np.asarray(height * f)
    hit = np.asarray(~np.asarray(mixed, bool) & (det != 0), bool) & p.in_range(t)
    return {"hit": hit, "kz": kz, "sx": sx, "sy": sy, "sz": sz, "U": u, "V": v, "W": w,
            "det": det, "T": height, "t": t, "u": np.asarray(v * f), "v": np.asarray(w * f)}


def baldwin_weber(rays: Any, triangles: Any, *, exact: bool = False) -> Array:
    """Baldwin and Weber 2016: axis k and the map to_u, to_v, to_z of the triangle; z_d, z_o."""
    return _run(_baldwin_weber, rays, triangles, exact)


def _baldwin_weber(p: _Pair) -> _Numbers:
    e1, e2 = p.b - p.a, p.c - p.a
    n = cross(e1, e2)
    k = longest_axis(n)
    i, j = (k + 1) % 3, (k + 2) % 3
    nk, ai, aj = component(n, k), component(p.a, i), component(p.a, j)
    u0, u1 = divide(component(e2, j), nk), divide(-component(e2, i), nk)
    v0, v1 = divide(-component(e1, j), nk), divide(component(e1, i), nk)
    z0, z1 = divide(component(n, i), nk), divide(component(n, j), nk)
    to_u = np.stack([u0, u1, -(u0 * ai + u1 * aj)], axis=-1)
    to_v = np.stack([v0, v1, -(v0 * ai + v1 * aj)], axis=-1)
    to_z = np.stack([z0, z1, -(component(p.a, k) + z0 * ai + z1 * aj)], axis=-1)
    di, dj, oi, oj = (component(x, axis) for x in (p.d, p.o) for axis in (i, j))
    z_d = np.asarray(component(p.d, k) + z0 * di + z1 * dj)
    z_o = np.asarray(component(p.o, k) + z0 * oi + z1 * oj + to_z[..., 2])
    t = divide(-z_o, z_d)
    x, y = oi + t * di, oj + t * dj
    u = np.asarray(u0 * x + u1 * y + to_u[..., 2])
    v = np.asarray(v0 * x + v1 * y + to_v[..., 2])
    hit = np.asarray((nk != 0) & (z_d != 0), bool) & p.in_range(t) & _inside(u, v)
    return {"hit": hit, "k": k, "to_u": to_u, "to_v": to_v, "to_z": to_z, "z_d": z_d, "z_o": z_o,
            "t": t, "u": u, "v": v}
