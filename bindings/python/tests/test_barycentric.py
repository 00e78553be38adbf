# SPDX-License-Identifier: Apache-2.0
"""pierce.barycentric: the definition, exactly; and what follows from signs and zeros."""

from fractions import Fraction

import numpy as np
import pytest

from pierce import barycentric

SIMPLICES = [(2, 1), (2, 2), (2, 3), (3, 2), (3, 3), (3, 5), (4, 3), (4, 4), (5, 4), (6, 5)]


def sample(count, corners, dimensions, seed=0):
    random = np.random.default_rng(seed)
    return (random.integers(-9, 10, (count, dimensions)).astype(float),
            random.integers(-9, 10, (count, corners, dimensions)).astype(float))


@pytest.mark.parametrize("corners, dimensions", SIMPLICES)
def test_exact_coordinates_are_the_definition(corners, dimensions):
    points, simplices = sample(40, corners, dimensions)
    got = barycentric.coordinates(points, simplices, exact=True)
    assert got.shape == (40, corners)
    checked = 0
    for p, c, weights in zip(points.tolist(), simplices.tolist(), got.tolist()):
        edges = np.array([np.subtract(x, c[0]) for x in c[1:]])
        if np.linalg.matrix_rank(edges) < corners - 1:
            assert all(w != w for w in weights[1:])
            continue
        checked += 1
        assert all(isinstance(w, Fraction) for w in weights) and sum(weights) == 1
        there = [sum(w * Fraction(x[k]) for w, x in zip(weights, c)) for k in range(dimensions)]
        rest = [Fraction(x) - y for x, y in zip(p, there)]
        if corners == dimensions + 1:
            assert not any(rest)
        for corner in c[1:]:  # what is left is at right angles to the simplex
            assert sum(x * (Fraction(y) - Fraction(z)) for x, y, z in zip(rest, corner, c[0])) == 0
    assert checked > 10


@pytest.mark.parametrize("corners, dimensions", SIMPLICES)
@pytest.mark.parametrize("dtype", [np.float32, np.float64])
def test_floats_are_close_to_the_exact_ones(corners, dimensions, dtype):
    points, simplices = sample(200, corners, dimensions, seed=3)
    exact = barycentric.coordinates(points, simplices, exact=True)
    got = barycentric.coordinates(points.astype(dtype), simplices.astype(dtype))
    assert got.dtype == dtype
    regular = np.array([all(isinstance(w, Fraction) for w in row) for row in exact])
    reference = exact[regular].astype(float)
    tame = np.abs(reference).max(axis=1) < 20
    assert tame.sum() > 50
    error = np.abs(got[regular][tame] - reference[tame]).max()
    assert error < (1e-2 if dtype == np.float32 else 1e-10)


def test_regions_of_a_triangle():
    triangle = [[0, 0], [2, 0], [0, 2]]
    points = [[0.5, 0.5], [1, 1], [0, 0], [2, 2], [-1, -1], [3, -0.5], [0, 1]]
    weights = barycentric.coordinates(points, triangle)
    assert barycentric.inside_open(weights).tolist() == [True] + [False] * 6
    assert barycentric.inside_closed(weights).tolist() == [True, True, True, False, False, False,
                                                           True]
    assert barycentric.beyond(weights)[3:6].tolist() == [[True, False, False], [False, True, True],
                                                         [True, False, True]]
    assert barycentric.carrier(weights).sum(axis=1).tolist() == [3, 2, 1, 0, 0, 0, 2]
    patterns = {tuple(row) for row in barycentric.beyond(barycentric.coordinates(
        np.random.default_rng(0).uniform(-9, 9, (500, 2)), triangle)).tolist()}
    assert len(patterns) == 7 and (True, True, True) not in patterns


def test_interpolate_gives_positions_back():
    points, simplices = sample(30, 4, 3, seed=8)
    weights = barycentric.coordinates(points, simplices, exact=True)
    regular = np.array([all(isinstance(w, Fraction) for w in row) for row in weights])
    back = barycentric.interpolate(weights[regular], simplices[regular])
    assert np.allclose(back.astype(float), points[regular])
    assert barycentric.interpolate(weights[regular], [1, 1, 1, 1]).tolist() == [1] * regular.sum()
    one = barycentric.coordinates([0.5, 0.25], [[0, 0], [1, 0], [0, 1]])
    assert barycentric.interpolate(one, [[1, 0], [0, 1], [0, 0]]).tolist() == [0.25, 0.5]
    with pytest.raises(ValueError, match="values"):
        barycentric.interpolate(one, [1, 2])


def test_a_flat_simplex_has_no_coordinates():
    flat = [[0, 0, 0], [1, 1, 1], [2, 2, 2]]
    assert not np.isfinite(barycentric.coordinates([1, 0, 0], flat)).any()
    assert not barycentric.inside_closed(barycentric.coordinates([1, 0, 0], flat, exact=True))


def test_what_is_refused():
    with pytest.raises(ValueError, match="5 corners in 3 dimensions"):
        barycentric.coordinates(np.zeros(3), np.zeros((5, 3)))
    with pytest.raises(ValueError, match="shapes"):
        barycentric.coordinates(np.zeros(2), np.zeros((3, 3)))
    with pytest.raises(TypeError, match="float32"):
        barycentric.coordinates(np.zeros(3, np.float32), np.zeros((3, 3)))
