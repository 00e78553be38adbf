# SPDX-License-Identifier: Apache-2.0
#
# Compensated arithmetic (docs/algorithm.md, "Rounding"): determinants of the differences of
# doubles are within kDoubleDoubleFactor times the product of the operands' maxima, and W and
# quotients within what their bounds add to that. Operands are within 1; `_low` is how large a low
# part may be, `_err` what high + low may be off by. Nothing is supposed to be fused.
u = 1b-53;
w = 1b-106;

# A product of differences, whose low parts are within u; fused, it would be rounded less often.
difference_product = add_rel<53>(p, add_rel<53>(mul_rel<53>(ah, bl), mul_rel<53>(al, bh)));
difference_product_r = p + (ah * bl + al * bh);
product_err = 8.001 * w;
product_low = 3.001 * u;

# A component of the normal: the difference of two, its high part and what that lost within 2.
normal = add_rel<53>(q, add_rel<53>(cl, dl));
normal_r = q + (cl + dl);
normal_err = 2 * product_err + 14.1 * w;
normal_low = 8.01 * u;

# Its product with a difference.
term = add_rel<53>(r, add_rel<53>(mul_rel<53>(nh, bl), mul_rel<53>(nl, bh)));
term_r = r + (nh * bl + nl * bh);
term_err = normal_err * 1.001 + 40.1 * w;
term_low = 12.02 * u;

# The sum of two terms, and of three.
two = add_rel<53>(x, add_rel<53>(fl, gl));
two_r = x + (fl + gl);
two_err = 2 * term_err + 52.2 * w;
two_low = 28.05 * u;
three = add_rel<53>(y, add_rel<53>(fl, hl));
three_r = y + (fl + hl);
three_err = two_err + term_err + 86.3 * w;
three_low = 46.1 * u;

# W, of determinants within 1 each: what den's part in it (U's is the same) and V's may be off by.
den_low = three_low * 1.001 + 6.003 * u;
w_den_err = three_err + three_low * u * 1.001 + den_low * u
  + den_low * u * 1.001 + (den_low + 6.003 * u) * u * 1.001;
w_v_err = three_err + three_low * u * 1.001 + den_low * u * 1.001;

# A quotient near 1 of normalized numbers: at first off by four roundings (the inverse, the product
# with it, two low parts left out). What is left of the numerator is rounded, and what the low parts
# add to it, and the sum; then it is divided.
rest_err = (4.001 * u) * u + (2 * u + 2.001 * u) * u + (4.001 * u) * u;
quotient_err = rest_err + (2.001 * u) * (4.001 * u) + u * (4.002 * u);

{ |p| <= 1b-53 /\ |ah| <= 1 /\ |bh| <= 1 /\ |al| <= 1b-53 /\ |bl| <= 1b-53
  /\ |q| <= 0x2.001p-53 /\ |cl| <= 0x3.01p-53 /\ |dl| <= 0x3.01p-53
  /\ |r| <= 0x2.001p-53 /\ |nh| <= 0x2.001p0 /\ |nl| <= 0x8.03p-53
  /\ |x| <= 0x4.003p-53 /\ |fl| <= 0xc.06p-53 /\ |gl| <= 0xc.06p-53
  /\ |y| <= 0x6.005p-53 /\ |hl| <= 0x1c.1p-53
  -> |difference_product - difference_product_r| + |al * bl| - product_err <= 0
     /\ |difference_product| - product_low <= 0
     /\ |normal - normal_r| - 14.1 * w <= 0 /\ |normal| - normal_low <= 0
     /\ |term - term_r| + |nl * bl| - 40.1 * w <= 0 /\ |term| - term_low <= 0
     /\ |two - two_r| - 52.2 * w <= 0 /\ |two| - two_low <= 0
     /\ |three - three_r| - 86.3 * w <= 0 /\ |three| - three_low <= 0
     /\ three_err - kDoubleDoubleFactor * (1 - 64b-53) <= 0
     /\ three_err - kFiner * kDenFactor * (1 - 64b-53) <= 0
     /\ w_den_err - kFiner * kDenFactor * (1 - 64b-53) <= 0
     /\ w_v_err - kFiner * kUvFactor * (1 - 64b-53) <= 0
     /\ quotient_err - kFineQuotientFactor * (1 - 64b-53) <= 0 }
