# SPDX-License-Identifier: Apache-2.0
#
# What is rounded before the leaf cull multiplies, and the products of R, in float arithmetic
# (docs/algorithm.md, "The leaf cull", steps 1 and 3), at reach 1.
@rnd = float<ieee_32, ne>;

# Corners within 1, stored as doubles within 2^-53 of the true ones; the origin, a double within
# 2, placed to 2^-48; a component of the direction.
a = rnd(A + am);
o = rnd(O + om);
d = rnd(D);
b = rnd(B + bm);
s = rnd(a - o);
S = A - O;

# An edge before its own rounding, which is relative: one ulp of E.
edge = b - a;

# One component of R, not fused; a fused one has one product's error less.
r = dy * sz - dz * sy;
products = rnd(dy * sz) - rnd(dz * sy);

{ A + am in [-1, 1] /\ B + bm in [-1, 1] /\ O + om in [-2, 2] /\ D in [-2, 2] /\ a - o in [-3, 3]
  /\ |am| <= 1b-53 /\ |bm| <= 1b-53 /\ |om| <= 1b-48
  /\ |dy| <= 2 /\ |dz| <= 2 /\ |sy| <= 3 /\ |sz| <= 3
  -> |s - S| <= 0x3.8001p-24 /\ |d - D| <= 1b-24 /\ |edge - (B - A)| <= 0x1.0001p-24
     /\ |products - r| <= 8b-24 }

s - S -> (s - (a - o)) + (a - (A + am)) + am - (o - (O + om)) - om;
edge - (B - A) -> (b - (B + bm)) + bm - (a - (A + am)) - am;
