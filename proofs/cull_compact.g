# SPDX-License-Identifier: Apache-2.0
#
# What corners that are off by h more add to the bounds of the leaf cull (docs/algorithm.md,
# "Compact leaves"): the parts of step 2 with sigma + h, eta + 2 h, theta + h, less those without h,
# sorted by h E and h^2. h is at least 2 u, so that u h counts as h^2 / 2; E is at most 2.
u = 1b-24;

# Of U: det(d, sigma, E2) 8 h E; |R| |eta|, (8 E + 52 u + 8 h) (u + u E + 2 h) less (8 E + 52 u)
# (u + u E); the arithmetic of a larger R, 13 u h E.
u_linear = 8 + 16;
u_uh = 2 * 52 + 8 * (1 + 2) + 2 * 13;
u_square = 16 + u_uh / 2;

# Of den: det(eta1, e2, d) + det(E1, eta2, d), 2 * 8 E 2 h; det(eta1, eta2, d), 8 (u + u E + 2 h)^2.
den_linear = 32;
den_uh = 32 * (1 + 2);
den_square = 32 + den_uh / 2;

room = 1 - 32 * u;
u_fits = u_linear + den_linear - kCopyLinear * room;
u_fits_square = u_square + den_square - kCopySquare * room;
w_fits = den_linear + 2 * u_linear - kSumFactor * kCopyLinear * room;
w_fits_square = den_square + 2 * u_square - kSumFactor * kCopySquare * room;

# Of tau: n . sigma, 3 h |n|; n . Q, 2 * 4 * 2 h E^2.
input_fits = 3 - kCopyTauInput * room;
square_fits = 16 - kCopyTauSquare * room;

{ u_fits <= 0 /\ u_fits_square <= 0 /\ w_fits <= 0 /\ w_fits_square <= 0
  /\ input_fits <= 0 /\ square_fits <= 0 }
