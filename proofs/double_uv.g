# SPDX-License-Identifier: Apache-2.0
#
# The double rung's V = R . E, R = d x S; U is the same with the other edge, up to sign
# (docs/algorithm.md, "The double rung"). The standard model: every operation off by at most 2^-53
# of its result. Operands are divided by their largest magnitude; capitals are the true numbers.
# Not fused (-ffp-contract=off).
rx = sub_rel<53>(mul_rel<53>(dy, sz), mul_rel<53>(dz, sy));
ry = sub_rel<53>(mul_rel<53>(dz, sx), mul_rel<53>(dx, sz));
rz = sub_rel<53>(mul_rel<53>(dx, sy), mul_rel<53>(dy, sx));
Rx = dy * Sz - dz * Sy;
Ry = dz * Sx - dx * Sz;
Rz = dx * Sy - dy * Sx;
v = add_rel<53>(add_rel<53>(mul_rel<53>(rx, ex), mul_rel<53>(ry, ey)),
  mul_rel<53>(rz, ez));
V = (Rx * Ex + Ry * Ey) + Rz * Ez;

{ ex in [-1, 1] /\ ex -/ Ex in [-1b-53, 1b-53]
  /\ ey in [-1, 1] /\ ey -/ Ey in [-1b-53, 1b-53]
  /\ ez in [-1, 1] /\ ez -/ Ez in [-1b-53, 1b-53]
  /\ sx in [-1, 1] /\ sx -/ Sx in [-1b-53, 1b-53]
  /\ sy in [-1, 1] /\ sy -/ Sy in [-1b-53, 1b-53]
  /\ sz in [-1, 1] /\ sz -/ Sz in [-1b-53, 1b-53]
  /\ dx in [-1, 1]
  /\ dy in [-1, 1]
  /\ dz in [-1, 1]
  -> |v - V| - kUvFactor * (1 - 16b-53) <= 0 }
rx ~ Rx;
ry ~ Ry;
rz ~ Rz;
v ~ V;
