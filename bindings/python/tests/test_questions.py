# SPDX-License-Identifier: Apache-2.0
"""What a mesh is asked beside rays, against exact arithmetic on fractions."""

import math
from fractions import Fraction

import numpy as np
import oracle
import pytest
from hypothesis import given
from hypothesis import strategies as st
from meshes import CUBE, SQUARE, TETRAHEDRON, closed_meshes, few, grid, scenes, usual

import pierce

TYPES = [np.float32, np.float64]
both = pytest.mark.parametrize("dtype", TYPES)


def points_of(data, dtype, count, numbers=few):
    flat = data.draw(st.lists(numbers, min_size=3 * count, max_size=3 * count))
    return np.array(flat, np.float32).astype(dtype).reshape(count, 3)


def in_order(vertices, triangles, point):
    """(squared distance, triangle, nearest point) of all, in order."""
    p = oracle.vector(point)
    found = []
    for number, triangle in enumerate(triangles):
        q = oracle.nearest_on(p, *oracle.corners(vertices, triangle))
        gap = oracle.minus(p, q)
        found.append((oracle.dot(gap, gap), number, q))
    return sorted(found, key=lambda one: one[:2])


@both
@given(data=st.data())
def test_near_triangles(data, dtype):
    vertices, triangles = data.draw(closed_meshes(dtype))
    points = points_of(data, dtype, 2)
    k = data.draw(st.integers(0, len(triangles) + 1))
    scene = pierce.Scene(vertices, triangles)
    near = scene.k_nearest(points, k)
    assert near.shape == (2, k) and near.point.shape == (2, k, 3)
    for i, point in enumerate(points):
        exact = in_order(vertices, triangles, point)
        expected = [number for _, number, _ in exact][:k]
        missing = k - len(expected)
        assert near.triangle[i].tolist() == expected + [-1] * missing
        assert near.geometry[i].tolist() == [0] * len(expected) + [-1] * missing
        for rank, (square, _, q) in enumerate(exact[:k]):
            assert near.distance[i, rank] == oracle.rounded_root(square, dtype)
            assert near.point[i, rank].tolist() == [oracle.rounded(x, dtype) for x in q]
        assert np.isinf(near.distance[i, len(expected):]).all()
        assert np.isnan(near.point[i, len(expected):]).all()
        radius = dtype(data.draw(st.sampled_from([0.0, 0.5, 1.0, 2.0, 1e9])))
        lists = scene.within(points, np.array([radius, 0], dtype) if i == 0 else radius)
        reach = [number for square, number, _ in exact if square <= Fraction(float(radius)) ** 2]
        assert lists.of(i).triangle.tolist() == reach and lists.counts[i] == len(reach)
        assert scene.k_nearest(point, k, radius).triangle.tolist() == (
            reach[:k] + [-1] * (k - len(reach[:k])))


def clipped(polygon, f):
    """What of a convex polygon, segment or point lies where f, linear, is not negative."""
    kept = []
    for a, b in zip(polygon, [*polygon[1:], polygon[0]] if polygon else []):
        at_a, at_b = f(a), f(b)
        if at_a >= 0:
            kept.append(a)
        if at_a * at_b < 0:
            kept.append(oracle.along(a, at_a / (at_a - at_b), oracle.minus(b, a)))
    return kept


def normal(t):
    return oracle.cross(oracle.minus(t[1], t[0]), oracle.minus(t[2], t[0]))


def in_triangle(polygon, t):
    """What of it lies in a triangle with area."""
    n = normal(t)
    for sign in (1, -1):
        polygon = clipped(polygon, lambda x: sign * oracle.dot(n, oracle.minus(x, t[0])))
    for i in range(3):
        inward = oracle.cross(n, oracle.minus(t[(i + 1) % 3], t[i]))
        polygon = clipped(polygon, lambda x: oracle.dot(inward, oracle.minus(x, t[i])))
    return polygon


def in_box(polygon, low, high):
    for axis in range(3):
        polygon = clipped(polygon, lambda x: x[axis] - low[axis])
        polygon = clipped(polygon, lambda x: high[axis] - x[axis])
    return polygon


