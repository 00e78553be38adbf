# SPDX-License-Identifier: Apache-2.0
#
# Blurred rays (docs/algorithm.md, "Spaces of their own"): what a displacement by B, of corners and
# line together, adds to the errors of the leaf cull, of tau and of the box test, coefficient by
# coefficient; what bringing a point to another space rounds.
u = 1b-24;
s1 = 0x1.0001p-24;

# U or V and den, W: of B E, of B^2; and of u B, for which B^2 and the floor have room: there
# x^2 a - x b + c has no zero if b^2 < 4 a c.
edge = 24 + 32 + 300 * s1 - kBlurEdge * (1 - 8 * u);
square = kBlurSquare * (1 - 8 * u) - (64 + 32 + 40 * s1);
edge_w = 2 * 24 + 32 + 700 * s1 - kSumFactor * kBlurEdge * (1 - 8 * u);
square_w = kSumFactor * kBlurSquare * (1 - 8 * u) - (2 * 64 + 32 + 80 * s1);
floor = (kEdgeFloor * (1 - 8 * u)) / (u * u) - 158;
mixed = 225 * 225 - 4 * square * floor;
mixed_w = 432 * 432 - 4 * square_w * (kSumFactor * floor);

# Tau's numerator, of B |N| (|N| <= 2 E^2), of B E^2 and of B^2 E, all as B E^2: where
# 12 E^2 >= den > 2 e, E > 10 B and E > 14.9 u (E_B = B / E, E_u = u / E at most).
E_B = 12 / (kSumFactor * kBlurEdge * (1 - 8 * u));
E_u = 12 / (kSumFactor * kEdgeLinear * (1 - 8 * u)) * u;
normal = 2 * (3 + 60 * s1);
square_tau = (48 + 32 * E_B + 48 * E_u) * E_B;
tau = 16 + 72 * E_u + 24 * s1 + normal + square_tau - kBlurTau * (1 - 16 * u);

# Tau of a hit, and theta, which were 3.0001 and 6.51 u: hits are within 1 + B.
theta = 3.5 + 3 + 2 * kLargestBlur - 6.51;

# A line or a point in another space: three products, three sums.
affine_f = add_rel<53>(add_rel<53>(mul_rel<53>(x, p), mul_rel<53>(y, q)),
                       add_rel<53>(mul_rel<53>(z, r), w));
affine_r = (x * p + y * q) + (z * r + w);

# The box test's floor: its own roundings, and that of the pad (7 of them), are in what B is made
# larger by.
pad = (1 + 1b-20) * (1 - 2 * u) * (1 - 8 * u);

{ |x| <= 1 /\ |y| <= 1 /\ |z| <= 1 /\ |w| <= 1 /\ |p| <= 1 /\ |q| <= 1 /\ |r| <= 1
  -> edge <= 0 /\ square >= 0 /\ edge_w <= 0 /\ square_w >= 0 /\ mixed <= 0 /\ mixed_w <= 0
     /\ tau <= 0 /\ theta <= 0 /\ pad >= 1
     /\ |affine_f - affine_r| - 4 * kLocalRound <= 0 }

affine_f ~ affine_r;
