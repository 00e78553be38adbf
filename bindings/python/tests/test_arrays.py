# SPDX-License-Identifier: Apache-2.0
"""Arrays of every layout and type: the same answers, in the shape of what was asked."""

import copy
import pickle

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra import numpy as hnp
from meshes import CUBE, SQUARE, TETRAHEDRON, grid

import pierce

TYPES = [np.float32, np.float64]
both = pytest.mark.parametrize("dtype", TYPES)
COLUMNS = ("t", "u", "v", "w", "geometry", "triangle", "facing")
NEAREST = ["point", "distance", "u", "v", "w", "geometry", "triangle", "feature"]


def scene_of(mesh, dtype):
    return pierce.Scene(mesh[0].astype(dtype), mesh[1])


def some_rays(shape, dtype, seed=1):
    rng = np.random.default_rng(seed)
    rays = np.empty((*shape, 6), dtype)
    rays[..., :3] = rng.integers(-8, 30, (*shape, 3)) / 4
    rays[..., 3:] = rng.integers(-4, 5, (*shape, 3))
    rays[..., 5] -= 9
    return rays


def assert_same(got, expected, shape):
    assert got.shape == shape
    for name in COLUMNS:
        column = getattr(got, name)
        assert column.shape == shape and np.array_equal(column, getattr(expected, name).reshape(
            shape))


def laid(data, array):
    """The same numbers in another layout: order, strides, alignment, byte order, protection."""
    how = data.draw(st.sampled_from(["as it is", "fortran", "backwards", "slice", "record",
                                     "unaligned", "foreign", "readonly", "integers", "list"]))
    if how == "fortran":
        return np.asfortranarray(array)
    if how == "backwards":
        index = tuple(slice(None, None, -1) for _ in array.shape)
        return np.ascontiguousarray(array[index])[index]
    if how == "slice":
        wide = np.full(tuple(2 * n for n in array.shape), 77, array.dtype)
        index = tuple(slice(None, None, 2) for _ in array.shape)
        wide[index] = array
        return wide[index]
    if how == "record":
        record = np.zeros(array.shape[:-1], [("id", "i4"), ("row", array.dtype, array.shape[-1:])])
        record["row"] = array
        return record["row"]
    if how == "unaligned":
        raw = np.zeros(array.nbytes + 1, np.uint8)
        result = raw[1:].view(array.dtype).reshape(array.shape)
        result[...] = array
        return result
    if how == "foreign":
        return array.astype(array.dtype.newbyteorder())
    if how == "readonly":
        array = array.copy()
        array.flags.writeable = False
        return array
    if how == "integers" and np.array_equal(array, np.nan_to_num(array, posinf=0.5).astype(int)):
        return array.astype(data.draw(st.sampled_from([np.int8, np.int32, np.int64])))
    return array.tolist() if how == "list" and array.size else array


@both
@given(data=st.data())
def test_rays_of_any_layout(data, dtype):
    shape = data.draw(hnp.array_shapes(min_dims=0, max_dims=3, min_side=0, max_side=4))
    scene = scene_of(CUBE, dtype)
    rays = some_rays(shape, dtype)
    expected = scene.closest_hit(np.ascontiguousarray(rays.reshape(-1, 6)))
    assert_same(scene.closest_hit(laid(data, rays)), expected, shape)
    origins, directions = laid(data, rays[..., :3]), laid(data, rays[..., 3:])
    assert_same(scene.closest_hit(origins, directions), expected, shape)
    eight = np.concatenate([rays, np.zeros((*shape, 1)), np.full((*shape, 1), np.inf)],
                           axis=-1).astype(dtype)
    assert_same(scene.closest_hit(laid(data, eight)), expected, shape)
    ends = laid(data, np.zeros((*shape, 1), dtype))
    low = ends if isinstance(ends, list) else ends[..., 0]
    if not isinstance(low, list):
        assert_same(scene.closest_hit(origins, directions, low, np.inf), expected, shape)
    assert np.array_equal(scene.any_hit(rays), expected.hit.reshape(shape))
    assert scene.count_hits(rays).shape == shape
    assert scene.crossings(rays).count.shape == shape
    assert scene.all_hits(rays).counts.shape == shape


