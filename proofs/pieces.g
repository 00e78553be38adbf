# SPDX-License-Identifier: Apache-2.0
#
# What boxes hold (docs/algorithm.md, "The box test"): in double arithmetic, the part of a triangle
# on one side of a plane, and a point, however they were rounded.
@f64 = float<ieee_64, ne>;

# Where the edge from (P, p) to (Q, q) meets the plane at `place`, P <= place <= Q: `part` of the
# way. One component of that point, as cut() computes it and as it is, and the box around it. The
# two differences on the axis of the plane are off by h1 and h2 of themselves.
along = f64(part * (1 + h1) / (1 + h2));
size = f64(q - p);
product = f64(along * size);
middle = f64(p + product);
exact = p + part * (q - p);
lower = f64(middle - kCutSlack);
upper = f64(middle + kCutSlack);

# A point x of a triangle, computed twice: as the point that is asked about, and by way of the
# corners, below which the plane of a box is not. (The other way round is a mirror image.)
asked = x + x1;
plane = f64(x + x2 - kPointPad);

{ p in [-1, 1] /\ q in [-1, 1] /\ q - p in [-2, 2] /\ exact in [-1, 1] /\ part in [0, 1]
  /\ |h1| <= 1b-53 /\ |h2| <= 1b-53
  /\ x in [-1, 1] /\ |x1| <= 1b-53 /\ |x2| <= 1b-53
  -> lower - exact <= 0 /\ upper - exact >= 0 /\ plane - asked <= 0 }

along - part -> (along - part * (1 + h1) / (1 + h2)) + part * ((h1 - h2) / (1 + h2))
  { 1 + h2 <> 0 };
middle - exact -> (middle - (p + product)) + (product - along * size)
  + along * (size - (q - p)) + (along - part) * (q - p);
lower - exact -> (lower - (middle - kCutSlack)) + (middle - exact) - kCutSlack;
upper - exact -> (upper - (middle + kCutSlack)) + (middle - exact) + kCutSlack;
plane - asked -> (plane - (x + x2 - kPointPad)) + x2 - x1 - kPointPad;
