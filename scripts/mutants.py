# SPDX-License-Identifier: Apache-2.0
"""The mutants of mutation_check.py: what is weakened, or taken out, and which tests should see."""

import re

CULL = ["property_never_culls_a_hit_test"]
AXIS = ["property_axis_cull_test", "unit_axis_passage_test"]
BOX = ["property_box_test_test"]
DOUBLE = ["unit_certify_bounds_test", "differential_one_triangle_test"]
ROUND = ["unit_round_bounds_test", "differential_one_triangle_test"]
NEAREST = ["property_nearest_bounds_test", "differential_nearest_test"]
SPACE = ["unit_filter_space_test"] + BOX + CULL
FILTERS = ["unit_query_options_test", "differential_filters_test"]
AFFINE = ["differential_affine_test", "property_instances_test"]
EXACT = ["unit_exact_fixed_int_test", "unit_exact_round_ratio_test",
         "differential_one_triangle_test"]

BOUNDS = "src/predicate/bounds.h"


def constant(name, tests, change="*0.25", what="a quarter"):
    """A constant of bounds.h, changed while the programs run: `*factor` or `=value`."""
    return (name, what, BOUNDS, rf"constexpr (?:float|double) {name} =", change, tests)


def text(name, what, path, old, new, tests):
    """A piece of text, replaced."""
    return (name, what, path, re.escape(old), new, tests)


