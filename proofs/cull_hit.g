# SPDX-License-Identifier: Apache-2.0
#
# The leaf cull keeps every hit (docs/algorithm.md, "The leaf cull", steps 2 to 5): the whole
# error of U, V, W and den of a triangle that is hit stays below the bounds, at reach 1. (At any
# other all of it scales but underflow.)
#
# Edges are divided by E (|e1|, |e2| <= 1), so U, V, W are too, and den by E twice; relative
# errors do not mind. A product inside a fused operation has the error 0, which mul_rel allows. k1
# ... k7 in [-1, 1] stand for the parts that come from the inputs (step 2), a determinant each.
u = 1b-24;
s1 = 0x1.0001p-24;
e = (kEdgeLinear + kEdgeSquare * E) * (1 - 8 * u);

# R: |R| <= 4 (E + 6.51 u) for a triangle that is hit.
m = 4 * E + 26.04 * u;
rx = m * qx; ry = m * qy; rz = m * qz;
fx = (rx + 8 * u * hx) * (1 + ax);
fy = (ry + 8 * u * hy) * (1 + ay);
fz = (rz + 8 * u * hz) * (1 + az);

# U and V: in float, of the rounded inputs exactly, true.
uf = add_rel<24>(mul_rel<24>(fx, e2x), add_rel<24>(mul_rel<24>(fy, e2y), mul_rel<24>(fz, e2z)));
ur = rx * e2x + (ry * e2y + rz * e2z);
vf = add_rel<24>(mul_rel<24>(fx, e1x), add_rel<24>(mul_rel<24>(fy, e1y), mul_rel<24>(fz, e1z)));
vr = rx * e1x + (ry * e1y + rz * e1z);
uu = ur + (12 * s1 * k1 + 28 * s1 * k2 + (8 * s1 + 8 * u * E) * k3);
vv = vr + (12 * s1 * k4 + 28 * s1 * k5 + (8 * s1 + 8 * u * E) * k6);

# den, once more divided by E, and its whole error divided by E.
nx = sub_rel<24>(mul_rel<24>(e1y, e2z), mul_rel<24>(e1z, e2y));
ny = sub_rel<24>(mul_rel<24>(e1z, e2x), mul_rel<24>(e1x, e2z));
nz = sub_rel<24>(mul_rel<24>(e1x, e2y), mul_rel<24>(e1y, e2x));
nxr = e1y * e2z - e1z * e2y;
nyr = e1z * e2x - e1x * e2z;
nzr = e1x * e2y - e1y * e2x;
denf = add_rel<24>(mul_rel<24>(nx, dx), add_rel<24>(mul_rel<24>(ny, dy), mul_rel<24>(nz, dz)));
denr = nxr * dx + (nyr * dy + nzr * dz);
den_err = (denf - denr) * E + (16 * s1 + 20 * u * E) * k7;

# W.
wf = sub_rel<24>(sub_rel<24>(denf * E, uf), vf);
wr = (denf * E - uf) - vf;
w_err = (wf - wr) + (den_err - (uf - uu) - (vf - vv));

# What does not shrink with E: products of two errors (of U; of U and V), edges that are longer than
# E by 2^-51, and underflow: 15 products' worth each of den and U, 4 more of e, 2^-150 each.
underflow = 34 * 1b-150 / (kSmallestReach * kSmallestReach);
rest_u = 52.08 * u * (s1 + 2 * u) + 1b-64 + underflow;
rest_w = 2 * rest_u;

{ E in [0, 2] /\ |qx| <= 1 /\ |qy| <= 1 /\ |qz| <= 1 /\ |hx| <= 1 /\ |hy| <= 1 /\ |hz| <= 1
  /\ |ax| <= 1b-24 /\ |ay| <= 1b-24 /\ |az| <= 1b-24
  /\ |e1x| <= 1 /\ |e1y| <= 1 /\ |e1z| <= 1 /\ |e2x| <= 1 /\ |e2y| <= 1 /\ |e2z| <= 1
  /\ |dx| <= 2 /\ |dy| <= 2 /\ |dz| <= 2
  /\ |k1| <= 1 /\ |k2| <= 1 /\ |k3| <= 1 /\ |k4| <= 1 /\ |k5| <= 1 /\ |k6| <= 1 /\ |k7| <= 1
  -> (uf - uu) + den_err - e <= 0 /\ w_err - kSumFactor * e <= 0
     /\ rest_u - kEdgeFloor * (1 - 8 * u) <= 0
     /\ rest_w - kSumFactor * kEdgeFloor * (1 - 8 * u) <= 0 }

fx - rx -> 8 * u * hx + (rx + 8 * u * hx) * ax;
fy - ry -> 8 * u * hy + (ry + 8 * u * hy) * ay;
fz - rz -> 8 * u * hz + (rz + 8 * u * hz) * az;
uf ~ ur;
vf ~ vr;
denf ~ denr;
uf - uu -> (uf - ur) - (12 * s1 * k1 + 28 * s1 * k2 + (8 * s1 + 8 * u * E) * k3);
vf - vv -> (vf - vr) - (12 * s1 * k4 + 28 * s1 * k5 + (8 * s1 + 8 * u * E) * k6);
$ E in 16;
