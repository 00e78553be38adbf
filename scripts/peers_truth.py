# SPDX-License-Identifier: Apache-2.0
"""Who is right, by integers of any length: nothing here is rounded, and nothing is pierce's.

All coordinates are multiples of one power of two, so they are integers in that unit. Where two
engines disagree, the triangle that one of them names is a witness: whether it is hit, and at what
t, decides which of them is wrong. `closest` looks at all triangles, to check the witness's own.
"""

from fractions import Fraction

import numpy as np


def minus(p, q):
    return (p[0] - q[0], p[1] - q[1], p[2] - q[2])


def dot(p, q):
    return p[0] * q[0] + p[1] * q[1] + p[2] * q[2]


def cross(p, q):
    return (p[1] * q[2] - p[2] * q[1], p[2] * q[0] - p[0] * q[2], p[0] * q[1] - p[1] * q[0])


class Truth:
    def __init__(self, vertices, triangles, *others):
        """`others`: all arrays of rays and points that will be asked about."""
        self.shift = 0
        for array in (vertices, *others):
            mantissa, exponent = np.frexp(array[array != 0].astype(np.float64))
            self.shift = max(self.shift, 24 - int(exponent.min()))
        self.corners = vertices[triangles].astype(np.float64)
        self.vertices, self.triangles = vertices, triangles
        self.low = self.corners.min(axis=1)
        self.high = self.corners.max(axis=1)
        self.by_x = np.argsort(self.low[:, 0])
        self.from_x = self.low[self.by_x, 0]
        self.widest = float((self.high - self.low)[:, 0].max())
        self.centers = self.corners.mean(axis=1)
        self.radii = np.linalg.norm(self.corners - self.centers[:, None], axis=2).max(axis=1)
        self.size = float(np.abs(self.corners).max())  # of rays' origins too, or nearly

    def whole(self, vector):
        numbers = [int(np.ldexp(np.float64(x), self.shift)) for x in vector]
        return numbers[0], numbers[1], numbers[2]

    def triangle(self, index):
        return [self.whole(corner) for corner in self.corners[index]]

    def hit(self, o, d, index):
        """The exact t at which the ray hits the closed triangle, or None; o, d as integers."""
        a, b, c = self.triangle(index)
        e1, e2, s = minus(b, a), minus(c, a), minus(o, a)
        n = cross(e1, e2)
        det = -dot(n, d)
        if det == 0:
            return None
        m = cross(s, d)
        t, u, v = dot(n, s), dot(m, e2), -dot(m, e1)
        if det < 0:
            det, t, u, v = -det, -t, -u, -v
        if t < 0 or u < 0 or v < 0 or u + v > det:
            return None
        return Fraction(t, det)

    def candidates(self, o, d):
        """Triangles that the ray may hit: those whose circumspheres the line meets, with room."""
        d = d / np.linalg.norm(d.astype(np.float64))
        to = self.centers - o
        along = to @ d
        beside2 = np.einsum("ni,ni->n", to, to) - along * along
        reach = self.radii + 1e-6 * self.size
        return np.flatnonzero((beside2 <= reach * reach) & (along >= -reach))

    def closest(self, o, d):
        """All triangles that share the smallest t of a ray, and that t; ([], None) for a miss."""
        best, who = None, []
        oi, di = self.whole(o), self.whole(d)
        for index in self.candidates(o, d).tolist():
            t = self.hit(oi, di, index)
            if t is not None and (best is None or t <= best):
                who = [*who, index] if t == best else [index]
                best = t
        return who, best

    def judge_closest(self, o, d, mine, theirs):
        """(wrong of mine, wrong of theirs) among the rays whose triangles differ."""
        wrong = [0, 0]
        for i in np.flatnonzero(mine != theirs).tolist():
            oi, di = self.whole(o[i]), self.whole(d[i])
            t = [None if x < 0 else self.hit(oi, di, x) for x in (mine[i], theirs[i])]
            false = [x >= 0 and y is None for x, y in zip((mine[i], theirs[i]), t)]
            for me, other in ((0, 1), (1, 0)):
                late = t[other] is not None and (t[me] is None or t[me] > t[other])
                wrong[me] += bool(false[me] or late)
        return wrong

    def judge_any(self, o, d, mine, theirs, witness):
        """`witness`: mine's triangles of these rays, -1 a miss."""
        wrong = [0, 0]
        for i in np.flatnonzero(mine != theirs).tolist():
            real = witness[i] >= 0 and self.hit(self.whole(o[i]), self.whole(d[i]),
                                                witness[i]) is not None
            if not real:  # then nothing is known but by looking at all
                real = bool(self.closest(o[i], d[i])[0])
            wrong[0] += bool(mine[i] != real)
            wrong[1] += bool(theirs[i] != real)
        return wrong

    def judge_all(self, o, d, mine, theirs, count):
        """Lists (rays, triangles). Right is each true hit, or one for each different t."""
        def split(rays, triangles):
            order = np.argsort(rays, kind="stable")
            ends = np.searchsorted(rays[order], np.arange(count + 1))
            return [np.sort(x) for x in np.split(triangles[order], ends[1:-1])]

        wrong = [0, 0]
        for i, lists in enumerate(zip(split(*mine), split(*theirs))):
            if np.array_equal(*lists):
                continue
            oi, di = self.whole(o[i]), self.whole(d[i])
            t = [[self.hit(oi, di, x) for x in found.tolist()] for found in lists]
            real = {x for found in t for x in found if x is not None}
            for me in (0, 1):
                repeated = len(set(lists[me].tolist())) != len(lists[me])
                wrong[me] += None in t[me] or set(t[me]) != real or repeated
        return wrong

    def inside(self, p):
        """Whether a point is in the closed solid: crossings of a ray along z, exactly."""
        x = float(p[0])
        first = np.searchsorted(self.from_x, x - 1.001 * self.widest)
        near = self.by_x[first:np.searchsorted(self.from_x, x, "right")]
        near = near[(self.low[near, :2] <= p[:2]).all(axis=1) & (p <= self.high[near]).all(axis=1)]
        q, odd = self.whole(p), False
        touching = near[self.low[near, 2] <= p[2]]
        if any(self.distance2(q, index) == 0 for index in touching.tolist()):
            return True
        for index in near.tolist():
            a, b, c = (minus(corner, q) for corner in self.triangle(index))
            edges = [(r[0] * s[1] - r[1] * s[0], r, s) for r, s in ((a, b), (b, c), (c, a))]
            # A point of the plane that is on no edge of another's shadow: shifted by (e, e^2).
            signs = [side or (r[1] - s[1]) or (s[0] - r[0]) for side, r, s in edges]
            if not (all(x > 0 for x in signs) or all(x < 0 for x in signs)):
                continue
            n = cross(minus(b, a), minus(c, a))
            if (dot(n, a) > 0) == (n[2] > 0):
                odd = not odd
        return odd

    def judge_inside(self, p, mine, theirs):
        wrong = [0, 0]
        for i in np.flatnonzero(mine != theirs).tolist():
            truth = self.inside(p[i])
            wrong[0] += bool(mine[i] != truth)
            wrong[1] += bool(theirs[i] != truth)
        return wrong

    def distance2(self, p, index):
        """The exact squared distance of a point to a triangle."""
        a, b, c = (minus(corner, p) for corner in self.triangle(index))
        n = cross(minus(b, a), minus(c, a))
        inner = [dot(n, cross(r, s)) for r, s in ((b, c), (c, a), (a, b))]
        if dot(n, n) > 0 and all(x >= 0 for x in inner):
            return Fraction(dot(n, a) ** 2, dot(n, n))
        return min(self.segment2(r, s) for r, s in ((a, b), (b, c), (c, a)))

    @staticmethod
    def segment2(r, s):
        """The squared distance of the coordinate origin to a segment."""
        e = minus(s, r)
        length, along = dot(e, e), -dot(r, e)
        if along <= 0 or length == 0:
            return Fraction(dot(r, r))
        if along >= length:
            return Fraction(dot(s, s))
        return dot(r, r) - Fraction(along * along, length)

    def judge_nearest(self, p, mine, theirs):
        wrong = [0, 0]
        for i in np.flatnonzero(mine != theirs).tolist():
            q = self.whole(p[i])
            far = [self.distance2(q, x) if 0 <= x < len(self.triangles) else None
                   for x in (mine[i], theirs[i])]
            for me, other in ((0, 1), (1, 0)):
                wrong[me] += bool(far[me] is None or (far[other] is not None
                                                      and far[me] > far[other]))
        return wrong
