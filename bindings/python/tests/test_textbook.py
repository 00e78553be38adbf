# SPDX-License-Identifier: Apache-2.0
"""pierce.textbook: bit for bit the library's templates, and over fractions the exact answer."""

from fractions import Fraction

import numpy as np
import pytest

import pierce
from pierce import textbook

FUNCTIONS = {
    "cramer": textbook.cramer,
    "determinants": textbook.determinants,
    "plane_then_edges": textbook.plane_then_edges,
    "plane_then_barycentric": textbook.plane_then_barycentric,
    "moller_trumbore": textbook.moller_trumbore,
    "moller_trumbore, epsilon 0":
        lambda r, t, **how: textbook.moller_trumbore(r, t, epsilon=0, **how),
    "moller_trumbore_culling": textbook.moller_trumbore_culling,
    "moller_trumbore_culling, epsilon 0":
        lambda r, t, **how: textbook.moller_trumbore_culling(r, t, epsilon=0, **how),
    "precomputed_normal": textbook.precomputed_normal,
    "watertight": textbook.watertight,
    "baldwin_weber": textbook.baldwin_weber,
}
EXACT = [name for name in FUNCTIONS if not name.endswith(("trumbore", "culling"))]


def pairs(kind, count, dtype, seed=0):
    """Rays and triangles: random, through edges and corners, on a small grid, tiny and huge."""
    random = np.random.default_rng(seed)
    if kind == "grid":  # most are degenerate in some way
        triangles = random.integers(-1, 2, (count, 3, 3))
        table = random.integers(-2, 3, (count, 6))
        table[(table[:, 3:] == 0).all(axis=1), 5] = 1
        return table.astype(dtype), triangles.astype(dtype)
    triangles = random.standard_normal((count, 3, 3)).astype(dtype)
    if kind == "scales":
        triangles *= (10.0 ** random.integers(-6, 7, (count, 1, 1))).astype(dtype)
    weights = random.dirichlet([1, 1, 1], count)
    if kind == "edges":
        weights[np.arange(count), random.integers(0, 3, count)] = 0
        weights /= weights.sum(axis=1, keepdims=True)
    if kind == "corners":
        weights = np.eye(3)[random.integers(0, 3, count)]
    if kind == "misses":
        weights = random.standard_normal((count, 3))
    aim = np.einsum("nk,nkx->nx", weights, triangles.astype(np.float64))
    origins = (random.standard_normal((count, 3)) * 3).astype(dtype)
    directions = (aim - origins).astype(dtype)
    table = np.concatenate([origins, directions], axis=1)
    if kind == "range":
        ends = np.sort(random.standard_normal((count, 2)) + 1, axis=1)
        ends[::3, 1] = np.inf
        ends[1::5, 0] = -np.inf
        table = np.concatenate([table, ends], axis=1)
    return np.ascontiguousarray(table.astype(dtype)), triangles


KINDS = ["random", "edges", "corners", "misses", "grid", "scales", "range"]


def test_every_method_is_here():
    assert tuple(FUNCTIONS) == textbook.METHODS


@pytest.mark.parametrize("name", FUNCTIONS)
@pytest.mark.parametrize("dtype", [np.float32, np.float64])
@pytest.mark.parametrize("kind", KINDS)
def test_the_numbers_are_the_templates(name, dtype, kind):
    rays, triangles = pairs(kind, 2000, dtype)
    ours, theirs = FUNCTIONS[name](rays, triangles), textbook.test(name, rays, triangles)
    assert ours["t"].dtype == theirs["t"].dtype == dtype
    assert np.array_equal(ours["hit"], theirs["hit"])
    assert 0 < ours["hit"].sum() or "culling" in name
    for field in ("t", "u", "v"):
        mine, template = ours[field][ours["hit"]], theirs[field][ours["hit"]]
        assert mine.tobytes() == template.tobytes(), field
    assert np.isnan(theirs["t"][~theirs["hit"]]).all()


