# SPDX-License-Identifier: Apache-2.0
#
# A lane that passes the test of certainty is a hit (docs/algorithm.md, "The leaf cull", step 6), at
# reach 1.
# The names are those of cull_hit.g; here nothing is known of R at first.
u = 1b-24;
e = (kEdgeLinear + kEdgeSquare * E) * (1 - 8 * u);

# a. |R| <= M with M k <= 4 E (k + (48 + 24 M) u) + (57 u E) M, k = kSumFactor e; so M <= 8 E.
k = kSumFactor * e;
step_a = 4 * (k + 48.1 * u) - 8 * (k - 57 * u * E - 97 * u * E);

# b. With |R| <= 8 E: the U, V and W of the rounded inputs are positive.
m = 8 * E;
rx = m * qx; ry = m * qy; rz = m * qz;
fx = (rx + 8 * u * hx) * (1 + ax);
fy = (ry + 8 * u * hy) * (1 + ay);
fz = (rz + 8 * u * hz) * (1 + az);
uf = add_rel<24>(mul_rel<24>(fx, e2x), add_rel<24>(mul_rel<24>(fy, e2y), mul_rel<24>(fz, e2z)));
ur = rx * e2x + (ry * e2y + rz * e2z);
vf = add_rel<24>(mul_rel<24>(fx, e1x), add_rel<24>(mul_rel<24>(fy, e1y), mul_rel<24>(fz, e1z)));
vr = rx * e1x + (ry * e1y + rz * e1z);
nx = sub_rel<24>(mul_rel<24>(e1y, e2z), mul_rel<24>(e1z, e2y));
ny = sub_rel<24>(mul_rel<24>(e1z, e2x), mul_rel<24>(e1x, e2z));
nz = sub_rel<24>(mul_rel<24>(e1x, e2y), mul_rel<24>(e1y, e2x));
nxr = e1y * e2z - e1z * e2y;
nyr = e1z * e2x - e1x * e2z;
nzr = e1x * e2y - e1y * e2x;
denf = add_rel<24>(mul_rel<24>(nx, dx), add_rel<24>(mul_rel<24>(ny, dy), mul_rel<24>(nz, dz)));
denr = nxr * dx + (nyr * dy + nzr * dz);

# W = den - U - V, positive numbers and none above 12.1 E: two roundings.
w_err = (denf - denr) * E - (uf - ur) - (vf - vr) + 24.4 * u * E * k8;

{ E in [0, 2] /\ |qx| <= 1 /\ |qy| <= 1 /\ |qz| <= 1 /\ |hx| <= 1 /\ |hy| <= 1 /\ |hz| <= 1
  /\ |ax| <= 1b-24 /\ |ay| <= 1b-24 /\ |az| <= 1b-24
  /\ |e1x| <= 1 /\ |e1y| <= 1 /\ |e1z| <= 1 /\ |e2x| <= 1 /\ |e2y| <= 1 /\ |e2z| <= 1
  /\ |dx| <= 2 /\ |dy| <= 2 /\ |dz| <= 2 /\ |k8| <= 1
  -> step_a <= 0 /\ |denf - denr| <= 57b-24 /\ uf - ur - e <= 0
     /\ w_err - kSumFactor * e <= 0 }

fx - rx -> 8 * u * hx + (rx + 8 * u * hx) * ax;
fy - ry -> 8 * u * hy + (ry + 8 * u * hy) * ay;
fz - rz -> 8 * u * hz + (rz + 8 * u * hz) * az;
uf ~ ur;
vf ~ vr;
denf ~ denr;
$ E in 16;
