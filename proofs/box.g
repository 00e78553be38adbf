# SPDX-License-Identifier: Apache-2.0
#
# The box test, one axis (docs/algorithm.md, "The box test"): in float arithmetic, fused or not,
# the computed entry is never after the true one, for planes and origins of any magnitude. (An exit
# is the entry of the mirror image.)
#
# D is the true slope, d = D (1 + dd) its float, o that of the origin O, P the true point, and
# P' = P + `rest` stands for a plane that was rounded inward. Every operation has its own
# relative error; D times the computed entry, less P - O, is then (proofs/check_lemmas.py) a part
# that P' is a factor of, one that o is, and the floor's. Each is at most 0, for either sign of P'
# and of o; of the first two, here is what |P'| and |o| are the factors of.
# 1 / d, the last sum.
k = (1 + e1) * (1 + e2) / (1 + dd);
# The pad: a product, a sum, the product with the inverse; the difference with it.
padding = (1 + p1) * (1 + p2) * (1 + p3);
pad = kBoxOrigin * padding;

# One ray: the products of plane and origin with the inverse, the origin's sum with the pad.
near_forward = k * (1 + e3) * (1 - kBoxPlane) - 1;
near_backward = 1 - k * (1 + e3) * (1 + kBoxPlane);
origin_forward = 1 + do - k * (1 + e5) * (1 + e4 + pad);
origin_backward = k * (1 + e5) * (1 + e4 - pad) - (1 + do);

# A packet: the difference first, then one product.
both = k * (1 + e6) * (1 + e7);
packet_near_forward = both * (1 - kBoxPlane) - 1;
packet_near_backward = 1 - both * (1 + kBoxPlane);
packet_origin_forward = 1 + do - both - k * pad;
packet_origin_backward = both - k * pad - (1 + do);

# A packet and the box of float copies: a corner's copy; the product, the difference of the plane.
copy = (1 + c1) * (1 + c3);
leaf_near_forward = both * copy * (1 - kBoxCopy * (1 + c2)) - 1;
leaf_near_backward = 1 - both * copy * (1 + kBoxCopy * (1 + c2));

# What is not relative: a moved origin, the pieces of cut triangles, a slope below kSmallestSlope,
# and underflow. (The float of a plane that is built in is rounded outward.) What is left of the
# floor keeps exits from 0.
rest = 1b-53 + 128 * kSmallestSlope;
floor = rest + 1b-48 + 1b-140 - k * (1 + e5) * kBoxFloor * padding;

{ |dd| <= 1b-24 /\ |do| <= 0x1.0001p-24
  /\ |e1| <= 1b-24 /\ |e2| <= 1b-24 /\ |e3| <= 1b-24 /\ |e4| <= 1b-24 /\ |e5| <= 1b-24
  /\ |e6| <= 1b-24 /\ |e7| <= 1b-24 /\ |p1| <= 1b-24 /\ |p2| <= 1b-24 /\ |p3| <= 1b-24
  /\ |c1| <= 0x1.0001p-24 /\ |c2| <= 1b-24 /\ |c3| <= 1b-24
  -> near_forward <= 0 /\ near_backward <= 0 /\ origin_forward <= 0 /\ origin_backward <= 0
     /\ packet_near_forward <= 0 /\ packet_near_backward <= 0
     /\ packet_origin_forward <= 0 /\ packet_origin_backward <= 0
     /\ leaf_near_forward <= 0 /\ leaf_near_backward <= 0 /\ floor <= -1b-47 }