@both
@given(data=st.data())
def test_points_of_any_layout(data, dtype):
    shape = data.draw(hnp.array_shapes(min_dims=0, max_dims=3, min_side=0, max_side=4))
    scene = scene_of(CUBE, dtype)
    points = some_rays(shape, dtype)[..., :3]
    flat = np.ascontiguousarray(points.reshape(-1, 3))
    given_points = laid(data, points)
    assert np.array_equal(scene.locate(given_points), scene.locate(flat).reshape(shape))
    assert np.array_equal(scene.signed_distance(given_points),
                          scene.signed_distance(flat).reshape(shape))
    near, expected = scene.nearest(given_points), scene.nearest(flat)
    assert near.shape == shape and near.point.shape == (*shape, 3)
    for name in ("point", "distance", "u", "v", "w", "geometry", "triangle", "feature"):
        column = getattr(near, name)
        assert np.array_equal(column.reshape(-1), getattr(expected, name).reshape(-1))


@both
@given(data=st.data())
def test_meshes_of_any_layout(data, dtype):
    vertices, triangles = grid(3, dtype)
    rays = some_rays((20,), dtype)
    expected = pierce.Scene(vertices, triangles).closest_hit(rays)
    kinds = [np.uint8, np.int16, np.uint16, np.int32, np.uint32, np.int64, np.uint64, ">i4"]
    other = triangles.astype(data.draw(st.sampled_from(kinds)))
    if dtype == np.float64:
        shape = laid(data, vertices)
    else:
        shape = np.asarray(laid(data, vertices), dtype)
    scene = pierce.Scene((shape, laid(data, other)), copy=data.draw(st.booleans()))
    assert scene.dtype == dtype
    assert_same(scene.closest_hit(rays), expected, (20,))


@both
def test_broadcasting(dtype):
    scene = scene_of(TETRAHEDRON, dtype)
    origins = np.array([[1, 1, 9], [0.5, 0.5, 9], [7, 7, 9]], dtype)
    down = np.array([0, 0, -1], dtype)
    one = scene.closest_hit(origins, down)
    assert one.t.tolist() == [7, 6, np.inf] and one.triangle.tolist() == [3, 3, -1]
    table = scene.closest_hit(origins[:, None], np.array([[down, -down]]))
    assert table.shape == (3, 2) and (~table.hit[:, 1]).all()
    assert table.t[:, 0].tolist() == one.t.tolist()
    many = scene.closest_hit(origins[0], down, t_max=np.array([[5, 7, 8]], dtype))
    assert many.shape == (1, 3) and many.hit.tolist() == [[False, True, True]]
    single = scene.closest_hit(origins[0], down)
    assert single.shape == () and single.t == 7 and len(scene.closest_hit(origins, down)) == 3
    assert scene.closest_hit(np.zeros((0, 3), dtype), down).shape == (0,)


@both
def test_types_of_answers(dtype):
    scene = scene_of(TETRAHEDRON, dtype)
    hits = scene.closest_hit(some_rays((5,), dtype))
    for name in ("t", "u", "v", "w", "points", "normals"):
        assert getattr(hits, name).dtype == dtype
    assert hits.geometry.dtype == hits.triangle.dtype == np.int64
    assert hits.facing.dtype == np.uint8 and hits.hit.dtype == np.bool_
    lists = scene.all_hits(some_rays((5,), dtype))
    assert lists.offsets.dtype == lists.ray.dtype == lists.triangle.dtype == np.int64
    assert lists.t.dtype == dtype and lists.counts.dtype == np.int64
    crossings = scene.crossings(some_rays((5,), dtype))
    kinds = [crossings.count.dtype, crossings.signed_count.dtype, crossings.origin_on_surface.dtype]
    assert kinds == [np.uint32, np.int32, np.bool_]
    near = scene.nearest(np.zeros((2, 3), dtype))
    assert near.distance.dtype == near.point.dtype == dtype and near.feature.dtype == np.uint8


