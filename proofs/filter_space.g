# SPDX-License-Identifier: Apache-2.0
#
# The transform into filter space (docs/algorithm.md, "Filter space"): how far moved origins reach,
# where |tau| ends, and that the ends of the range survive their rounding to float.
@f32 = float<ieee_32, ne>;
@f64 = float<ieee_64, ne>;

# The foot of the perpendicular, found to within 8 roundings of |o| <= sqrt(3) kFarthestOrigin.
slip = 8.01 * 1b-53 * 1.7321 * kFarthestOrigin;
distance2 = 3.001 + slip * slip;

# A component of the moved origin: parts of at most 2 |o| and the rounding of each sum.
moved_err = 4 * 1b-53 * (2 * 1b-53 * 1.7321 * kFarthestOrigin) + 2 * 1b-53 * (kNearOrigin + 1);

# A point of the box: |tau| = |point - origin| / |direction|.
reach = 1 + kNearOrigin + 1b-48;

# The ends of the range: t within 2^-50 of the true end, padded and rounded.
outward = f32(f64(t - kTauPad));
inward = f32(f64(t + kTauPad));

{ t in [-4, 4] -> distance2 - kNearOrigin * kNearOrigin <= 0 /\ moved_err <= 1b-48
  /\ reach - kTauLimit <= 0 /\ outward - t <= -1b-50 /\ inward - t >= 1b-50 }

outward - t -> (outward - (t - kTauPad)) - kTauPad;
inward - t -> (inward - (t + kTauPad)) + kTauPad;