@both
@given(data=st.data())
def test_touched_triangles(data, dtype):
    vertices, triangles = data.draw(closed_meshes(dtype))
    ends = points_of(data, dtype, 4)
    scene = pierce.Scene(vertices, triangles)
    corners = [oracle.corners(vertices, triangle) for triangle in triangles]
    segments = scene.touching_segments(ends[:2], ends[2:])
    low, high = np.minimum(ends[:2], ends[2:]), np.maximum(ends[:2], ends[2:])
    boxes = scene.touching_boxes(low, high)
    assert segments.geometry.tolist() == [0] * len(segments)
    for i in range(2):
        box = oracle.vector(low[i]), oracle.vector(high[i])
        assert boxes.of(i)[:, 1].tolist() == [
            number for number, t in enumerate(corners) if in_box(list(t), *box)]
        flat = {number for number, t in enumerate(corners) if not any(normal(t))}
        line = [oracle.vector(ends[i]), oracle.vector(ends[i + 2])]
        assert [x for x in segments.of(i)[:, 1].tolist() if x not in flat] == [
            number for number, t in enumerate(corners)
            if number not in flat and in_triangle(line, t)]


def overlap(p, q):
    """Whether two triangles with area share more than their common corners, or edge."""
    common = [x for x in p if x in q]
    if len(common) == 3:
        return True
    for x in in_triangle(list(p), q):
        if not common or (len(common) == 1 and x != common[0]):
            return True
        if len(common) == 2 and any(oracle.cross(oracle.minus(x, common[0]),
                                                 oracle.minus(common[1], common[0]))):
            return True
    return False


@both
@given(data=st.data())
def test_self_intersections(data, dtype):
    vertices, triangles, _ = data.draw(scenes(dtype))
    corners = [oracle.corners(vertices, triangle) for triangle in triangles]
    expected = [[i, j] for j in range(len(corners)) for i in range(j)
                if any(normal(corners[i])) and any(normal(corners[j]))
                and overlap(corners[i], corners[j])]
    assert pierce.self_intersections(vertices, triangles).tolist() == sorted(expected)


@both
@given(data=st.data())
def test_measures(data, dtype):
    vertices, triangles = data.draw(closed_meshes(dtype))
    corners = [oracle.corners(vertices, triangle) for triangle in triangles]
    size = pierce.measure(vertices, triangles)
    six = sum(oracle.dot(a, oracle.cross(b, c)) for a, b, c in corners)
    assert size["volume"] == oracle.rounded(Fraction(six) / 6, np.float64)
    assert math.isclose(size["area"], sum(math.sqrt(oracle.dot(normal(t), normal(t))) / 2
                                          for t in corners), rel_tol=1e-14)
    solids = len(triangles) // 4
    assert (size["components"], size["euler"]) == (solids, 2 * solids)
    assert (size["vertices"], size["edges"]) == (4 * solids, 6 * solids)
    assert size["consistent"] and size["orientable"]


def test_measures_of_known_meshes():
    size = pierce.measure(*CUBE)
    assert (size["volume"], size["area"], size["euler"]) == (8, 24, 2)
    assert pierce.measure(pierce.Scene(*CUBE)) == size == pierce.measure(CUBE)
    soup = CUBE[0][CUBE[1]]  # no vertex is shared
    assert pierce.measure(soup)["components"] == 12
    assert pierce.measure(soup, same="position") == size
    turned = SQUARE[1].copy()
    turned[1] = turned[1][::-1]
    assert not pierce.measure(SQUARE[0], turned)["consistent"]
    assert pierce.measure(np.zeros((0, 3)), np.zeros((0, 3), np.uint32))["area"] == 0
    with pytest.raises(ValueError, match="2 meshes; give one at a time"):
        pierce.measure([CUBE, SQUARE])
    with pytest.raises(ValueError, match="a placed mesh has other measures"):
        pierce.self_intersections((CUBE, np.eye(4)))
    with pytest.raises(ValueError, match="same is 'name'; give one of 'index', 'position'"):
        pierce.measure(*CUBE, same="name")


