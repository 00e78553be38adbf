# SPDX-License-Identifier: Apache-2.0
#
# The place in the order (docs/algorithm.md): the coefficients of the bound of tau at reach 1, the
# rounding of a scalar product relative to its largest products, and underflow at any reach.
u = 1b-24;
s1 = 0x1.0001p-24;
dot_f = add_rel<24>(mul_rel<24>(x, p), add_rel<24>(mul_rel<24>(y, q), mul_rel<24>(z, r)));
dot_r = x * p + (y * q + z * r);

# In units of 1 / den: what is needed less what the bound gives, evaluated with at most 16
# roundings. Theta is at most 6.51 u, for exact rays u |S|: the last terms of input and reach.
c = 0x8.001p-24;
rest = 9.001 * u;
reach = c + c + 3 * s1 + 3 * s1 + rest + u * (c + rest) - kTauReach * (1 - 16 * u);
input = 4.5 * s1 + 6.51 * u * (c + 3 * s1 + rest) - kTauInput * (1 - 16 * u);
cube = 2 * (c + 3 * s1 + rest) + 8 * s1 + 12 * s1 - kTauCube * (1 - 16 * u);
square = 8 * s1 - kTauSquare * (1 - 16 * u);

# Underflow, 2^-150 a product: three of n_f . s^, three of n_f . d^, times tau, two of each
# component of n_f, times Q and little more, and two of the bound.
last_tau = 1 + kKeptOrigin + 1b-40;
floor = (3 + 3 * last_tau + 3 * 2 * 2.1 + 2) * (1 + 16 * u) * 1b-150 - kTauFloor * (1 - 16 * u);
# What comes with E^2: subnormal inputs (6 for each of S and tau), quotients (24) and kTauReach |S|
# (as much as S). kTauCube has room for it, as 12 E^2 > 2 e.
least_edge = 14.9 * u * kSmallestReach;
with_square = (6 * (1 + last_tau) + 24 + 2 * last_tau) * 1b-150 + cube * least_edge;

{ |x| <= 1 /\ |y| <= 1 /\ |z| <= 1 /\ |p| <= 1 /\ |q| <= 1 /\ |r| <= 1
  -> |dot_f - dot_r| <= 0x8.001p-24 /\ reach <= 0 /\ input <= 0 /\ cube <= 0 /\ square <= 0
     /\ floor <= 0 /\ with_square <= 0 }
