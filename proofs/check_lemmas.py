#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Two facts about determinants, and one about boxes, that docs/algorithm.md uses and Gappa does not
see.

1. "The determinant of three": |det(p, q, r)| <= 4 P Q R if no component of p, q, r exceeds P, Q, R
   in magnitude. The determinant is linear in every component, so its extremes lie at components
   +-P ...: all 512 of them are tried.
2. The identities that take apart the errors of the leaf cull, and those of passages, are identities
   of polynomials: both sides are evaluated exactly at random integers from [-2^40, 2^40]. Two
   different polynomials of degree <= 16 agree at such a point with a probability below 2^-37
   (Schwartz, Zippel); 20 points are tried.
3. So is what takes apart the error of the box test, into the parts of proofs/box.g (multiplied by
   the denominators).
"""
import fractions
import itertools
import random
import sys


def dot(p, q):
    return sum(x * y for x, y in zip(p, q))


def cross(p, q):
    return (p[1] * q[2] - p[2] * q[1], p[2] * q[0] - p[0] * q[2], p[0] * q[1] - p[1] * q[0])


def det(p, q, r):
    return dot(cross(p, q), r)


def plus(p, q, k=1):
    return tuple(x + k * y for x, y in zip(p, q))


def scaled(k, p):
    return tuple(k * x for x in p)


def largest_determinant():
    signs = list(itertools.product((-1, 1), repeat=3))
    return max(abs(det(p, q, r)) for p in signs for q in signs for r in signs)


def identities(vector, number):
    """(name, left side, right side) at a random point."""
    s, d, e, f = vector(), vector(), vector(), vector()
    ds, dd, de, df = vector(), vector(), vector(), vector()
    s1, d1, e1, f1 = plus(s, ds), plus(d, dd), plus(e, de), plus(f, df)
    yield ("U and V: the error of d x s . e",
           det(d1, s1, e1) - det(d, s, e),
           det(dd, s, e) + det(d1, ds, e) + dot(cross(d1, s1), de))
    yield ("den: the error of e x f . d",
           det(e1, f1, d1) - det(e, f, d),
           det(de, f1, d1) + det(e, df, d1) + det(e, f, dd))
    tau = number()
    q = plus(s, d, -tau)  # S = Q + tau D
    yield ("R of a hit: d1 x s1 = d1 x (Q + ds - tau dd)",
           dot(cross(d1, s1), f), dot(cross(d1, plus(plus(q, ds), dd, -tau)), f))
    u, v = number(), number()
    a_minus_x = plus(scaled(-u, e), f, -v)  # A - X for X = A + u e + v f
    yield ("a point of the plane: N . (A - X) = 0", dot(cross(e, f), a_minus_x), 0)
    n = cross(e1, f1)
    yield ("tau: N1 . s1 - tau N1 . d1",
           dot(n, s1) - tau * dot(n, d1), dot(n, plus(plus(q, ds), dd, -tau)))
    # R den = V (f x d) - U (d x e), with U = -R.f, V = R.e
    r = cross(d, s)
    den = det(e, f, d)
    right = plus(scaled(dot(r, e), cross(f, d)), cross(d, e), dot(r, f))
    yield ("R in the reciprocal basis", scaled(den, r), right)
    # s = a - o, s + e = b - o, s + f = c - o: the sides of the edges, and along an axis.
    b, c = plus(s, e), plus(s, f)
    n = cross(e, f)
    sides = (dot(d, cross(b, c)), dot(d, cross(c, s)), dot(d, cross(s, b)))
    yield ("the sides are W, U and V", sides, (den + dot(r, f) - dot(r, e), -dot(r, f), dot(r, e)))
    moved = plus(s, ds, -1), plus(b, ds, -1)
    yield ("a side when the origin is shifted", dot(d, cross(*moved)),
           dot(d, cross(s, b)) + dot(ds, cross(d, e)))
    yield ("T when the origin is shifted", dot(n, moved[0]), dot(n, s) - dot(n, ds))
    areas = cross(b, c), cross(c, s), cross(s, b)
    for k in range(3):
        yield ("the sides along an axis add up to N", sum(area[k] for area in areas), n[k])
        yield ("T from the sides along an axis",
               sum(area[k] * p[k] for area, p in zip(areas, (s, b, c))), dot(n, s))


def entries(number):
    """D times a computed entry, less P - O, and its parts; the names are those of box.g."""
    ko, kf, kp, plane, origin, slope, moved, rest = (number() for _ in range(8))
    dd, do, p1, p2, p3, e1, e2, e3, e4, e5, e6, e7 = (1 + number() for _ in range(12))
    inverse = fractions.Fraction(e1, slope * dd)
    k = fractions.Fraction(e1 * e2, dd)
    for p_sign, o_sign in itertools.product((-1, 1), repeat=2):
        near = p_sign * plane * (1 - p_sign * kp)
        o = o_sign * origin
        pad = (ko * origin * p1 + kf) * p2 * p3 * inverse
        true = p_sign * plane - rest - (o * do + moved)
        floor = rest + moved - k * kf * p2 * p3 * e5
        one = (near * inverse * e3 + (-o * inverse * e4 - pad) * e5) * e2
        yield ("the entry of a ray", slope * one - true,
               plane * p_sign * (k * e3 * (1 - p_sign * kp) - 1)
               + origin * (o_sign * do - k * e5 * (o_sign * e4 + ko * p1 * p2 * p3)) + floor)
        packet = ((near - o) * e6 * inverse * e7 - pad) * e2
        both = k * e6 * e7
        yield ("the entry of a packet", slope * packet - true,
               plane * p_sign * (both * (1 - p_sign * kp) - 1)
               + origin * (o_sign * do - o_sign * both - k * ko * p1 * p2 * p3)
               + rest + moved - k * kf * p2 * p3)


def main():
    largest = largest_determinant()
    if largest != 4:
        sys.exit(f"the largest determinant of signs is {largest}, not 4")
    generator = random.Random(1)
    number = lambda: generator.randint(-2 ** 40, 2 ** 40)
    vector = lambda: (number(), number(), number())
    count = 0
    for _ in range(20):
        for name, left, right in itertools.chain(identities(vector, number), entries(number)):
            if left != right:
                sys.exit(f"not an identity: {name}")
            count += 1
    print(f"largest determinant of signs: 4; {count} evaluations of identities agree")


if __name__ == "__main__":
    main()
