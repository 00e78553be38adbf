# SPDX-License-Identifier: Apache-2.0
#
# The same as cull_hit.g for exact rays: only the differences and what follows are rounded, so that
# s is off by 2 u, an edge by u E, the direction not at all.
u = 1b-24;
e = (kEdgeExact + kEdgeSquare * E) * (1 - 8 * u);

# R: |R| <= 4 E + 8 u for a triangle that is hit.
m = 4 * E + 8 * u;
rx = m * qx; ry = m * qy; rz = m * qz;
fx = (rx + 8 * u * hx) * (1 + ax);
fy = (ry + 8 * u * hy) * (1 + ay);
fz = (rz + 8 * u * hz) * (1 + az);

# U and V: in float, of the rounded inputs exactly, true.
uf = add_rel<24>(mul_rel<24>(fx, e2x), add_rel<24>(mul_rel<24>(fy, e2y), mul_rel<24>(fz, e2z)));
ur = rx * e2x + (ry * e2y + rz * e2z);
vf = add_rel<24>(mul_rel<24>(fx, e1x), add_rel<24>(mul_rel<24>(fy, e1y), mul_rel<24>(fz, e1z)));
vr = rx * e1x + (ry * e1y + rz * e1z);
uu = ur + (16 * u * k2 + (8 * u * E + 16 * u * u) * k3);
vv = vr + (16 * u * k5 + (8 * u * E + 16 * u * u) * k6);

# den, once more divided by E, and its whole error divided by E.
nx = sub_rel<24>(mul_rel<24>(e1y, e2z), mul_rel<24>(e1z, e2y));
ny = sub_rel<24>(mul_rel<24>(e1z, e2x), mul_rel<24>(e1x, e2z));
nz = sub_rel<24>(mul_rel<24>(e1x, e2y), mul_rel<24>(e1y, e2x));
nxr = e1y * e2z - e1z * e2y;
nyr = e1z * e2x - e1x * e2z;
nzr = e1x * e2y - e1y * e2x;
denf = add_rel<24>(mul_rel<24>(nx, dx), add_rel<24>(mul_rel<24>(ny, dy), mul_rel<24>(nz, dz)));
denr = nxr * dx + (nyr * dy + nzr * dz);
den_err = (denf - denr) * E + 16 * u * E * k7;

# W.
wf = sub_rel<24>(sub_rel<24>(denf * E, uf), vf);
wr = (denf * E - uf) - vf;
w_err = (wf - wr) + (den_err - (uf - uu) - (vf - vv));

{ E in [0, 2] /\ |qx| <= 1 /\ |qy| <= 1 /\ |qz| <= 1 /\ |hx| <= 1 /\ |hy| <= 1 /\ |hz| <= 1
  /\ |ax| <= 1b-24 /\ |ay| <= 1b-24 /\ |az| <= 1b-24
  /\ |e1x| <= 1 /\ |e1y| <= 1 /\ |e1z| <= 1 /\ |e2x| <= 1 /\ |e2y| <= 1 /\ |e2z| <= 1
  /\ |dx| <= 2 /\ |dy| <= 2 /\ |dz| <= 2
  /\ |k2| <= 1 /\ |k3| <= 1 /\ |k5| <= 1 /\ |k6| <= 1 /\ |k7| <= 1
  -> (uf - uu) + den_err - e <= 0 /\ w_err - kSumFactor * e <= 0 }

fx - rx -> 8 * u * hx + (rx + 8 * u * hx) * ax;
fy - ry -> 8 * u * hy + (ry + 8 * u * hy) * ay;
fz - rz -> 8 * u * hz + (rz + 8 * u * hz) * az;
uf ~ ur;
vf ~ vr;
denf ~ denr;
uf - uu -> (uf - ur) - (16 * u * k2 + (8 * u * E + 16 * u * u) * k3);
vf - vv -> (vf - vr) - (16 * u * k5 + (8 * u * E + 16 * u * u) * k6);
$ E in 16;
