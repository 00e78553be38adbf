# SPDX-License-Identifier: Apache-2.0
#
# Of a ray along an axis, tau is a mean of the corners' places, weighted by U, V and W
# (docs/algorithm.md, "Along an axis alone"). The weights' magnitudes add up to 1, the places are
# within 1, and the direction's component is at least 1: tau is off by no more than kAlongAxis.
grow = 1 + 1b-53;
shrink = 1 - 1b-53;

# A weight and a place are rounded once, their product once, and two sums.
weighted = grow * grow * grow * grow * grow;
# The weights, two sums, and the product with the direction.
divided_by = shrink * shrink * shrink * shrink;

tau_err = weighted * grow / divided_by - 1;

# What a place lost into the subnormals of float, over a direction of at least 1.
lost = 1.0001 * 1b-150;

{ tau_err - kAlongAxis * (1 - 64b-53) <= 0 /\ lost - kLostAlongAxis * (1 - 64b-53) <= 0 }