def test_columns():
    scene = pierce.Scene(*SQUARE)
    ray = [[0.5, 0.25, 2, 0, 0, -1], [9, 9, 9, 0, 0, 1]]
    hits = scene.closest_hit(ray, columns=("t", "points", "normals"))
    assert hits.t.tolist() == [2, np.inf]
    assert hits.points[0].tolist() == [0.5, 0.25, 0] and np.isnan(hits.points[1]).all()
    assert hits.normals[0].tolist() == [0, 0, 1] and np.isnan(hits.normals[1]).all()
    with pytest.raises(AttributeError, match="no column 'u' here; there are t, triangle"):
        hits.u
    lazy = scene.closest_hit(ray)
    assert np.array_equal(lazy.points, hits.points, equal_nan=True)
    assert np.array_equal(lazy.normals, hits.normals, equal_nan=True)
    assert np.array_equal(scene.closest_hit(ray, columns=["triangle"]).points, hits.points,
                          equal_nan=True)
    assert lazy.points is lazy.points
    filtered = scene.closest_hit(ray, columns=("points",), filter=lambda ray, hits: hits.t > 0)
    assert np.array_equal(filtered.points, hits.points, equal_nan=True)
    for wrong in ("t", ["t", "x"]):
        with pytest.raises(ValueError, match="give a list of some of t, u, v"):
            scene.closest_hit(ray, columns=wrong)


@both
@pytest.mark.parametrize("count", [0, 1, 7, 2048, 2049])
def test_few_and_many_answers_are_alike(dtype, count):
    """The columns of few answers lie in one piece of memory, and are made when they are asked for;
    those that are named lie apart, and so do those of many."""
    vertices, triangles = grid(12, dtype)
    scene = pierce.Scene([(vertices, triangles), (vertices + dtype(0.5), triangles)])
    rays = some_rays((count,), dtype)
    few, apart = scene.closest_hit(rays), scene.closest_hit(rays, columns=COLUMNS)
    assert_same(few, apart, (count,))
    assert few.hit.any() == (count > 0) and list(few._columns) == list(apart._columns)
    for name in COLUMNS:
        column = getattr(few, name)
        assert column is getattr(few, name) and column.dtype == getattr(apart, name).dtype
        assert column.flags.writeable and column.flags.aligned and column.flags.c_contiguous
    for copied in (pickle.loads(pickle.dumps(few)), copy.copy(few), copy.deepcopy(few)):
        assert_same(copied, apart, (count,))
    parts = scene.closest_hit(rays[:, :3], rays[:, 3:])
    assert_same(parts, apart, (count,))
    assert np.array_equal(few.points, scene.closest_hit(rays, columns=["points"]).points,
                          equal_nan=True)
    again = scene.closest_hit(rays, out=scene.closest_hit(rays[::-1]))
    assert_same(again, apart, (count,))
    lists = scene.all_hits(rays)
    assert np.array_equal(lists.counts, scene.count_hits(rays))
    first = lists[lists.offsets[:-1][lists.counts > 0]]
    for name in COLUMNS:
        assert np.array_equal(getattr(first, name), getattr(few, name)[few.hit])
    near, one = scene.nearest(rays[:, :3]), [scene.nearest(ray[:3]) for ray in rays[:9]]
    assert near.point.shape == (count, 3) and list(near._columns) == NEAREST
    for name in NEAREST:
        assert getattr(near, name).dtype == (dtype if name in "point distance u v w" else
                                             np.uint8 if name == "feature" else np.int64)
        for number, nearest in enumerate(one):
            assert np.array_equal(getattr(near, name)[number], getattr(nearest, name))