def test_closedness():
    closed = pierce.closedness(*CUBE)
    assert closed["closed"] and closed["watertight"] and closed["edges"] == 18
    assert closed["first_unbalanced"] is closed["first_odd"] is closed["first_crowded"] is None
    for dtype in TYPES:
        lid = pierce.closedness(CUBE[0].astype(dtype), CUBE[1][1:])
        assert not lid["closed"] and (lid["open_edges"], lid["unbalanced_edges"]) == (3, 3)
        first = lid["first_unbalanced"]
        assert first == {"triangle": 0, "edge": (0, 3), "other_triangle": None, "forward": 1,
                         "backward": 0}
    soup = pierce.Scene(CUBE[0][CUBE[1]])
    assert pierce.closedness(soup)["open_edges"] == 36
    assert pierce.closedness(soup, same="position") == closed
    twice = pierce.closedness(CUBE[0], np.concatenate([CUBE[1], CUBE[1]]))
    assert twice["balanced"] and not twice["closed"] and twice["crowded_edges"] == 18
    assert twice["first_crowded"]["forward"] == 2
    # A long edge that faces two short ones, and one triangle turned.
    split = [[0, 0, 0], [2, 0, 0], [0, 2, 0], [1, 0, 0], [0, 0, 2]]
    junction = pierce.closedness(split, [[0, 2, 1], [0, 3, 4], [3, 1, 4], [0, 4, 2], [1, 2, 4]],
                                 same="position")
    assert not junction["balanced"] and junction["watertight"]
    assert junction["unbalanced_in_pieces"] == 3
    turned = CUBE[1].copy()
    turned[0] = turned[0][::-1]
    assert (lambda found: found["even"] and not found["balanced"])(
        pierce.closedness(CUBE[0], turned))
    with pytest.raises(IndexError, match="triangle 0 names a vertex"):
        pierce.closedness(CUBE[0], np.uint32([[0, 1, 9]]))


def weld_by_definition(vertices, triangles, distance):
    """(kept vertices, triangles, which one each is now), over fractions."""
    limit = Fraction(distance) ** 2
    kept, vertex_of = [], []
    for vertex in vertices:
        p = oracle.vector(vertex)
        near = [i for i, q in enumerate(kept)
                if oracle.dot(oracle.minus(p, q), oracle.minus(p, q)) <= limit]
        vertex_of.append(near[0] if near else len(kept))
        if not near:
            kept.append(p)
    corners = [[vertex_of[corner] for corner in triangle] for triangle in triangles]
    return kept, [c for c in corners if len(set(c)) == 3], vertex_of


@both
@given(data=st.data())
def test_weld(data, dtype):
    vertices, triangles, _ = data.draw(scenes(dtype))
    distance = data.draw(st.sampled_from([None, 0, 0.5, 1.0, 2.0**-23, np.float32(0.1)]))
    welded = pierce.weld(vertices, triangles, distance=distance)
    kept, corners, vertex_of = weld_by_definition(vertices, triangles, float(distance or 0))
    assert welded.vertices.dtype == dtype and welded.triangles.dtype == np.uint32
    assert [oracle.vector(vertex) for vertex in welded.vertices] == kept
    assert welded.triangles.tolist() == corners
    assert welded.vertex_of.tolist() == vertex_of
    assert welded.collapsed == len(triangles) - len(corners)
    moved = vertices.astype(np.float64) - welded.vertices.astype(np.float64)[welded.vertex_of]
    assert math.isclose(welded.farthest, np.linalg.norm(moved, axis=1).max(), rel_tol=1e-12)


def test_weld_takes_what_a_scene_takes(tmp_path):
    soup = CUBE[0][CUBE[1]]
    whole = pierce.weld(soup)
    assert pierce.Scene(whole).locate([1, 1, 1]) == 1
    assert pierce.closedness(whole)["closed"] and len(whole.vertices) == 8
    assert repr(whole) == "Welded(float64, 8 of 36 vertices, 12 triangles)"
    path = tmp_path / "cube.off"
    path.write_text("OFF\n36 12 0\n" + "".join("%r %r %r\n" % tuple(p) for p in
                                               soup.reshape(-1, 3).tolist())
                    + "".join(f"3 {i} {i + 1} {i + 2}\n" for i in range(0, 36, 3)))
    arrays = soup.reshape(-1, 3), np.arange(36).reshape(-1, 3)
    for same in (pierce.weld(path), pierce.weld(str(path)), pierce.weld(pierce.Scene(soup)),
                 pierce.weld(whole), pierce.weld(arrays), pierce.weld(*arrays)):
        assert np.array_equal(same.vertices, whole.vertices)
        assert np.array_equal(same.triangles, whole.triangles)
    halves = [(CUBE[0], CUBE[1][:6]), (CUBE[0] + 1e-9, CUBE[1][6:])]
    assert not pierce.closedness(pierce.weld(halves))["closed"]
    joined = pierce.weld(halves, distance=1e-8)
    assert pierce.closedness(joined)["closed"]
    assert np.array_equal(joined.vertices, CUBE[0])
    for nothing in (pierce.weld(np.zeros((0, 3)), []), pierce.weld([])):
        assert nothing.vertices.shape == nothing.triangles.shape == (0, 3)
        assert nothing.farthest == nothing.collapsed == 0
    assert pierce.weld(CUBE, distance=100).collapsed == 12
    lost = CUBE[0].copy()
    lost[3] = np.nan
    assert np.isnan(pierce.weld(lost, CUBE[1]).vertices[3]).all()


