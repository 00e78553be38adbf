# SPDX-License-Identifier: Apache-2.0
#
# Double-double (docs/algorithm.md, "Rounding"): one product and one sum are within 8 * 2^-106,
# and the determinants built from them within kDoubleDoubleFactor times the product of the
# operands' maxima; W and quotients within what their bounds add to that.
w = 1b-106;

# A product of numbers with high parts of 1: what is left is lost or rounded.
product_low = add_rel<53>(low, add_rel<53>(mul_rel<53>(1, bl), mul_rel<53>(al, 1)));
product_r = low + (1 * bl + al * 1);

# A sum of numbers whose magnitudes add up to 1.
sum_low = add_rel<53>(sl, add_rel<53>(cl, dl));
sum_r = sl + (cl + dl);

# A determinant with the worst of each: operands within 1, each operation off by 8 w of its size.
n_err = 2 * (8 * w) + 8 * w * 2.001;
term_err = n_err * 1.001 + 8 * w * 2.001;
pair_err = 2 * term_err + 8 * w * 4.002;
det_err = pair_err + term_err + 8 * w * 6.003;

# W: two differences of numbers whose magnitudes add up to 1; the bound's own part, made finer.
w_err = 2 * (8 * w) * 1.001;
w_own = kWFactor * kFiner;

# A quotient near 1: off by at most four roundings at first (the inverse, the product with it, two
# low parts left out), then by a product with a double and a difference that cancels, by the low
# part of what is left, and by what it is divided with.
first_err = 4.001 * 1b-53;
quotient_err = 3 * w * 1.001 + 8 * w * 2.001 + 1b-53 * first_err + 3.001 * 1b-53 * first_err;

{ |low| <= 1b-53 /\ |al| <= 1b-53 /\ |bl| <= 1b-53 /\ |sl| <= 1b-53
  /\ |cl| <= 1b-53 /\ |dl| <= 1b-53
  -> |product_low - product_r| + |al * bl| <= 0x8.0001p-106 /\ |sum_low - sum_r| <= 6b-106
     /\ det_err - kDoubleDoubleFactor * (1 - 64b-53) <= 0
     /\ det_err - kFiner * kDenFactor * (1 - 64b-53) <= 0
     /\ det_err - kFiner * kUvFactor * (1 - 64b-53) <= 0
     /\ det_err - kFiner * kTFactor * (1 - 64b-53) <= 0
     /\ w_err - w_own * (1 - 64b-53) <= 0
     /\ quotient_err - kFineQuotientFactor * (1 - 64b-53) <= 0
     /\ 1b-53 - kFineEnds * (1 - 64b-53) <= 0 }