MUTANTS = [
    constant("kNearOrigin", SPACE),
    constant("kFarthestOrigin", SPACE, "*256", "256 times as far"),
    constant("kTauLimit", SPACE),
    constant("kTauPad", CULL + BOX),
    constant("kBoxPad", BOX + CULL),
    constant("kSmallestSlope", BOX + CULL, "=0x1p-8", "2^-8"),
    constant("kCutSlack", AXIS),
    constant("kPointPad", AXIS),
    constant("kEdgeLinear", CULL),
    constant("kEdgeSquare", CULL),
    constant("kEdgeFloor", CULL),
    constant("kSumFactor", CULL),
    constant("kEdgeExact", CULL),
    constant("kTauReach", CULL),
    constant("kTauInput", CULL),
    constant("kTauCube", CULL),
    constant("kTauSquare", CULL),
    constant("kAxisSquare", AXIS),
    constant("kAxisInput", AXIS),
    constant("kAxisMore", AXIS),
    constant("kAxisFloor", AXIS, "=0", "none"),
    constant("kNearestLow", NEAREST),
    constant("kNearestHigh", NEAREST),
    constant("kNearestRoom", NEAREST, "=1", "none"),
    constant("kNearestShortest", NEAREST, "=0", "none"),
    constant("kNearestFloat", NEAREST, "=0x1p60", "2^60"),
    constant("kNearestPlainCopy", NEAREST),
    constant("kNearestPlainReach", NEAREST),
    # Larger is slower, not wrong: distances then say nothing and the referee decides. Smaller
    # leaves out more than kNearestFar covers.
    constant("kNearestFarthest", NEAREST, "=0x1p10", "2^10"),
    constant("kNearestFar", NEAREST),
    constant("kSideFloor", ["unit_axis_passage_test"], "=0", "none"),
    constant("kSideFactor", ["unit_axis_passage_test"]),
    constant("kDenFactor", DOUBLE),
    constant("kUvFactor", DOUBLE),
    constant("kTFactor", DOUBLE),
    constant("kSmallestMagnitude", DOUBLE, "=0x1p-600", "2^-600"),
    constant("kLargestMagnitude", DOUBLE, "=0x1p600", "2^600"),
    constant("kDoubleDoubleFactor", ROUND),
    text("the far road", "double places every origin", "src/bvh/filter_space.cpp",
         "if (!(distance <= bounds::kFarthestOrigin) || !move_origin(ray, placed)) {",
         "if (!move_origin(ray, placed)) {", SPACE),
    text("the overflowing shift", "not looked for", "src/bvh/filter_space.cpp",
         "if (!std::isfinite(placed.origin.x + placed.origin.y + placed.origin.z)) return false;",
         "", SPACE),
    text("exact rays", "every ray counts as exact", "src/kernels/filter_ray.h",
         "copies_exact && placed.origin_kept && is_float(placed.origin) && "
         "is_float(placed.direction);", "true;", CULL),
    text("exact points", "every point counts as exact", "src/scene/axis_points.cpp",
         "packet.exact &= static_cast<double>(nearest) == p.at[axis];", "", AXIS),
    text("den near zero, in float", "tau is believed", "src/kernels/cull-inl.h",
         "safe_ = hn::Gt(den_, hn::Set(d, bounds_.sum_e));",
         "safe_ = hn::Ge(den_, hn::Set(d, 0.0F));", CULL),
    text("certainty, in float", "inside without a margin", "src/kernels/cull-inl.h",
         "const V e = hn::Set(d, bounds_.e);", "const V e = hn::Set(d, 0.0F);", CULL),
    text("the order of near hits, in float", "not asked of the referee", "src/kernels/leaf-inl.h",
         "if (place.high >= tau.low && !referee().is_before(candidate, triangle)) return;",
         "if (place.high >= tau.high) return;", CULL),
    text("the order of near hits, in a packet", "the lower one is taken",
         "src/kernels/packet_hits-inl.h", "hn::Lt(cull.high(), hn::Load(d, hits.low + i))",
         "hn::Lt(cull.low(), hn::Load(d, hits.low + i))", CULL),
    text("rays of a parted packet", "one of sixteen is left behind",
         "src/kernels/packet_walk-inl.h",
         "rays[g] = rays_entering(box, planes, g, p) & p.rays[g];",
         "rays[g] = rays_entering(box, planes, g, p) & p.rays[g] & 0x7fffU;",
         ["property_batches_test"]),
    text("a border between floats, in a packet", "not looked for",
         "src/kernels/packet_finish-inl.h", "rays &= numbers.sure | ~found;", "",
         ["property_packet_hits_test"]),
    text("names of geometries, in a packet", "not set", "src/scene/block_query.h",
         "if (geometries_.meshes().size() == 1) continue;", "continue;",
         ["property_packet_hits_test"]),
    text("the last group of a batch", "written as sixteen", "src/kernels/packet_finish-inl.h",
         "if (count == kGroupSize) {", "if (true) {", ["property_packet_hits_test"]),
    text("rounding from copies", "uncertain hits, too", "src/scene/ray_query.h",
         """if (asked_) return false;
    if constexpr (std::is_same_v<Real, float>) {
      if (geometries_.copies_usable() && filter_ray_.exact && !road_) {""",
         """if constexpr (std::is_same_v<Real, float>) {
      if (geometries_.copies_usable() && filter_ray_.exact) {""", ["differential_scene_test"]),
    text("a border between floats, in lanes", "not looked for", "src/kernels/round-inl.h",
         "hn::And(hn::Eq(low, high), hn::Ne(low, hn::Zero(df)))", "hn::Ne(low, hn::Zero(df))",
         ROUND),
    text("a border between doubles, in lanes", "not looked for", "src/kernels/round-inl.h",
         "return bits_of(d, hn::Eq(low, high));", "return bits_of(d, hn::Eq(low, low));",
         ROUND),
    text("den near zero, in double", "its sign is believed", "src/predicate/certify.cpp",
         "if (den <= f.den_err) return Certified::Unsure;", "", DOUBLE),
    text("the window of magnitudes", "not looked at", "src/predicate/certify.cpp",
         "if (!f.usable) return Certified::Unsure;", "", DOUBLE),
    text("unsure of the triangle", "taken for a miss", "src/predicate/certify.cpp",
         ": Certified::Unsure;", ": Certified::No;", DOUBLE),
    text("unsure of the range", "taken for no", "src/predicate/certify.cpp",
         "return Certified::Unsure;  // also", "return Certified::No;  // also", DOUBLE),
    text("unsure of the order", "taken for a tie", "src/predicate/decide.cpp",
         "return settle_order(ray, first.triangle, second.triangle);",
         "return std::strong_ordering::equal;", DOUBLE),
    text("an edge that two hits share", "one end of it is enough", "src/predicate/decide.cpp",
         "(*p[0] == *q[0] && *p[1] == *q[1])", "(*p[0] == *q[0] || *p[1] == *q[1])",
         ["differential_scene_test"]),
    text("den near zero, in an interval of t", "its bound is believed", "src/predicate/certify.cpp",
         "den <= 2 * f.den_err", "den == 0", DOUBLE),
    text("the end of a range", "den's error is left out", "src/predicate/certify.cpp",
         "std::fabs(bound) * f.den_err * (1 + 4 * kUlp)", "0", DOUBLE),
    text("a side of a shadow", "unsure ones are believed", "src/predicate/axis_passage.cpp",
         "if (!sides.apart() && sides.unsure())", "if (!sides.apart() && sides.ab > kUnsure)",
         ["unit_axis_passage_test"]),
    text("a rounded difference", "counts as exact", "src/predicate/axis_passage.cpp",
         "exact = d.low == 0;", "exact = d.low == d.low;", ["unit_axis_passage_test"]),
    text("products of differences that underflow", "count as exact",
         "src/predicate/axis_passage.cpp",
         "return (magnitude >= bounds::kSmallestMagnitude &&",
         "return (magnitude >= 0 &&", ["unit_axis_passage_test"]),
    text("the side of a plane", "unsure ones are believed", "src/predicate/axis_passage.cpp",
         "std::fabs(filtered.value.t) > filtered.t_err", "filtered.value.t != 0",
         ["unit_axis_passage_test"]),
    text("a border between floats", "not looked for", "src/predicate/round.cpp",
         "return low == high && low != 0;", "return low != 0;", ROUND),
    text("a float that rounds to zero", "not looked for", "src/predicate/round.cpp",
         "return low == high && low != 0;", "return low == high;", ROUND),
    text("a border between doubles", "not looked for", "src/predicate/round.cpp",
         "return low == high;", "return true;", ROUND),
    text("integers of any size", "two limbs have to do", "src/predicate/exact_pair.h",
         "return bits <= exact::kCoordinateBits<2> ? Width::Two : Width::Any;",
         "return Width::Two;", EXACT),
    text("room for carries", "none", "src/exact/scaled_integers.h",
         "static_cast<int>(64 * N) - 4;", "static_cast<int>(64 * N) - 1;", EXACT),
    text("the remainder of a ratio", "not looked at", "src/exact/round_ratio.cpp",
         "return {quotient, !rest.is_zero()};", "return {quotient, false};", EXACT),
    text("certainty under a filter", "what float is certain of counts", "src/kernels/filter_ray.h",
         "ray.tau_first = std::numeric_limits<float>::infinity();", "static_cast<void>(ray);",
         FILTERS),
    text("a border between floats, of a placed vertex", "not looked for", "src/exact/affine.cpp",
         "const double off = 0x1p-51 * std::fabs(sum.high) + 2 * sum.rest;",
         "const double off = 2 * sum.rest;", AFFINE),
    text("a border between doubles, of a placed vertex", "not looked for", "src/exact/affine.cpp",
         "if (sum.rest == 0) return true;", "if (sum.rest >= 0) return true;", AFFINE),
    text("products that underflow, of a placed vertex", "counted as exact", "src/exact/affine.cpp",
         "constexpr double kLeast = 0x1p-960;", "constexpr double kLeast = 0x1p-1074;", AFFINE),
    text("-0 of a placed vertex", "left as it is", "src/exact/affine.cpp",
         "return result + Real(0);", "return result;", AFFINE),
    text("pairs of doubles through float", "the compiler is let loose", "cmake/pierce_flags.cmake",
         "-fno-tree-slp-vectorize>", "-ftree-slp-vectorize>", ["unit_compiler_test"]),
]