@pytest.mark.parametrize("bad, error, words", [
    (lambda: pierce.weld(CUBE, distance=-1), ValueError, "cannot be -1"),
    (lambda: pierce.weld(CUBE, distance=math.nan), ValueError, "cannot be nan"),
    (lambda: pierce.weld(CUBE, distance=math.inf), ValueError, "cannot be inf"),
    (lambda: pierce.weld(CUBE, distance="far"), TypeError, "distance holds no numbers"),
    (lambda: pierce.weld(CUBE, distance=[1, 2]), ValueError, r"shape \(2,\); give one number"),
    (lambda: pierce.weld((CUBE, np.eye(4))), ValueError, "a placed mesh cannot be welded"),
    (lambda: pierce.weld(CUBE[0], np.uint32([[0, 1, 8]])), IndexError, "names vertex 8"),
    (lambda: pierce.weld([CUBE, (CUBE[0], np.uint32([[0, 1, 8]]))]), pierce.IndexOutOfRange,
     "mesh 1: triangles: triangle 0 names vertex 8, but there are 8 vertices"),
    (lambda: pierce.weld([CUBE, (CUBE[0].astype(np.float32), CUBE[1])]), TypeError, "one type"),
])
def test_weld_refuses(bad, error, words):
    with pytest.raises(error, match=words):
        bad()


def half_angle(point, a, b, c):
    a, b, c = (np.asarray(x, float) - point for x in (a, b, c))
    la, lb, lc = (np.linalg.norm(x) for x in (a, b, c))
    return math.atan2(a @ np.cross(b, c), la * lb * lc + (a @ b) * lc + (b @ c) * la + (c @ a) * lb)


@both
def test_winding_number(dtype):
    """A whole number around what is closed; the rest of the angles where it is open."""
    rng = np.random.default_rng(18)
    vertices, triangles = TETRAHEDRON[0].astype(dtype), TETRAHEDRON[1]
    points = rng.integers(-8, 24, (200, 3)).astype(dtype) / dtype(7)
    closed = pierce.Scene(vertices, triangles)
    number, error = closed.winding_number(points)
    off = closed.locate(points) != 0
    assert number.dtype == error.dtype == np.float64 and not error[off].any() and off.sum() > 150
    assert np.array_equal(number[off], closed.locate(points[off]) > 0)
    opened = pierce.Scene(vertices, triangles[:3])
    part, bound = opened.winding_number(points.reshape(4, 50, 3))
    assert part.shape == bound.shape == (4, 50) and (bound <= 1e-6).all()
    missing = [half_angle(p, *vertices[triangles[3]]) / (2 * math.pi) for p in points]
    plane = np.abs(points.sum(axis=1) - 4) > 1e-3  # near it, doubles do not know the side
    wrong = np.abs(part.reshape(-1) + missing - number)[off & plane]
    assert wrong.max() <= bound.max() + 1e-12
    fine, bound = opened.winding_number(points, 1e-12, threads=2)
    assert (bound <= 1e-12).all() and (np.abs(fine - part.reshape(-1)) <= 2e-6).all()

    inside = opened.locate(points, rule="winding")
    part, bound = part.reshape(-1), opened.winding_number(points)[1]
    sure = np.abs(part - 0.5) > bound  # else it may be 1/2, which is not above it
    assert sure.sum() > 150
    expected = np.where(part > 0.5, 1, -1) * (opened.nearest(points).distance > 0)
    assert np.array_equal(inside[sure], expected[sure])
    distance = opened.signed_distance(points, rule="winding")
    assert np.array_equal(np.sign(distance), -inside)
    cells = opened.voxelise([0, 0, 0], 1, (3, 3, 3), rule="winding")
    centres = np.stack(np.meshgrid(*[np.arange(3) + 0.5] * 3, indexing="ij"), -1).astype(dtype)
    assert np.array_equal(cells, opened.locate(centres, rule="winding"))
    for tolerance in (-1.0, math.nan):
        with pytest.raises(ValueError, match="tolerance"):
            opened.winding_number(points, tolerance)