def truth(rays, triangles):
    """The definition of a hit, from scratch: solves for t, u, v by elimination over fractions."""
    answers = []
    for ray, corners in zip(rays.tolist(), triangles.tolist()):
        a, b, c = ([Fraction(x) for x in corner] for corner in corners)
        o, d = [Fraction(x) for x in ray[:3]], [Fraction(x) for x in ray[3:6]]
        low, high = ray[6:] if len(ray) == 8 else (0.0, float("inf"))
        rows = [[-d[x], b[x] - a[x], c[x] - a[x], o[x] - a[x]] for x in range(3)]
        for step in range(3):
            pivot = next((i for i in range(step, 3) if rows[i][step] != 0), None)
            if pivot is None:
                answers.append(None)
                break
            rows[step], rows[pivot] = rows[pivot], rows[step]
            for i in range(3):
                if i != step:
                    factor = rows[i][step] / rows[step][step]
                    rows[i] = [x - factor * y for x, y in zip(rows[i], rows[step])]
        else:
            t, u, v = (rows[i][3] / rows[i][i] for i in range(3))
            hit = low <= t <= high and u >= 0 and v >= 0 and u + v <= 1
            answers.append((t, u, v) if hit else None)
    return answers


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("name", EXACT)
def test_over_fractions_all_are_the_definition_of_a_hit(name, kind):
    rays, triangles = pairs(kind, 60, np.float32, seed=5)
    found = FUNCTIONS[name](rays, triangles, exact=True)
    for row, expected, ray, corners in zip(found, truth(rays, triangles), rays, triangles):
        if "culling" in name and expected is not None:
            n = np.cross((corners[1] - corners[0]).astype(float),
                         (corners[2] - corners[0]).astype(float))
            if n @ ray[3:6] > 0:
                expected = None
        assert row["hit"] == (expected is not None)
        if row["hit"]:
            assert (row["t"], row["u"], row["v"]) == expected
            assert all(isinstance(row[x], Fraction) for x in "tuv")


def test_a_scene_agrees_with_the_exact_answer_and_floats_do_not():
    rays, triangles = pairs("edges", 3000, np.float32, seed=1)
    exact = textbook.determinants(rays, triangles, exact=True)["hit"]
    mine = np.array([pierce.Scene(corners[None]).closest_hit(ray).hit
                     for corners, ray in zip(triangles, rays)])
    assert np.array_equal(mine, exact)
    wrong = {name: int((FUNCTIONS[name](rays, triangles)["hit"] != exact).sum()) for name in EXACT}
    assert all(count > 0 for name, count in wrong.items() if "culling" not in name), wrong


def test_epsilon_hides_small_triangles():
    ray, triangle = [0.25e-3, 0.25e-3, 1, 0, 0, -1], np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0]])
    small = triangle * 1e-3
    assert not textbook.moller_trumbore(ray, small)["hit"]
    assert textbook.moller_trumbore(ray, small, epsilon=0)["hit"]
    assert not textbook.moller_trumbore(ray, small, exact=True)["hit"]
    assert textbook.moller_trumbore(ray, small, exact=True)["det"].item() > 0


def test_shapes_broadcast_and_a_single_pair_has_no_shape():
    rays, triangles = pairs("random", 12, np.float64)
    table = textbook.cramer(rays[:, None], triangles[None])
    assert table.shape == (12, 12)
    assert np.diagonal(table).tolist() == textbook.cramer(rays, triangles).tolist()
    assert textbook.cramer(rays[0], triangles[0]).shape == ()
    assert textbook.plane_then_edges(rays[:0], triangles[:0]).shape == (0,)
    assert textbook.plane_then_edges(rays, triangles)["n"].shape == (12, 3)
    assert textbook.test("cramer", rays[:0], triangles[:0]).shape == (0,)


def test_parallel_rays_miss_and_say_why():
    found = textbook.cramer([0, 0, 1, 1, 0, 0], [[0, 0, 0], [1, 0, 0], [0, 1, 0]])
    assert not found["hit"] and found["m"] == 0 and not np.isfinite(found["t"])
    exact = textbook.cramer([0, 0, 1, 1, 0, 0], [[0, 0, 0], [1, 0, 0], [0, 1, 0]], exact=True)
    assert not exact["hit"] and exact["m"].item() == 0 and np.isnan(exact["t"].item())


def test_what_is_refused():
    triangle = np.zeros((3, 3))
    with pytest.raises(ValueError, match=r"rays has the shape \(5,\)"):
        textbook.cramer(np.zeros(5), triangle)
    with pytest.raises(ValueError, match=r"triangles has the shape \(3, 2\)"):
        textbook.cramer(np.zeros(6), np.zeros((3, 2)))
    with pytest.raises(TypeError, match="float32"):
        textbook.cramer(np.zeros(6, np.float32), triangle)
    with pytest.raises(ValueError, match="do not go together"):
        textbook.cramer(np.zeros((2, 6)), np.zeros((3, 3, 3)))
    with pytest.raises(ValueError, match="watertight"):
        textbook.test("embree", np.zeros(6), triangle)
