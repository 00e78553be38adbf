# SPDX-License-Identifier: Apache-2.0
"""Every answer against exact arithmetic on fractions, written in Python. No tolerance."""

from fractions import Fraction

import numpy as np
import oracle
import pytest
from hypothesis import given
from hypothesis import strategies as st
from meshes import closed_meshes, few, scenes

import pierce

TYPES = [np.float32, np.float64]
both = pytest.mark.parametrize("dtype", TYPES)


def same(got, exact, dtype):
    """Equal bits: of zeros too."""
    expected = np.array([oracle.rounded(x, dtype) for x in exact], dtype)
    assert np.array_equal(np.asarray(got).reshape(-1), expected), (got, expected)
    assert not np.signbit(expected[expected == 0]).any()
    assert not np.signbit(np.asarray(got)[np.asarray(got) == 0]).any()


def check_hits(got, exact, vertices, rays, dtype):
    """A list of pierce's hits and one of (ray number, exact hit)."""
    for name in ("t", "u", "v", "w"):
        same(getattr(got, name), [getattr(hit, name) for _, hit in exact], dtype)
    assert got.triangle.tolist() == [hit.triangle for _, hit in exact]
    assert got.facing.tolist() == [hit.facing for _, hit in exact]
    assert got.geometry.tolist() == [0] * len(exact)
    points = []
    for ray, hit in exact:
        points += oracle.along(oracle.vector(rays[ray][:3]), hit.t, oracle.vector(rays[ray][3:6]))
    same(got.points, points, dtype)


@both
@given(data=st.data())
def test_rays(data, dtype):
    vertices, triangles, rays = data.draw(scenes(dtype))
    scene = pierce.Scene(vertices, triangles)
    exact = [oracle.all_hits(vertices, triangles, ray) for ray in rays]
    flat = [(i, hit) for i, hits in enumerate(exact) for hit in hits]

    lists = scene.all_hits(rays)
    assert lists.offsets.tolist() == [0, *np.cumsum([len(hits) for hits in exact])]
    check_hits(lists, flat, vertices, rays, dtype)
    assert lists.ray.tolist() == [i for i, _ in flat]
    assert lists.counts.tolist() == scene.count_hits(rays).tolist()

    first = scene.closest_hit(rays)
    assert first.hit.tolist() == [bool(hits) for hits in exact]
    check_hits(first[first.hit], [(i, hits[0]) for i, hits in enumerate(exact) if hits], vertices,
               rays, dtype)
    missed = ~first.hit
    assert np.isinf(first.t[missed]).all() and (first.triangle[missed] == -1).all()
    assert np.isnan(first.points[missed]).all() and np.isnan(first.normals[missed]).all()
    assert scene.any_hit(rays).tolist() == first.hit.tolist()

    hits = first  # step by step
    for rank in range(max(map(len, exact), default=0)):
        expected = [h[rank].triangle if rank < len(h) else -1 for h in exact]
        assert hits.triangle.tolist() == expected
        hits = scene.step(hits)
    assert not hits.hit.any()


@both
@given(data=st.data())
def test_options(data, dtype):
    vertices, triangles, rays = data.draw(scenes(dtype))
    scene = pierce.Scene(vertices, triangles)
    exact = [oracle.all_hits(vertices, triangles, ray) for ray in rays]
    skip = data.draw(st.integers(-1, len(triangles) - 1))
    sides = data.draw(st.sampled_from(["both", "front", "back"]))
    open_start = data.draw(st.booleans())
    distinct = data.draw(st.booleans())
    most = data.draw(st.sampled_from([None, 0, 1, 2]))
    odd = data.draw(st.booleans())

    expected = []
    for ray, hits in zip(rays, exact):
        kept = [hit for hit in hits if hit.triangle != skip
                and (sides == "both" or hit.facing == (sides == "back"))
                and not (open_start and hit.t == float(ray[6]))
                and not (odd and hit.triangle % 2 == 0)]
        if distinct:
            kept = [hit for i, hit in enumerate(kept) if i == 0 or kept[i - 1].t != hit.t]
        expected.append([hit.triangle for hit in kept])

    options = {"skip": skip, "sides": sides, "open_start": open_start}
    if odd:
        options["filter"] = lambda ray, hits: hits.triangle % 2 == 1
    lists = scene.all_hits(rays, distinct=distinct, max_hits=most, **options)
    assert [lists.of(i).triangle.tolist() for i in range(len(rays))] == [
        row[:most] for row in expected]
    assert scene.count_hits(rays, distinct=distinct, **options).tolist() == [
        len(row) for row in expected]
    first = [row[0] if row else -1 for row in expected]
    assert scene.closest_hit(rays, **options).triangle.tolist() == first
    assert scene.any_hit(rays, **options).tolist() == [x >= 0 for x in first]


