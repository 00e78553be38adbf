# SPDX-License-Identifier: Apache-2.0
#
# The double rung's W = (den - U) - V of the computed den, U and V (docs/algorithm.md, "The double
# rung"): its own two roundings. The standard model: every operation off by at most 2^-53 of its
# result. All is divided by |den| + |U| + |V|, so that no partial sum is beyond 1.
first = sub_rel<53>(den, u);
w = sub_rel<53>(first, v);
First = den - u;
W = First - v;

{ |First| <= 1 /\ |W| <= 1
  -> |w - W| - kWFactor * (1 - 16b-53) <= 0 }
w - W -> (w - (first - v)) + (first - First);
first - v -> W + (first - First);