def test_threads_and_many_questions():
    vertices, triangles = grid(20)
    scene = pierce.Scene(vertices, triangles)
    points = np.random.default_rng(3).random((3, 400, 3)) * 20
    alone, together = (scene.within(points, 2, threads=n) for n in (1, 0))
    assert np.array_equal(alone.offsets, together.offsets)
    assert np.array_equal(alone.triangle, together.triangle)
    assert together.counts.shape == (3, 400) and len(together) == together.offsets[-1]
    assert np.array_equal(np.bincount(together.query, minlength=1200), together.counts.reshape(-1))
    first = scene.k_nearest(points, 1).triangle[..., 0]
    assert np.array_equal(first, scene.nearest(points).triangle)
    told = []
    scene.within(points, 2, progress=told.append)
    assert told[-1] == 1
    empty = scene.within(np.zeros((0, 3)), 1)
    assert empty.counts.shape == (0,) and len(empty) == 0
    pytest.importorskip("pandas")
    frame = scene.touching_boxes(points - 1, points + 1).to_dataframe()
    assert list(frame) == ["query", "geometry", "triangle"]


@given(data=st.data())
def test_usual_numbers(data):
    """Not only where everything touches."""
    vertices, triangles, _ = data.draw(scenes(np.float64))
    points = points_of(data, np.float64, 2, usual)
    near = pierce.Scene(vertices, triangles).k_nearest(points, 3)
    for i, point in enumerate(points):
        expected = [number for _, number, _ in in_order(vertices, triangles, point)][:3]
        assert near.triangle[i].tolist() == expected + [-1] * (3 - len(expected))


@pytest.mark.parametrize("ask, error, text", [
    (lambda s: s.k_nearest([0, 0, 0], -1), ValueError, "k is -1; give a number from 0"),
    (lambda s: s.k_nearest([0, 0, 0], 10**9), ValueError,
     "k is 1000000000, but the scene has 4 triangles; give no more"),
    (lambda s: s.k_nearest([0, 0, 0], 1.5), TypeError, "k is 1.5; give a whole number"),
    (lambda s: s.within([0, 0, 0], None), TypeError, "radius is None"),
    (lambda s: s.within([0, 0, 0], -1), ValueError, "radius is negative"),
    (lambda s: s.within(np.zeros((2, 3)), [1, 2, 3]), ValueError, "radius has the shape"),
    (lambda s: s.within([[0, 0, 0], [0, 0, np.nan]], 1), pierce.InvalidPoint, "bad point 1"),
    (lambda s: s.touching_boxes([0, 0, 0], [[0, 0, 0]]), ValueError, "lower and upper have the"),
    (lambda s: s.touching_segments([0, 0, 0], [0, 0, np.inf]), pierce.InvalidPoint, "bad point 0"),
    (lambda s: s.touching_segments([0, 0], [0, 0, 1]), ValueError, "starts has the shape"),
])
def test_errors(ask, error, text):
    with pytest.raises(error, match=text):
        ask(pierce.Scene(*TETRAHEDRON))


def test_nothing_to_find():
    scene = pierce.Scene(np.zeros((0, 3)), np.zeros((0, 3), np.uint32))
    assert scene.k_nearest([0, 0, 0], 2).triangle.tolist() == [-1, -1]
    assert scene.k_nearest([0, 0, 0], 1000).shape == (1000,)
    with pytest.raises(ValueError, match="k is 1001, but the scene has 0 triangles"):
        scene.k_nearest([0, 0, 0], 1001)
    assert scene.winding_number([0, 0, 0]) == (0, 0)
    assert len(scene.within([0, 0, 0], 5)) == len(scene.touching_boxes([0] * 3, [1] * 3)) == 0
    assert pierce.Scene(*TETRAHEDRON).touching_boxes([1] * 3, [0] * 3).counts == 0