@both
@given(data=st.data())
def test_points(data, dtype):
    vertices, triangles = data.draw(closed_meshes(dtype))
    flat = data.draw(st.lists(few, min_size=9, max_size=9))
    points = np.array(flat, np.float32).astype(dtype).reshape(3, 3)
    scene = pierce.Scene(vertices, triangles)
    near = scene.nearest(points)
    inside = scene.locate(points)
    distance = scene.signed_distance(points)
    for i, point in enumerate(points):
        square, triangle, q = oracle.nearest(vertices, triangles, point)
        length = oracle.rounded_root(square, dtype)
        assert inside[i] == oracle.locate(vertices, triangles, point)
        assert near.triangle[i] == triangle and near.geometry[i] == 0
        assert near.distance[i] == length
        assert distance[i] == (-length if inside[i] == 1 else length)
        same(near.point[i], q, dtype)
        reach = scene.nearest(points, np.full(3, length, dtype))
        assert reach.found[i] == (Fraction(length) ** 2 >= square)


@both
@given(data=st.data())
def test_crossings(data, dtype):
    """Of a ray from anywhere, an odd number means inside; both ends see the same line."""
    vertices, triangles = data.draw(closed_meshes(dtype))
    flat = data.draw(st.lists(few, min_size=6, max_size=6))
    ray = np.array(flat, np.float32).astype(dtype)
    if not ray[3:].any():
        ray[5] = 1
    scene = pierce.Scene(vertices, triangles)
    crossings = scene.crossings(ray)
    where = oracle.locate(vertices, triangles, ray[:3])
    assert bool(crossings.origin_on_surface) == (where == 0)
    if where != 0:
        assert (int(crossings.count) % 2 == 1) == (where == 1)
    line = scene.crossings(ray, t_min=-np.inf)
    assert int(line.count) % 2 == 0 and int(line.signed_count) == 0


@both
@given(data=st.data())
def test_voxels(data, dtype):
    vertices, triangles = data.draw(closed_meshes(dtype))
    scene = pierce.Scene(vertices, triangles)
    origin = np.array(data.draw(st.lists(few, min_size=3, max_size=3)), np.float32).astype(dtype)
    cells = scene.voxelise(origin, 0.5, (3, 2, 2))
    assert cells.shape == (3, 2, 2)
    for index in np.ndindex(3, 2, 2):
        exact = [Fraction(float(o)) + (Fraction(i) + Fraction(1, 2)) / 2
                 for o, i in zip(origin, index)]
        centre = np.array([oracle.rounded(x, dtype) for x in exact], dtype)
        assert cells[index] == oracle.locate(vertices, triangles, centre)


@both
@given(data=st.data())
def test_next_origins(data, dtype):
    """The start lies strictly on the wanted side, and nothing is between it and the hit."""
    vertices, triangles, rays = data.draw(scenes(dtype))
    scene = pierce.Scene(vertices, triangles)
    hits = scene.closest_hit(rays)
    starts = scene.next_origin(hits)
    assert np.isnan(starts[~hits.hit]).all()
    for i in np.flatnonzero(hits.hit & np.isfinite(starts).all(axis=-1)):
        a, b, c = oracle.corners(vertices, triangles[hits.triangle[i]])
        n = oracle.cross(oracle.minus(b, a), oracle.minus(c, a))
        side = oracle.dot(n, oracle.minus(oracle.vector(starts[i]), a))
        assert side != 0 and (side > 0) == (hits.facing[i] == 0)


@both
def test_normals(dtype):
    """Each component of N / |N| is the nearest number."""
    rng = np.random.default_rng(7)
    vertices = rng.integers(-50, 50, (60, 3)).astype(dtype)
    triangles = np.arange(60).reshape(-1, 3)
    scene = pierce.Scene(vertices, triangles)
    for i, (a, b, c) in enumerate(oracle.corners(vertices, row) for row in triangles):
        n = oracle.cross(oracle.minus(b, a), oracle.minus(c, a))
        middle = np.array([float(sum(x) / 3) for x in zip(a, b, c)], dtype)
        direction = np.array([float(x) for x in n], dtype)
        hits = scene.all_hits(middle, direction, t_min=-np.inf)
        row = hits.triangle.tolist().index(i)
        for component, normal in zip(n, hits.normals[row]):
            root = oracle.rounded_root(component * component / oracle.dot(n, n), dtype)
            assert normal == (root if component > 0 else -root)
