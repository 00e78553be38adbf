# SPDX-License-Identifier: Apache-2.0
#
# The interval of t = T / den (docs/algorithm.md, "The double rung"), t -+ error with
#   error = (T_err + |t| den_err) / (|den| - den_err) + kIntervalFactor |t|,
# all of it rounded. h1 ... h8 are the roundings on the longest way: |t| itself, its product, the
# sum, the difference below, the quotient, the last sum, the end.
first = (1 + h1) * (1 + h2) * (1 + h3) / (1 + h4) * (1 + h5) * (1 + h6) * (1 - 1b-53);
# The quotient is off by 2^-53 of itself, and so is the end.
own = kIntervalFactor * (1 + h1) * (1 + h7) * (1 + h6) * (1 - 1b-53);

{ h1 in [-1b-53, 1b-53] /\ h2 in [-1b-53, 1b-53] /\ h3 in [-1b-53, 1b-53]
  /\ h4 in [-1b-53, 1b-53] /\ h5 in [-1b-53, 1b-53] /\ h6 in [-1b-53, 1b-53]
  /\ h7 in [-1b-53, 1b-53]
  -> first >= 0x1.ffffffffffff8p-1 /\ own >= 0x2.03p-53 }