def test_hits_are_indexed_as_arrays():
    scene = pierce.Scene(*SQUARE)
    rays = some_rays((4, 5), np.float64)
    rays[..., 0:2] = np.linspace(-0.2, 1.1, 40).reshape(4, 5, 2)
    rays[..., 2:] = [1, 0, 0, -1]
    hits = scene.closest_hit(rays, columns=(*COLUMNS, "points"))
    assert 0 < hits.hit.sum() < 20
    for key in (hits.hit, 1, (2, 3), np.s_[..., ::2], np.s_[:, None], np.array([3, 0])):
        some = hits[key]
        for name in COLUMNS:
            assert np.array_equal(getattr(some, name), getattr(hits, name)[key])
        assert some.points.shape == (*some.shape, 3) == (*some.normals.shape[:-1], 3)
        again = scene.closest_hit(rays)[key]
        assert np.array_equal(again.points, some.points, equal_nan=True)
    assert [hit.shape for hit in hits] == [(5,)] * 4
    with pytest.raises(TypeError, match="attributes: hits.t"):
        hits["t"]
    with pytest.raises(IndexError):
        hits[7]


def test_interpolation():
    scene = pierce.Scene([SQUARE, (TETRAHEDRON[0] + [10, 0, 0], TETRAHEDRON[1])])
    hits = scene.closest_hit([[0.5, 0.25, 9], [11, 1, 9], [-5, 0, 9]], [0, 0, -1])
    colour = hits.interpolate([SQUARE[0], TETRAHEDRON[0] + [10, 0, 0]])
    assert np.allclose(colour, hits.points, equal_nan=True) and np.isnan(colour[2]).all()
    one = pierce.Scene(*SQUARE).closest_hit([0.5, 0.25, 9, 0, 0, -1])
    assert one.interpolate(np.array([0, 4, 8, 4])) == 3.0
    with pytest.raises(ValueError, match="give a list"):
        hits.interpolate(SQUARE[0])
    with pytest.raises(ValueError, match="there are 4 vertices"):
        one.interpolate(np.zeros(3))


def test_shown():
    pandas = pytest.importorskip("pandas")
    scene = pierce.Scene(*SQUARE)
    hits = scene.closest_hit(np.full((3, 5, 6), [0.5, 0.5, 1, 0, 0, -1]))
    frame = hits.to_dataframe()
    assert isinstance(frame, pandas.DataFrame) and list(frame) == list(COLUMNS)
    assert len(frame) == 15 and frame.t.tolist() == [1] * 15
    assert "ray" in scene.all_hits([0.5, 0.5, 1, 0, 0, -1]).to_dataframe()
    assert len(scene.nearest([[0, 0, 1]]).to_dataframe()) == 1


def test_repr():
    scene = pierce.Scene(*SQUARE)
    hits = scene.closest_hit(np.full((3, 5, 6), [0.5, 0.5, 1, 0, 0, -1]))
    assert repr(hits) == "Hits(shape=(3, 5), hit=15)"
    assert repr(scene.closest_hit([9, 9, 9, 0, 0, 1])) == "Hits(miss)"
    assert repr(scene.all_hits(hits.points, [0, 0, 1])) == "HitLists(rays=15, hits=30)"
    assert repr(scene.nearest([0, 0, 1])) == "Nearest(shape=(), found=1)"
    assert "<td>1</td>" in hits._repr_html_() and "15 in all" in hits._repr_html_()
    assert "<th>triangles</th><td>2</td>" in scene._repr_html_()


