# SPDX-License-Identifier: Apache-2.0
#
# The double rung's T = N . S, N = E x F (docs/algorithm.md, "The double rung"). The standard
# model: every operation off by at most 2^-53 of its result. Operands are divided by their largest
# magnitude; capitals are the true numbers. Not fused (-ffp-contract=off).
nx = sub_rel<53>(mul_rel<53>(ey, fz), mul_rel<53>(ez, fy));
ny = sub_rel<53>(mul_rel<53>(ez, fx), mul_rel<53>(ex, fz));
nz = sub_rel<53>(mul_rel<53>(ex, fy), mul_rel<53>(ey, fx));
Nx = Ey * Fz - Ez * Fy;
Ny = Ez * Fx - Ex * Fz;
Nz = Ex * Fy - Ey * Fx;
t = add_rel<53>(add_rel<53>(mul_rel<53>(nx, sx), mul_rel<53>(ny, sy)),
  mul_rel<53>(nz, sz));
T = (Nx * Sx + Ny * Sy) + Nz * Sz;

{ ex in [-1, 1] /\ ex -/ Ex in [-1b-53, 1b-53]
  /\ ey in [-1, 1] /\ ey -/ Ey in [-1b-53, 1b-53]
  /\ ez in [-1, 1] /\ ez -/ Ez in [-1b-53, 1b-53]
  /\ fx in [-1, 1] /\ fx -/ Fx in [-1b-53, 1b-53]
  /\ fy in [-1, 1] /\ fy -/ Fy in [-1b-53, 1b-53]
  /\ fz in [-1, 1] /\ fz -/ Fz in [-1b-53, 1b-53]
  /\ sx in [-1, 1] /\ sx -/ Sx in [-1b-53, 1b-53]
  /\ sy in [-1, 1] /\ sy -/ Sy in [-1b-53, 1b-53]
  /\ sz in [-1, 1] /\ sz -/ Sz in [-1b-53, 1b-53]
  -> |t - T| - kTFactor * (1 - 16b-53) <= 0 }
nx ~ Nx;
ny ~ Ny;
nz ~ Nz;
t ~ T;
