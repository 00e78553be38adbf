# SPDX-License-Identifier: Apache-2.0
"""What a filter is given, and what it cannot do to the answers."""

import numpy as np
import pytest
from meshes import SQUARE, sheets

import pierce

SCENE = pierce.Scene(*SQUARE)
THROUGH = np.tile([0.5, 0.5, 1, 0, 0, -1.0], (3, 1))  # through the diagonal: two hits each


def every(ray, hits):
    return np.ones(len(ray), bool)


@pytest.mark.parametrize("distinct", [False, True])
@pytest.mark.parametrize("most", [0, 1, 2, 3, None])
def test_max_hits_beside_a_filter(distinct, most):
    tower = pierce.Scene(*sheets(3))
    rays = THROUGH + [0, 0, 5, 0, 0, 0]
    plain = tower.all_hits(rays, max_hits=most, distinct=distinct)
    found = tower.all_hits(rays, max_hits=most, distinct=distinct, filter=every)
    assert np.array_equal(found.offsets, plain.offsets)
    assert np.array_equal(found.t, plain.t) and np.array_equal(found.triangle, plain.triangle)
    rays[1, 0] = np.nan
    with pytest.raises(pierce.InvalidRay):
        tower.all_hits(rays, max_hits=most, distinct=distinct, filter=every)


@pytest.mark.parametrize("distinct", [False, True])
@pytest.mark.parametrize("query", ["closest_hit", "all_hits"])
def test_filters_cannot_change_what_they_are_given(query, distinct):
    ask = getattr(SCENE, query)
    plain = ask(THROUGH, distinct=distinct)
    tried = []

    def writes(ray, hits):
        for column in (ray, hits.t, hits.u, hits.triangle, hits.geometry, hits.facing):
            with pytest.raises(ValueError, match="read-only"):
                column[...] = 0
        if isinstance(hits, pierce.HitLists):
            for column in (hits.ray, hits.offsets):
                with pytest.raises(ValueError, match="read-only"):
                    column[...] = 0
        hits.t, hits.points[...] = np.zeros(len(ray)), 7  # of no consequence
        tried.append(len(ray))
        return every(ray, hits)

    found = ask(THROUGH, filter=writes, distinct=distinct)
    assert tried
    for name in ("t", "u", "v", "w", "triangle", "geometry", "facing", "points"):
        assert np.array_equal(getattr(found, name), getattr(plain, name)), name
    found.t[...] = 0  # the answer is the caller's
