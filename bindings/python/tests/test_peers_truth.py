# SPDX-License-Identifier: Apache-2.0
"""The judge of scripts/python_peers.py, which is not pierce's: it agrees, and it convicts."""

import importlib.util
from pathlib import Path

import numpy as np
import pytest
from example_modules import example_modules

import pierce

SCRIPT = Path(__file__).resolve().parents[3] / "scripts" / "peers_truth.py"
pytestmark = pytest.mark.skipif(not SCRIPT.is_file(), reason="the package without its repository")


@pytest.fixture(scope="module")
def case():
    spec = importlib.util.spec_from_file_location("peers_truth", SCRIPT)
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    with example_modules():
        import meshes

        vertices, triangles = meshes.knot(60, 12)
    vertices = vertices.astype(np.float32)
    random = np.random.default_rng(3)
    origins = random.uniform(-4, 4, (300, 3)).astype(np.float32)
    marks = np.concatenate([vertices, vertices[triangles[:, :2]].mean(axis=1)])
    points = marks[random.integers(0, len(marks), 300)]
    directions = (points - origins).astype(np.float32)
    points[::2] += (1e-6 * random.standard_normal((150, 3))).astype(np.float32)
    truth = module.Truth(vertices, triangles, origins, directions, points)
    return truth, pierce.Scene(vertices, triangles), origins, directions, points


def test_rays(case):
    truth, scene, o, d, _ = case
    hits = scene.closest_hit(o, d)
    assert hits.hit.sum() > 200
    for i, (t, triangle) in enumerate(zip(hits.t, hits.triangle)):
        who, exact = truth.closest(o[i], d[i])
        assert triangle == min(who, default=-1)
        assert exact is None or np.float32(float(exact)) == t
    assert truth.judge_any(o, d, hits.hit, ~hits.hit, hits.triangle) == [0, 300]


def test_closest_convicts(case):
    truth, scene, o, d, _ = case
    mine = scene.closest_hit(o, d).triangle
    assert truth.judge_closest(o, d, mine, mine) == [0, 0]
    missing = np.full_like(mine, -1)
    assert truth.judge_closest(o, d, mine, missing) == [0, (mine >= 0).sum()]
    assert truth.judge_closest(o, d, missing, mine) == [(mine >= 0).sum(), 0]
    lists = scene.all_hits(o, d)
    last = np.array([lists.of(i).triangle[-1] if lists.counts[i] else -1 for i in range(300)])
    late = np.array([lists.counts[i] > 0 and lists.of(i).t[-1] > lists.of(i).t[0]
                     for i in range(300)])
    assert late.sum() > 20
    assert truth.judge_closest(o, d, mine, last) == [0, late.sum()]


def test_lists(case):
    truth, scene, o, d, _ = case
    full, once = scene.all_hits(o, d), scene.all_hits(o, d, distinct=True)
    mine, theirs = (full.ray, full.triangle), (once.ray, once.triangle)
    assert len(once) < len(full)
    assert truth.judge_all(o, d, mine, theirs, 300) == [0, 0]
    fewer = (full.ray[1:], full.triangle[1:])
    assert truth.judge_all(o, d, mine, fewer, 300) == [0, int(full.t[0] != full.t[1])]
    false = (np.append(full.ray, 0), np.append(full.triangle, 7))
    assert truth.judge_all(o, d, mine, false, 300)[1] == 1


def test_points(case):
    truth, scene, _, _, p = case
    inside = scene.locate(p) >= 0
    assert 0.2 < inside.mean() < 0.95 and (scene.locate(p) == 0).sum() > 30
    assert [truth.inside(q) for q in p] == inside.tolist()
    assert truth.judge_inside(p, inside, ~inside) == [0, 300]
    found = scene.nearest(p)
    for q, triangle, distance in zip(p, found.triangle, found.distance):
        exact = float(truth.distance2(truth.whole(q), triangle)) ** 0.5 / 2.0**truth.shift
        assert np.float32(exact) == pytest.approx(distance, rel=1e-6)
    assert truth.judge_nearest(p, found.triangle, found.triangle * 0)[0] == 0
    assert truth.judge_nearest(p, found.triangle, found.triangle * 0)[1] > 290
