# SPDX-License-Identifier: Apache-2.0
#
# The box test, one axis (docs/algorithm.md, "The box test"): in float arithmetic, fused or not,
# the computed entry is never after the true one, and the computed exit never before it.
#
# Scaled so that the slope d is in [1, 2]: a power of two on d scales every computed number by its
# inverse, exactly. `point` is the true point of the ray on this axis, `plane` the box's plane
# that it lies behind; `out` is by how much the box may have been rounded inward, and what a slope
# below kSmallestSlope loses. o and d are floats, O and D the true ones.
@rnd = float<ieee_32, ne>;
u = 1b-24;
out = 1b-53 * out1 + 8 * kSmallestSlope * out2;
O = o + od;
D = d * (1 + dd);
tau = (point - O) / D;
inverse = rnd(1 / d);
pad = rnd(kBoxPad * inverse);
middle = rnd(-(o * inverse));
entry_offset = rnd(middle - pad);
exit_offset = rnd(middle + pad);

near = point + out;
entry = rnd(near * inverse + entry_offset);
entry_unfused = rnd(rnd(near * inverse) + entry_offset);
far = point - out;
exit = rnd(far * inverse + exit_offset);
exit_unfused = rnd(rnd(far * inverse) + exit_offset);

# Of a packet (docs/algorithm.md, "Packets"): the difference first.
packet_entry = rnd(rnd(rnd(near - o) * inverse) - pad);
packet_exit = rnd(rnd(rnd(far - o) * inverse) + pad);

# Of a packet and the box of a triangle's float copy, which is rounded to nearest.
leaf_near = near + 1b-25 * copied;
leaf_far = far - 1b-25 * copied;
leaf_entry = rnd(rnd(rnd(leaf_near - o) * inverse) - pad);
leaf_exit = rnd(rnd(rnd(leaf_far - o) * inverse) + pad);

# The same without rounding.
entry_r = near * (1 / d) + (-(o * (1 / d)) - kBoxPad * (1 / d));
exit_r = far * (1 / d) + (-(o * (1 / d)) + kBoxPad * (1 / d));
packet_entry_r = (near - o) * (1 / d) - kBoxPad * (1 / d);
packet_exit_r = (far - o) * (1 / d) + kBoxPad * (1 / d);
leaf_entry_r = (leaf_near - o) * (1 / d) - kBoxPad * (1 / d);
leaf_exit_r = (leaf_far - o) * (1 / d) + kBoxPad * (1 / d);

{ d in [1, 2] /\ o / kNearOrigin in [-1, 1] /\ point in [-1, 1] /\ point - O in [-3.0001, 3.0001]
  /\ |od| <= 0x1.0001p-24 /\ |dd| <= 0x1.0001p-24 /\ |out1| <= 1 /\ |out2| <= 1 /\ |copied| <= 1
  -> entry - tau <= 0 /\ entry_unfused - tau <= 0 /\ exit - tau >= 0 /\ exit_unfused - tau >= 0
     /\ packet_entry - tau <= 0 /\ packet_exit - tau >= 0
     /\ leaf_entry - tau <= 0 /\ leaf_exit - tau >= 0 }

o -> (o / kNearOrigin) * kNearOrigin;
entry_r - tau -> (out + od + (point - O) * (dd / (1 + dd)) - kBoxPad) / d { d <> 0, 1 + dd <> 0 };
exit_r - tau -> (-out + od + (point - O) * (dd / (1 + dd)) + kBoxPad) / d { d <> 0, 1 + dd <> 0 };
packet_entry_r - tau -> (out + od + (point - O) * (dd / (1 + dd)) - kBoxPad) / d
  { d <> 0, 1 + dd <> 0 };
packet_exit_r - tau -> (-out + od + (point - O) * (dd / (1 + dd)) + kBoxPad) / d
  { d <> 0, 1 + dd <> 0 };
leaf_entry_r - tau -> (out + 1b-25 * copied + od + (point - O) * (dd / (1 + dd)) - kBoxPad) / d
  { d <> 0, 1 + dd <> 0 };
leaf_exit_r - tau -> (-out - 1b-25 * copied + od + (point - O) * (dd / (1 + dd)) + kBoxPad) / d
  { d <> 0, 1 + dd <> 0 };
leaf_entry - tau -> (leaf_entry - leaf_entry_r) + (leaf_entry_r - tau);
leaf_exit - tau -> (leaf_exit - leaf_exit_r) + (leaf_exit_r - tau);
entry - tau -> (entry - entry_r) + (entry_r - tau);
entry_unfused - tau -> (entry_unfused - entry_r) + (entry_r - tau);
exit - tau -> (exit - exit_r) + (exit_r - tau);
exit_unfused - tau -> (exit_unfused - exit_r) + (exit_r - tau);
packet_entry - tau -> (packet_entry - packet_entry_r) + (packet_entry_r - tau);
packet_exit - tau -> (packet_exit - packet_exit_r) + (packet_exit_r - tau);
$ d in 32;
