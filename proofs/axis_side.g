# SPDX-License-Identifier: Apache-2.0
#
# The cull along an axis (docs/algorithm.md, "Along an axis"): how far copies and points are from
# the true ones, what rounds a side of a shadow, what underflows, and the coefficients of its bound,
# at reach 1. (Of the floor nothing but underflow is asked, so that it need not scale.)
u = 1b-24;
u1 = 0x1.0001p-24;
@f32 = float<ieee_32, ne>;

# A corner's copy, and a point's.
copy = f32(corner);

# A product so small that it may be subnormal. (Differences of floats are then exact.)
product = f32(tiny);

# A side, not fused, of differences divided by the largest of them.
side_f = sub_rel<24>(mul_rel<24>(qi, rj), mul_rel<24>(qj, ri));
side_r = qi * rj - qj * ri;

# Each difference is off by `inputs` for its two copies and by u1 m for its own rounding. The bound
# is evaluated with at most 8 roundings.
inputs = 2 * (1b-25 + 1b-53);
square = 4 * u1 + 2 * u1 * u1 + 0x4.0001p-24 - kAxisSquare * (1 - 8 * u);
linear = 4 * inputs + 4 * inputs * u1 - kAxisInput * (1 - 8 * u);
rest = 2 * inputs * inputs - kAxisInput * kAxisMore * (1 - 8 * u);
# Two products of the side; and of the bound, which comes out smaller, m times one (m <= 2) and one.
underflow = (2 * (1 + 2 * u) + 2 * u1 + 2 + 1) * 1b-150 - kAxisFloor * (1 - 8 * u);

{ |corner| <= 1 /\ |tiny| <= 1b-126 /\ |qi| <= 1 /\ |qj| <= 1 /\ |ri| <= 1 /\ |rj| <= 1
  -> |copy - corner| <= 1b-25 /\ |product - tiny| <= 1b-150 /\ |side_f - side_r| <= 0x4.0001p-24
     /\ square <= 0 /\ linear <= 0 /\ rest <= 0 /\ underflow <= 0 }
