# SPDX-License-Identifier: Apache-2.0
#
# How far corners reach towards a point far away (docs/algorithm.md, "Nearest points"): the copies,
# the direction, what is left out, and the rounding of the scalar product and of the bound itself.
@f32 = float<ieee_32, ne>;
@f64 = float<ieee_64, ne>;
copy = f32(corner);

reach_f = f64(f64(f64(x * p) + f64(y * q)) + f64(z * r));
reach_r = x * p + y * q + z * r;

# Three components, each of a direction and of a corner of at most 1.
copies = 3 * (1b-25 + 1b-53);
direction = 3 * 1b-40;
left_out = 3 / (2 * kNearestFarthest);
far = copies + direction + left_out + 1b-49 - kNearestFar;

{ |corner| <= 1 /\ |x| <= 1 /\ |y| <= 1 /\ |z| <= 1 /\ |p| <= 1 /\ |q| <= 1 /\ |r| <= 1
  -> |copy - corner| <= 1b-25 /\ |reach_f - reach_r| <= 1b-50 /\ far <= 0 }
