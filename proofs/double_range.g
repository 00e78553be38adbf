# SPDX-License-Identifier: Apache-2.0
#
# The double rung's comparison of T with t_0 den (docs/algorithm.md, "The double rung"), of the
# computed T and den: the rounding of the product and of the difference. The standard model: every
# operation off by at most 2^-53 of its result. All is divided by |product| + |difference| as
# computed; so what they round is next to nothing beyond 1. What underflows is counted apart.
product = mul_rel<53>(bound, den);
difference = sub_rel<53>(t, product);
Product = bound * den;
Rounded = t - product;
Difference = t - Product;

# A product so small that it may be subnormal, and the bound's own roundings.
@f64 = float<ieee_64, ne>;
small = f64(tiny);
underflow = 1b-1075 - kRangeFloor * (1 - 16b-53);

{ |Product| <= 0x1.00000001p0 /\ |Rounded| <= 0x1.00000001p0 /\ |tiny| <= 1b-1022
  -> |difference - Difference| - kRangeFactor * (1 - 16b-53) <= 0
     /\ |small - tiny| <= 1b-1075 /\ underflow <= 0 }
difference - Difference -> (difference - Rounded) - (product - Product);
