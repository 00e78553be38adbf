# SPDX-License-Identifier: Apache-2.0
#
# The double rung's side of a shadow, q_i r_j - q_j r_i (docs/algorithm.md, "Along an axis"). The
# standard model: every operation off by at most 2^-53 of its result. Capitals are the true numbers;
# all is divided by the larger of the two computed products. What underflows is counted apart.
left = mul_rel<53>(qi, rj);
right = mul_rel<53>(qj, ri);
side = sub_rel<53>(left, right);
Left = Qi * Rj;
Right = Qj * Ri;
Side = Left - Right;

# A product so small that it may be subnormal: two of the side, and the bound's own.
@f64 = float<ieee_64, ne>;
product = f64(tiny);
underflow = 3.01 * 1b-1075 - kSideFloor * (1 - 4b-53);

{ qi -/ Qi in [-1b-53, 1b-53] /\ qj -/ Qj in [-1b-53, 1b-53]
  /\ ri -/ Ri in [-1b-53, 1b-53] /\ rj -/ Rj in [-1b-53, 1b-53]
  /\ Left in [-0x1.00000001p0, 0x1.00000001p0] /\ Right in [-0x1.00000001p0, 0x1.00000001p0]
  /\ |tiny| <= 1b-1022
  -> |side - Side| - kSideFactor * (1 - 4b-53) <= 0
     /\ |product - tiny| <= 1b-1075 /\ underflow <= 0 }
left ~ Left;
right ~ Right;
side ~ Side;
