# SPDX-License-Identifier: Apache-2.0
#
# The transform into filter space (docs/algorithm.md, "Filter space"): how far moved origins reach,
# how far they are from their line, where |tau| ends, and that the ends of the range survive their
# rounding to float.
v = 1b-53;

# The foot of the perpendicular, found to within 8 roundings of |o| <= sqrt(3) kFarthestOrigin.
slip = 8.01 * v * 1.7321 * kFarthestOrigin;
distance2 = 3.001 + slip * slip;

# A component of the moved origin, o = sum.high + (sum.low + (product.low + origin_low)), in units
# of the distance, from kKeptOrigin to kFarthestOrigin. The two low parts of the inner sum, its
# rounding; the low part of the sum of the high ones, which is at most kNearOrigin and what the low
# parts add; the rounding of that. The last rounding is of the result itself.
inner = v * (1.7321 + 1) * (1 + v);
high = (kNearOrigin * closeness + inner) * (1 + 3 * v);
middle = v * high + inner;
move_err = v * inner + v * middle - kMoveError;

# With the last rounding, of a result within kNearOrigin times the reach: in units of the reach,
# which is at least kMoveError 2^49 times the distance but for its own rounding, and at most 1.
moved_err = 1b-49 * (1 + 1b-23) + v * kNearOrigin;
reach_at_most = kMoveError * 1b49 * kFarthestOrigin * (1 + 1b-23);

# A point of the box: |tau| = |point - origin| / |direction|.
last_tau = 1 + kKeptOrigin + 1b-48;

# The ends of the range, of moved rays within 2^-52 of themselves (h4) or 2^-50: the pad, its sum
# with the end, in double, and that as a float. Towards 0 and away from it, what is left over on the
# wrong side, over the end's magnitude; and what the floor has to cover besides: of kept rays a
# float that is subnormal, of moved ones an end that is within 2^-50 of the true one.
pad = kTauPad * (1 + h1);
inward = (1 + h4) * (1 - pad) * (1 + h2) * (1 + h3) - 1;
outward = 1 - (1 + h4) * (1 + pad) * (1 + h2) * (1 + h3);
kept = 1b-149 - kTauFloorKept * (1 + h1) * (1 + h2) * (1 + h3);
moved = 1b-50 - kTauFloorMoved * (1 + h1) * (1 + h2) * (1 + h3);

{ closeness * kNearOrigin in [1b-48, 1] /\ |h1| <= 1b-53 /\ |h2| <= 1b-53 /\ |h3| <= 1b-24
  /\ |h4| <= 1b-52
  -> distance2 - kNearOrigin * kNearOrigin <= 0 /\ last_tau - kTauLimit <= 0
     /\ move_err <= 0 /\ moved_err <= 1b-48 /\ reach_at_most <= 1
     /\ inward <= 0 /\ outward <= 0 /\ kept <= 0 /\ moved <= 0 }
