# SPDX-License-Identifier: Apache-2.0
#
# The traversal to the nearest triangle in double (docs/algorithm.md, "Nearest points"): the counts
# of nearest.g with 2^-53 for 2^-24 and 1 for the reach, but for the corners' copies, which are
# floats, within the leaf's reach.
v = 1b-53;
v1 = 0x1.0001p-53;
root3 = 1.7320509;
@f32 = float<ieee_32, ne>;
copy = f32(corner);

# The bound is evaluated with at most 3 roundings.
copies = root3 * (1b-25 + 1b-53) - kNearestPlainCopy * (1 - 3 * v);
low = root3 * (2 * v1 + 3.002 * v + 4.51 * v1) - kNearestPlainReach * (1 - 3 * v);
high = root3 * (9 * v1 + 3.51 * v1) - kNearestPlainReach * (1 - 3 * v);

{ |corner| <= 1 -> |copy - corner| <= 1b-25 /\ copies <= 0 /\ low <= 0 /\ high <= 0 }
