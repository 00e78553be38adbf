# SPDX-License-Identifier: Apache-2.0
#
# The float traversal to the nearest triangle (docs/algorithm.md, "Nearest points"): how far its
# bounds on a distance are off, what the comparison of squares needs, and from which length on
# underflow does not matter. All lengths are divided by R; i is the leaf's reach over R.
u = 1b-24;
u1 = 0x1.0001p-24;
root3 = 1.7320509;
@f32 = float<ieee_32, ne>;

# A corner's copy; and a product so small that it may be subnormal.
copy = f32(corner);
product = f32(tiny);

# A component of a corner as seen from the point: the copy, the point, the difference.
seen = 0x0.8001p-24 * i + u1 * (1 - i) + u1;
# A scalar product: at most three roundings, relative to its magnitudes; so is a sum of squares.
# What underflows is in the last place.
dot = 3.002 * u;
three = (1 + u) * (1 + u) * (1 + u) - 1 + 1b-34 - dot;
# Its root, as (1 - 1.502 u) (1 - u) and (1 + 1.502 u) (1 + u); then a division, a difference.
root_below = (1 - 1.502 * u) * (1 - 1.502 * u) - (1 - dot);
quotient = (1 + u) * (1 + u) - (1 + 4.51 * u) * (1 - 1.502 * u) * (1 - u);
# The root once more, and the sum with the bound.
sum = (1 - 3.51 * u) - (1 - 1.502 * u) * (1 - u) * (1 - u);

low = root3 * (2 * u1 + dot + 4.51 * u * (1 + 4 * u)) - kNearestLow;

# A component of a + v e1 + w e2: the corners' own errors (v and w add up to 1), two sums of at most
# 1 each, the edges' and the products' roundings (at most 2 i each, together), and v + w, which may
# be u / 2 above 1.
off = seen + 2 * u1 + (2 * u1 + 2 * u1 + u1) * i;
high = root3 * (9 * u1 + 3.51 * u * (1 + 9 * u)) - kNearestHigh;

# Both comparisons of squares, for lengths that are equal but for kNearestRoom: five roundings on
# either side for boxes, and one against nine (three of squared, one of each product, four of the
# limit before it is squared) for triangles.
below = (1 - u) * (1 - u) * (1 - u) * (1 - u) * (1 - u);
above = (1 + u) * (1 + u) * (1 + u) * (1 + u) * (1 + u);
boxes = above - kNearestRoom * kNearestRoom * below;
triangles = (1 + u) - kNearestRoom * kNearestRoom * below * (1 - u) * (1 - u) * (1 - u) * (1 - u);

# Three products that underflow, beside 2^-34 of a vector's square, and of its length (squared).
square_underflow = 3.01 * 1b-150 - 1b-34 * kNearestShortest;
length_underflow = 9.1 * 1b-300 - 1b-68 * kNearestShortest;
# And of a vector that is shorter still: beside what kNearestHigh has to spare of the least R.
short = 1b-73 + high * kSmallestReach;

{ |corner| <= 1 /\ |tiny| <= 1b-126 /\ i in [0, 1]
  -> |copy - corner| <= 1b-25 /\ |product - tiny| <= 1b-150 /\ root3 * root3 >= 3
     /\ seen <= 0x2.0002p-24 /\ three <= 0 /\ root_below <= 0 /\ quotient <= 0 /\ sum <= 0
     /\ off <= 0x9.0009p-24 /\ low <= 0 /\ high <= 0
     /\ boxes <= 0 /\ triangles <= 0
     /\ square_underflow <= 0 /\ length_underflow <= 0 /\ short <= 0 }
seen -> 2 * u1 + (0x0.8001p-24 - u1) * i;
off -> 4 * u1 + (0x0.8001p-24 + 4 * u1) * i;
