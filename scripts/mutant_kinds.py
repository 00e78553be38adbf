# SPDX-License-Identifier: Apache-2.0
"""What mutants.py is written in: tests that should see, and two kinds of changes."""

import re

CULL = ["property_never_culls_a_hit_test"]
AXIS = ["property_axis_cull_test", "unit_axis_passage_test"]
BOX = ["property_box_test_test"]
DOUBLE = ["unit_certify_bounds_test", "differential_one_triangle_test"]
ROUND = ["unit_round_bounds_test", "differential_one_triangle_test"]
FLAT = ["property_flat_parts_test"]
PLACED = ["property_instances_test"]
POLES = ["differential_poles_test"]
ALONG = ["differential_along_axis_test"]
NEAREST = ["property_nearest_bounds_test", "differential_nearest_test"]
SPACE = ["unit_filter_space_test"] + BOX + CULL
FILTERS = ["unit_query_options_test", "differential_filters_test"]
AFFINE = ["differential_affine_test", "property_instances_test"]
EXACT = ["unit_exact_fixed_int_test", "unit_exact_round_ratio_test",
         "differential_one_triangle_test"]

PASSAGE = ["property_crossings_definition_test", "differential_crossings_test"]
WALLS = ["differential_walls_test"]
STRAIGHT = ["differential_scene_test", "property_batches_test"]
BATCHES = ["property_batches_test", "property_far_test"]
POINTS = ["differential_nearest_test", "property_nearest_points_test"]
NEXT = ["unit_hit_point_test"]
BOUNDED = ["unit_bounded_test"]
CORNER = ["unit_corner_test"]
AXES = ["unit_axis_signs_test"]
DECIDE = ["unit_decide_pair_test"]

BOUNDS = "src/predicate/bounds.h"
PAIR = "src/kernels/rays/decide_pair-inl.h"
DOUBLE_LANES = "src/kernels/rays/double_cull-inl.h"
DOUBLE_ONE = "src/kernels/rays/double_cull_one-inl.h"
TRACKED = "src/kernels/rounding/tracked-inl.h"


def constant(name, tests, change="*0.25", what="a quarter"):
    """A constant of bounds.h, changed while the programs run: `*factor` or `=value`."""
    return (name, what, BOUNDS, rf"constexpr (?:float|double) {name} =", change, tests)


def text(name, what, path, old, new, tests):
    """A piece of text, replaced."""
    return (name, what, path, re.escape(old), new, tests)
