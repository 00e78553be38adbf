# SPDX-License-Identifier: Apache-2.0
#
# Of a ray along an axis, U, V and W are differences of two products, each within 8b-106 of itself
# (src/predicate/quotient.h), and have one sign; den is their sum in double-doubles, two sums of
# 8b-106 each; the quotient adds 64b-106 (kFineQuotientFactor). u, v and w are off by no more than
# kAlongAxisWeights of themselves. Shown for units of 1b-40, which Gappa's numbers can tell from 1:
# of smaller ones less is lost where they are multiplied with each other.
weight = 1 + 8b-40;
den = (1 - 8b-40) * (1 - 8b-40) * (1 - 8b-40);
quotient = 1 + 64b-40;

weights_err = weight * quotient / den - 1;

{ weights_err - kAlongAxisWeights * 1b66 * (1 - 64b-53) <= 0 }
