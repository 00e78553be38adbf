#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""The worked example of docs/algorithm.md: one ray and one triangle through every rung.

Every number of it is computed here, in fractions that are rounded where the rung rounds (products
that are added are not fused), with the constants of src/predicate/bounds.h.

usage: check_example.py --bounds PRINT_BOUNDS PAGE.md    exit status 1 if the page says otherwise
       check_example.py --bounds PRINT_BOUNDS --write PAGE.md
"""
import argparse
import pathlib
import sys
from fractions import Fraction

import run_proof

BEGIN, END = "<!-- example: begin -->\n", "<!-- example: end -->\n"
# In units of 2^-24. The ray meets the edge from a to c in (1/4, 1/8, 1/2), a third of the way.
UNIT = 24
A = (5033165, 10066330, 11744051)
C = tuple(3 * x - 2 * a for x, a in zip((2 ** 22, 2 ** 21, 2 ** 23), A))
B = (-10066330, -11744051, 0)
D = (15099495, 0, 25165824)
O = tuple(x - 4 * d // 3 for x, d in zip((2 ** 22, 2 ** 21, 2 ** 23), D))


def rounding(bits):
    """To the nearest number of so many bits, ties to even; nothing here over- or underflows."""
    def to_nearest(x):
        if x == 0:
            return x
        place = abs(x.numerator).bit_length() - x.denominator.bit_length()
        place -= Fraction(2) ** place > abs(x)  # 2^place <= |x| < 2^(place + 1)
        unit = Fraction(2) ** (place - bits + 1)
        return round(x / unit) * unit  # Python's round takes ties to even, too
    return to_nearest


def exactly(x):
    return x


class Pair:
    """S, E1, E2, d and the determinants, every operation rounded."""

    def __init__(self, rnd, z_first):
        def minus(p, q):
            return [rnd(x - y) for x, y in zip(p, q)]

        def cross(p, q):
            return [rnd(rnd(p[i - 2] * q[i - 1]) - rnd(p[i - 1] * q[i - 2])) for i in range(3)]

        def dot(p, q):
            x, y, z = (rnd(f * g) for f, g in zip(p, q))
            return rnd(x + rnd(y + z)) if z_first else rnd(rnd(x + y) + z)

        a, b, c, o, self.d = ([Fraction(x, 2 ** UNIT) for x in p] for p in (A, B, C, O, D))
        self.s, self.e1, self.e2 = minus(a, o), minus(b, a), minus(c, a)
        self.n, r = cross(self.e1, self.e2), cross(self.d, self.s)
        self.den, self.u, self.v = dot(self.n, self.d), -dot(r, self.e2), dot(r, self.e1)
        self.w = rnd(rnd(self.den - self.u) - self.v)
        self.t = dot(self.n, self.s)


def norm(p):
    return max(abs(x) for x in p)


def reach(size):
    """The least power of two that is not below."""
    mu = Fraction(1)
    while mu / 2 >= size:
        mu /= 2
    while mu < size:
        mu *= 2
    return mu


def example(k):
    """The text; k: the constants' values by name."""
    eps, h = Fraction(1, 2 ** 24), Fraction(1, 2 ** 53)
    flt, dbl, true = Pair(rounding(24), True), Pair(rounding(53), False), Pair(exactly, True)
    if true.u != 0 or true.v / true.den != Fraction(1, 3) or true.t / true.den != Fraction(4, 3):
        sys.exit("the example is not what it is said to be")
    edge = norm([norm(true.e1), norm(true.e2)])
    corners, origin = (Fraction(max(map(norm, points)), 2 ** UNIT) for points in ((A, B, C), (O,)))
    mu = max(reach(corners), reach(origin / k["kNearOrigin"]), k["kSmallestReach"])
    e = edge * (k["kEdgeLinear"] * mu + k["kEdgeSquare"] * edge) + k["kEdgeFloor"] * mu ** 2
    err = (norm(flt.n) * k["kTauReach"] * norm(flt.s) + k["kTauCube"] * edge ** 3
           + k["kTauFloor"]) / flt.den
    uv_err = k["kUvFactor"] * norm(dbl.d) * norm(dbl.s) * max(norm(dbl.e1), norm(dbl.e2))
    den_err = k["kDenFactor"] * norm(dbl.e1) * norm(dbl.e2) * norm(dbl.d)
    t_err = k["kTFactor"] * norm(dbl.e1) * norm(dbl.e2) * norm(dbl.s)
    q = dbl.t / dbl.den
    q_err = (t_err + q * den_err) / dbl.den * k["kQuotientRoom"] + k["kQuotientFactor"] * q
    # What the text beside the block says of these numbers.
    tau = flt.t / flt.den
    if not (-e <= flt.u < 0 and flt.den > k["kSumFactor"] * e and abs(dbl.u) <= uv_err
            and dbl.u < 0 and dbl.den > den_err and abs(tau - Fraction(4, 3)) <= err
            and abs(q - Fraction(4, 3)) <= q_err
            and rounding(24)(q - q_err) == rounding(24)(q + q_err)):
        sys.exit("the rungs do not say what the page says of them")
    t, v, w = (float(rounding(24)(x / true.den)) for x in (true.t, true.v, true.w))
    rows = [f"{name} = ({', '.join(f'{x:9d}' for x in p)}) 2^-{UNIT}"
            for name, p in (("a", A), ("b", B), ("c", C), ("o", O), ("d", D))]
    rows += [
        "",
        f"float   E = {float(edge):.4f}   mu = {float(mu):g}   e = {float(e / eps):.1f} eps   "
        f"2e = {float(2 * e / eps):.1f} eps",
        f"        den_f = {float(flt.den):.7f}   u_f = {float(flt.u / eps):g} eps   "
        f"v_f = {float(flt.v):.7f}   w_f = {float(flt.w):.7f}",
        f"        tau = {float(tau):.7f} -+ {float(err):.7f}",
        f"double  den = {float(dbl.den):.16f}   den_err = {float(den_err / h):.1f} * 2^-53",
        f"        U = {float(dbl.u / h):g} * 2^-53   uv_err = {float(uv_err / h):.1f} * 2^-53",
        f"exact   den = {true.den * 2 ** 72} * 2^-72   U = {true.u}",
        f"        V / den = {true.v / true.den}   W / den = {true.w / true.den}   "
        f"T / den = {true.t / true.den}",
        f"round   T / den = {float(q):.16f} -+ {float(q_err / h):.1f} * 2^-53, in double",
        f"        t = {t:.9g}   u = {float(true.u):g}   v = {v:.9g}   w = {w:.9g}",
    ]
    return "```text\n" + "\n".join(rows) + "\n```\n"


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--bounds", required=True)
    parser.add_argument("--write", action="store_true")
    parser.add_argument("page", type=pathlib.Path)
    options = parser.parse_args()
    values = {name: m * Fraction(2) ** e
              for name, (m, e) in run_proof.constants(options.bounds).items()}
    page = options.page.read_text(encoding="utf-8")
    before, rest = page.split(BEGIN)
    said, after = rest.split(END)
    text = example(values)
    if options.write:
        options.page.write_text(before + BEGIN + text + END + after, encoding="utf-8")
    elif said != text:
        sys.exit(f"{options.page.name}, the worked example: these are the numbers\n{text}")


if __name__ == "__main__":
    main()