@pytest.mark.parametrize("dtype", [np.float32, np.float64])
@pytest.mark.parametrize("shape", [(), (7,), (0,), (20, 300)])
def test_out_is_filled_again(dtype, shape):
    scene = pierce.Scene(*grid(9, dtype))
    rays = np.random.default_rng(7).uniform(-1, 9, (2, *shape, 6)).astype(dtype)
    rays[..., 2:] = [5, 0, 0, -1]
    names = ("t", "u", "v", "w", "geometry", "triangle", "facing")
    for columns in (None, ("t", "triangle", "points")):
        for accept in (None, lambda ray, hits: hits.t < 4.8):
            hits = scene.closest_hit(rays[0], columns=columns)
            hits.points, hits.normals  # noqa: B018, so that old ones are there
            before = dict(hits._columns)
            expected = scene.closest_hit(rays[1], columns=columns, filter=accept)
            again = scene.closest_hit(rays[1], out=hits, filter=accept)
            assert again is hits and again.shape == shape
            for name in names if columns is None else columns:
                assert np.shares_memory(getattr(again, name), before[name]) or 0 in shape
                assert np.array_equal(getattr(again, name), getattr(expected, name), True)
            assert np.array_equal(again.points, expected.points, equal_nan=True)
            if columns is None:
                assert np.array_equal(again.normals, expected.normals, equal_nan=True)


def test_out_is_refused():
    scene = pierce.Scene(*grid(9))
    rays = np.full((6, 6), [2.5, 2.25, 5, 0, 0, -1])
    hits = scene.closest_hit(rays)
    frozen = scene.closest_hit(rays)
    frozen.u.flags.writeable = False
    own = scene.closest_hit(rays, columns=["points"])
    for error, words, arguments in [
            (TypeError, "out is dict", {"out": {}}),
            (TypeError, "out is HitLists", {"out": scene.all_hits(rays[:6])}),
            (ValueError, "out has its columns", {"out": hits, "columns": ["t"]}),
            (ValueError, r"out has the shape \(5,\), the rays \(6,\)", {"out": hits[:5]}),
            (ValueError, "out.u does not lie", {"out": frozen}),
            (TypeError, "out.t is float32", {"out": pierce.Scene(*grid(9, np.float32)).closest_hit(
                rays.astype(np.float32))})]:
        with pytest.raises(error, match=words):
            scene.closest_hit(rays, **arguments)
    with pytest.raises(ValueError, match="the rays are in out.points"):
        scene.closest_hit(own.points, [0, 0, 1], out=own)


def test_columns_by_name():
    """Whatever their order, whatever else there is."""
    scene = pierce.Scene(*SQUARE)
    rays = np.array([[0.5, 0.25, 1, 0, 0, -1], [5, 5, 1, 0, 0, -1]])
    names = ["ox", "oy", "oz", "dx", "dy", "dz"]
    records = np.zeros(2, [("id", int), *((name, float) for name in reversed(names))])
    for i, name in enumerate(names):
        records[name] = rays[:, i]
    expected = scene.closest_hit(rays)
    assert scene.closest_hit(records).t.tolist() == expected.t.tolist()
    points = np.zeros(2, [("Z", float), ("X", float), ("Y", float)])
    points["X"], points["Z"] = [0.5, 0.25], 2
    assert scene.nearest(points).point.tolist() == [[0.5, 0, 0], [0.25, 0, 0]]
    bounded = np.zeros(2, [*((name, float) for name in names), ("t_max", float)])
    for i, name in enumerate(names):
        bounded[name] = rays[:, i]
    for t_max, found in ((0.5, False), (1, True)):
        bounded["t_max"] = t_max
        assert scene.any_hit(bounded).tolist() == [found, False]
    pandas = pytest.importorskip("pandas")
    frame = pandas.DataFrame(rays, columns=names)
    for order in (names, names[::-1], ["dx", "ox", "dz", "oz", "dy", "oy"]):
        shown = frame[order].assign(name="a")
        assert scene.closest_hit(shown).t.tolist() == expected.t.tolist()
    assert scene.closest_hit(frame.set_axis(list("abcdef"), axis=1)).t.tolist() == \
        expected.t.tolist()
