# SPDX-License-Identifier: Apache-2.0
#
# Quotients to float (docs/algorithm.md, "Rounding"): q = n (1 / den) in double, and the ends
# q -+ error of its interval,
#   error = (n_err + |q| den_err) (|1 / den| kQuotientRoom) + kQuotientFactor |q|,
# all of it rounded. h1 ... h8 are the roundings on the longest way: the inverse, q, its product,
# the sum, the room, the product with it, the last sum, the last product.
first = (1 + h1) * (1 + h1) * (1 + h2) * (1 + h3) * (1 + h4) * (1 + h5) * (1 + h6) * (1 + h7)
  * (1 - 1b-53) * kQuotientRoom;
# What it has to be: den / (den - den_err), for |den| > kQuotientClear den_err.
Needed = 1 / (1 - ratio);
# The inverse, the product and the end: 2^-53 each.
own = kQuotientFactor * (1 + h1) * (1 + h2) * (1 + h8) * (1 + h7) * (1 - 1b-53);
Own = 0x3.03p-53;

{ h1 in [-1b-53, 1b-53] /\ h2 in [-1b-53, 1b-53] /\ h3 in [-1b-53, 1b-53]
  /\ h4 in [-1b-53, 1b-53] /\ h5 in [-1b-53, 1b-53] /\ h6 in [-1b-53, 1b-53]
  /\ h7 in [-1b-53, 1b-53] /\ h8 in [-1b-53, 1b-53]
  /\ kQuotientClear * ratio in [0, 0x1.000001p0]
  -> first - Needed >= 0 /\ own - Own >= 0 }
ratio -> (kQuotientClear * ratio) / kQuotientClear;
