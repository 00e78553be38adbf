# SPDX-License-Identifier: Apache-2.0
#
# The double rung's determinants by their own terms (docs/algorithm.md, "By terms"): each of the six
# products is rounded 8 times at most on its way into the sum (three differences, two products, a
# difference, two sums), and the sum of their sizes as often, with the factor once more. What goes
# in is 0 or at least kSmallestComponent: the product of three, and what is left of two such where
# they cancel, does not underflow.
grow = 1 + 1b-53;
shrink = 1 - 1b-53;
term = grow * grow * grow * grow * grow * grow * grow * grow;
sizes = shrink * shrink * shrink * shrink * shrink * shrink * shrink * shrink * shrink;

term_err = term - 1;
least = kSmallestComponent * kSmallestComponent * kSmallestComponent * 1b-106;

{ term_err - kTermwise * sizes <= 0 /\ least - 1b-1022 >= 0 }
