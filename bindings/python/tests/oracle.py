# SPDX-License-Identifier: Apache-2.0
"""The answers by exact arithmetic on fractions.Fraction, and by nothing else: brute force."""

from __future__ import annotations

import math
from dataclasses import dataclass
from fractions import Fraction

import numpy as np

# From here on the nearest is infinity: half a unit in the last place above the largest number.
LARGEST = {np.float32: Fraction(2**128 - 2**103), np.float64: Fraction(2**1024 - 2**970)}

Vector = tuple[Fraction, Fraction, Fraction]


@dataclass(frozen=True)
class ExactHit:
    t: Fraction
    u: Fraction
    v: Fraction
    w: Fraction
    triangle: int
    facing: int


def vector(row) -> Vector:
    x, y, z = (Fraction(float(c)) for c in row)
    return x, y, z


def minus(p: Vector, q: Vector) -> Vector:
    return p[0] - q[0], p[1] - q[1], p[2] - q[2]


def dot(p: Vector, q: Vector) -> Fraction:
    return p[0] * q[0] + p[1] * q[1] + p[2] * q[2]


def cross(p: Vector, q: Vector) -> Vector:
    return p[1] * q[2] - p[2] * q[1], p[2] * q[0] - p[0] * q[2], p[0] * q[1] - p[1] * q[0]


def along(o: Vector, t: Fraction, d: Vector) -> Vector:
    return o[0] + t * d[0], o[1] + t * d[1], o[2] + t * d[2]


def corners(vertices, triangle) -> tuple[Vector, Vector, Vector]:
    a, b, c = (vector(vertices[int(i)]) for i in triangle)
    return a, b, c


def line_hit(o: Vector, d: Vector, a: Vector, b: Vector, c: Vector):
    """(t, u, v, w, facing) of the whole line, or None."""
    n = cross(minus(b, a), minus(c, a))
    n_d = dot(n, d)
    if n_d == 0:
        return None
    t = dot(n, minus(a, o)) / n_d
    p = along(o, t, d)
    n_n = dot(n, n)
    u = dot(n, cross(minus(a, c), minus(p, c))) / n_n
    v = dot(n, cross(minus(b, a), minus(p, a))) / n_n
    w = 1 - u - v
    if u < 0 or v < 0 or w < 0:
        return None
    return t, u, v, w, 0 if n_d < 0 else 1


def all_hits(vertices, triangles, ray) -> list[ExactHit]:
    """Of a ray of eight numbers, in the exact order; the ends of the range may be infinite."""
    o, d = vector(ray[:3]), vector(ray[3:6])
    found = []
    for number, triangle in enumerate(triangles):
        hit = line_hit(o, d, *corners(vertices, triangle))
        if hit is not None and float(ray[6]) <= hit[0] <= float(ray[7]):
            found.append(ExactHit(*hit[:4], number, hit[4]))
    return sorted(found, key=lambda hit: (hit.t, hit.triangle))


def rounded(exact: Fraction, dtype) -> float:
    """The nearest number of the type, of two equally near ones the even one; zero is +0."""
    if abs(exact) >= LARGEST[dtype]:
        return math.inf if exact > 0 else -math.inf
    if dtype == np.float64:
        return exact.numerator / exact.denominator + 0.0  # rounded once, by Python's promise
    with np.errstate(over="ignore"):
        guess = np.float32(exact.numerator / exact.denominator)
    ends = np.float32(-np.inf), np.float32(np.inf)
    finite = [x for x in (guess, *(np.nextafter(guess, end) for end in ends)) if np.isfinite(x)]

    def badness(x):
        return abs(Fraction(float(x)) - exact), int(x.view(np.uint32)) & 1

    return float(min(finite, key=badness)) + 0.0


def rounded_root(square: Fraction, dtype) -> float:
    """sqrt(square), rounded once."""
    guess = dtype(math.sqrt(square.numerator / square.denominator))
    for x in (np.nextafter(guess, dtype(0)), guess, np.nextafter(guess, dtype(np.inf))):
        exact = Fraction(float(x))
        low = (exact + Fraction(float(np.nextafter(x, dtype(-np.inf))))) / 2
        high = (exact + Fraction(float(np.nextafter(x, dtype(np.inf))))) / 2
        even = int(x.view(np.uint32 if dtype == np.float32 else np.uint64)) % 2 == 0
        above = low < 0 or (low * low <= square if even else low * low < square)
        below = square <= high * high if even else square < high * high
        if above and below:
            return float(x)
    raise AssertionError(f"no root of {square}")


def nearest_on(p: Vector, a: Vector, b: Vector, c: Vector) -> Vector:
    """The nearest point of a closed triangle, of any that is one: on the face, or on an edge."""
    n = cross(minus(b, a), minus(c, a))
    if dot(n, n) != 0:
        foot = line_hit(p, n, a, b, c)
        if foot is not None:
            return along(p, foot[0], n)
    best = None
    for start, end in ((a, b), (b, c), (c, a)):
        edge = minus(end, start)
        length = dot(edge, edge)
        s = Fraction(0) if length == 0 else dot(minus(p, start), edge) / length
        point = along(start, min(max(s, Fraction(0)), Fraction(1)), edge)
        gap = minus(p, point)
        if best is None or dot(gap, gap) < best[0]:
            best = dot(gap, gap), point
    return best[1]


def nearest(vertices, triangles, point) -> tuple[Fraction, int, Vector] | None:
    """(squared distance, triangle, nearest point), the first triangle of equally near ones."""
    p = vector(point)
    best = None
    for number, triangle in enumerate(triangles):
        q = nearest_on(p, *corners(vertices, triangle))
        gap = minus(p, q)
        if best is None or dot(gap, gap) < best[0]:
            best = dot(gap, gap), number, q
    return best


def locate(vertices, triangles, point) -> int:
    """1 inside, 0 on the surface, -1 outside, by parity along a ray that meets no edge."""
    near = nearest(vertices, triangles, point)
    if near is not None and near[0] == 0:
        return 0
    o = vector(point)
    for attempt in range(100):
        d = Fraction(7919 + attempt), Fraction(104729), Fraction(1299709 + 2 * attempt)
        hits = [line_hit(o, d, *corners(vertices, triangle)) for triangle in triangles]
        hits = [hit for hit in hits if hit is not None and hit[0] > 0]
        if all(min(hit[1:4]) > 0 for hit in hits):
            return 1 if len(hits) % 2 else -1
    raise AssertionError("every ray meets an edge")
