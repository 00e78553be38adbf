# SPDX-License-Identifier: Apache-2.0
"""What is refused is refused by Python's own exceptions, which name the row and the cure."""

import copy
import pickle

import numpy as np
import pytest
from meshes import CUBE, SQUARE, TETRAHEDRON

import pierce

V, T = SQUARE
SCENE = pierce.Scene(V, T)
FLOAT = pierce.Scene(V.astype(np.float32), T)
RAYS = np.full((4, 6), [0.5, 0.5, 1, 0, 0, -1])


def refused(error, words, call, *args, **options):
    with pytest.raises(error, match=words or None) as caught:
        call(*args, **options)
    assert "\n" not in str(caught.value)
    return caught.value


def test_indices():
    for kind in (np.int8, np.int32, np.int64, np.uint32, np.uint64, np.int16):
        error = refused(IndexError, "triangle 1 .*vertex 4, but there are (only )?4",
                        pierce.Scene, V, np.array([[0, 1, 2], [0, 4, 3]], kind))
        assert type(error) is pierce.IndexOutOfRange and isinstance(error, IndexError)
        assert error.index == 1 and error.count == 1
    error = refused(pierce.IndexOutOfRange, "triangle 0 names vertex -1, but there are 4 vertices; "
                    "2 such triangles", pierce.Scene, V, [[0, 1, -1], [0, 1, 2], [0, -7, 2]])
    assert error.index == 0 and error.count == 2
    refused(IndexError, "names vertex 18446744073709551615", pierce.Scene, V,
            np.array([[0, 1, 2**64 - 1]], np.uint64))
    refused(IndexError, "9223372036854775807", pierce.Scene, V, [[0, 1, 2**63 - 1]])
    refused(IndexError, "4294967295", pierce.Scene, V, np.array([[0, 1, 2**32 - 1]], np.uint32))
    refused(IndexError, "0 vertices", pierce.Scene, np.zeros((0, 3)), [[0, 0, 0]])


def test_shapes_of_meshes():
    refused(ValueError, r"vertices have the shape \(4, 2\), not \(n, 3\)", pierce.Scene, V[:, :2],
            T)
    refused(ValueError, r"triangles have the shape \(1, 4\).*triangulate", pierce.Scene, V,
            [[0, 1, 2, 3]])
    refused(ValueError, r"\(12,\), not \(n, 3\): give vertices.reshape\(-1, 3\)", pierce.Scene,
            V.ravel(), T)
    refused(ValueError, r"\(3, 4\), not \(n, 3\): give vertices.T", pierce.Scene, V.T, T)
    refused(ValueError, r"\(3, 2\), not \(n, 3\): give triangles.T", pierce.Scene, V, T.T)
    counted = np.insert(T, 0, 3, axis=1)  # as VTK has them
    refused(ValueError, r"is no corner, give triangles\[:, 1:\]", pierce.Scene, V, counted)
    refused(ValueError, r"is no corner, give triangles.reshape\(-1, 4\)\[:, 1:\]", pierce.Scene, V,
            counted.ravel())
    refused(ValueError, "rows of different lengths", pierce.Scene, [[0, 0, 0], [1, 0]], T)
    refused(ValueError, r"shape \(4, 3\) is no mesh.*\(n, 3, 3\)", pierce.Scene, V)
    refused(TypeError, "float64; give integers: triangles.astype", pierce.Scene, V, T.astype(float))
    refused(TypeError, "NoneType is no mesh; give", pierce.Scene, None)
    refused(TypeError, "mesh 1: int is no mesh", pierce.Scene, [(V, T), 5])
    refused(TypeError, "vertices holds no numbers .object", pierce.Scene, V.astype(object), T)
    refused(TypeError, "vertices holds no numbers", pierce.Scene, V.astype(str), T)
    refused(TypeError, "vertices holds complex numbers", pierce.Scene, V.astype(complex), T)
    refused(TypeError, "triangles holds truth values", pierce.Scene, V, T.astype(bool))
    refused(ValueError, "2 numbers are masked", pierce.Scene,
            np.ma.array(V, mask=[[1, 1, 0]] + 3 * [[0, 0, 0]]), T)
    assert pierce.Scene(np.ma.array(V), T).dtype == np.float64


def test_vertices_that_are_no_numbers():
    bad = V.copy()
    bad[2, 1] = np.nan
    error = refused(pierce.NonFiniteVertex, "vertex 2", pierce.Scene, bad, T)
    assert isinstance(error, ValueError) and error.index == 0 and error.count == 2
    bad[2, 1] = 0
    unused = np.concatenate([bad, [[np.nan, 0, 0]]])
    assert pierce.Scene(unused, T).closest_hit([0.25, 0.1, 1, 0, 0, -1]).hit


def test_types_do_not_mix():
    refused(TypeError, "rays is float32, the scene float64: .*astype.np.float64. .exact",
            SCENE.closest_hit, RAYS.astype(np.float32))
    refused(TypeError, "rays is float64, the scene float32: .*astype.np.float32. .rounded",
            FLOAT.closest_hit, RAYS)
    refused(TypeError, "points is float64", FLOAT.locate, RAYS[:, :3])
    refused(TypeError, "directions is float32", SCENE.closest_hit, RAYS[:, :3],
            RAYS[:, 3:].astype(np.float32))
    refused(TypeError, "mesh 0: vertices is float64 and mesh 1: vertices is float32: give both",
            pierce.Scene, [(V, T), (V.astype(np.float32), T)])
    refused(TypeError, "longdouble|float128", pierce.Scene, V.astype(np.longdouble), T)
    refused(ValueError, r"0.1 is no float32; round it yourself, np.float32\(0.1\)",
            FLOAT.closest_hit, [[0.1, 0.5, 1, 0, 0, -1]])
    refused(ValueError, "16777217 is no float32", FLOAT.closest_hit, [[16777217, 0, 0, 0, 0, 1]])
    refused(ValueError, "9007199254740993 is no float64", SCENE.closest_hit,
            np.array([[2**53 + 1, 0, 0, 0, 0, 1]]))
    assert FLOAT.closest_hit([[0.25, 0.5, 1, 0, 0, -1]]).hit.all()
    assert FLOAT.closest_hit(RAYS.astype(np.float16)).hit.all()
    assert FLOAT.closest_hit(RAYS.astype(np.float32), t_max=np.float64(0.5)).hit.sum() == 0


def test_cures_that_help():
    wide = RAYS.astype(np.longdouble)
    error = refused(TypeError, r"give rays.astype\(np.float64\)", SCENE.closest_hit, wide)
    assert "float128" not in str(error).split("give")[1]
    error = refused(ValueError, "no float64", SCENE.closest_hit, [[2**64 - 1, 0, 0, 0, 0, 1]])
    assert "throughout" not in str(error)
    refused(ValueError, "9007199254740993 is no float64", SCENE.closest_hit,
            [[2**53 + 1, 0.5, 0, 0, 0, 1]])
    assert not SCENE.closest_hit([[2**60, 0.5, 0, 0, 0, 1e300]]).hit.any()
    refused(TypeError, "at most 64 bits", SCENE.closest_hit, [[2**70, 0, 0, 0, 0, 1]])
    records = np.zeros(2, [("ox", float), ("oy", float)])
    refused(TypeError, r"records \(ox, oy\); .*structured_to_unstructured", SCENE.closest_hit,
            records)
    refused(ValueError, "columns are 5; give a list", SCENE.closest_hit, RAYS, columns=5)
    refused(TypeError, "filter is 3; give a function", SCENE.closest_hit, RAYS, filter=3)
    refused(TypeError, "transforms are int; give a list", pierce.Scene(V, T).update, transforms=5)


def test_placed_meshes():
    shape = r"transform has the shape \(3, 3\), not \(4, 4\) or \(3, 4\)"
    refused(ValueError, "mesh 0: " + shape, pierce.Scene, [((V, T), np.eye(3))])
    refused(ValueError, shape, pierce.Scene(V, T).update, transforms=[np.eye(3)])
    refused(TypeError, "a tuple of meshes; give a list", pierce.Scene, ((V, T), (V, T)))
    tuples = (((0, 0, 0), (1, 0, 0), (0, 1, 0)), ((0, 1, 2),))  # not a mesh and a matrix
    assert repr(pierce.Scene(tuples)) == "Scene(float64, 1 triangles)"


def test_scene_files_are_no_meshes(tmp_path):
    SCENE.save(tmp_path / "square.pierce")
    refused(pierce.BadFile, "is a scene, not a mesh; pierce.open", pierce.Scene,
            tmp_path / "square.pierce")
    refused(pierce.BadFile, "is a folder", pierce.Scene, tmp_path)


def test_truth_and_copies_of_hits():
    assert SCENE.closest_hit(RAYS[0]) and not SCENE.closest_hit(RAYS[0] + 5)
    hits = SCENE.closest_hit(RAYS.reshape(2, 2, 6))
    refused(ValueError, "ambiguous", bool, hits)
    refused(ValueError, "ambiguous", bool, SCENE.all_hits(RAYS))
    for made in (copy.copy(hits), copy.deepcopy(hits)):
        assert type(made) is type(hits) and made.shape == (2, 2)
        assert np.array_equal(made.points, hits.points)
    deep = copy.deepcopy(hits)
    deep.t[0, 0] = 7
    assert hits.t[0, 0] == 1 and copy.copy(hits).t is hits.t
    lists = copy.deepcopy(SCENE.all_hits(RAYS))
    assert type(lists) is pierce.HitLists and lists.counts.tolist() == [2] * 4
    assert lists.of(3).points.tolist() == [[0.5, 0.5, 0]] * 2
    stranger = pickle.loads(pickle.dumps(hits))
    refused(RuntimeError, "through pickle; ask the scene for them here", SCENE.step, stranger)


def test_shapes_of_rays():
    refused(ValueError, r"rays has the shape \(4, 3\), not .* give origins and directions",
            SCENE.closest_hit, RAYS[:, :3])
    refused(ValueError, r"rays has the shape \(\)", SCENE.closest_hit, 3.0)
    refused(ValueError, r"origins has the shape \(4, 6\)", SCENE.closest_hit, RAYS, RAYS)
    refused(ValueError, r"go together: \(4,\) of origins, \(3,\) of dir", SCENE.closest_hit,
            RAYS[:, :3], RAYS[:3, 3:])
    refused(ValueError, r"go together: \(4,\) of rays, \(2,\) of t_max", SCENE.closest_hit, RAYS,
            t_max=[1, 2])
    refused(ValueError, "rays of eight columns have", SCENE.closest_hit,
            np.zeros((2, 8)), t_max=1)
    refused(TypeError, "rays holds no numbers", SCENE.closest_hit, [["a"] * 6])
    refused(TypeError, "rays holds no numbers", SCENE.closest_hit, None)
    refused(ValueError, "masked", SCENE.any_hit, np.ma.masked_equal(RAYS, 1.0))


@pytest.mark.parametrize("query", ["closest_hit", "any_hit", "all_hits", "count_hits", "crossings"])
def test_rays_that_are_none(query):
    ask = getattr(SCENE, query)
    rays = np.tile(RAYS, (1000, 1))
    rays[2500, 0] = np.nan
    rays[2600, 3:] = 0
    error = refused(pierce.InvalidRay, "ray 2500 ", ask, rays)
    assert isinstance(error, ValueError) and error.index == 2500 and error.count >= 1
    rays[2500, 0] = 0.5
    assert refused(pierce.InvalidRay, "2600", ask, rays).index == 2600
    answer = ask(rays, invalid="miss")
    if query == "closest_hit":
        assert not answer.hit[2600] and answer.hit.sum() == 3999
    refused(ValueError, "NaN|nan", ask, RAYS, t_min=np.nan)


def test_options():
    ask = SCENE.closest_hit
    refused(ValueError, "sides is 'left'; give one of 'both', 'front', 'back'", ask, RAYS,
            sides="left")
    refused(ValueError, "invalid is 'maybe'", ask, RAYS, invalid="maybe")
    refused(TypeError, "threads is 1.5", ask, RAYS, threads=1.5)
    refused(ValueError, "threads is -1", ask, RAYS, threads=-1)
    refused(TypeError, "progress is 'yes'", ask, RAYS, progress="yes")
    refused(ValueError, "mask: -1 at 0", ask, RAYS, mask=-1)
    refused(ValueError, "mask: 4294967296 at 1", ask, RAYS, mask=[1, 2**32, 1, 1])
    refused(ValueError, r"mask has the shape \(3,\), the rays \(4,\)", ask, RAYS, mask=[1, 1, 1])
    refused(TypeError, "mask is float64; give integers", ask, RAYS, mask=1.0)
    refused(ValueError, "max_hits is -1", SCENE.all_hits, RAYS, max_hits=-1)
    refused(ValueError, "triangle 2", ask, RAYS, skip=2)
    refused(ValueError, "geometry|triangle", ask, RAYS, skip=(1, 0))
    refused(IndexError, "skip.triangle: -2", ask, RAYS, skip=-2)
    refused(ValueError, "skip has the shape", ask, RAYS, skip=[0, 1])
    refused(ValueError, "after", ask, [9, 9, 9, 0, 0, 1], after=0)
    refused(TypeError, "max_hits", ask, RAYS, max_hits=1)
    refused(TypeError, "filter returned int64", ask, RAYS, filter=lambda ray, hits: hits.triangle)
    refused(TypeError, "filter returned bool of the shape", ask, RAYS, filter=lambda *_: True)
    refused(ZeroDivisionError, "", ask, RAYS, filter=lambda *_: 1 / 0)
    refused(ValueError, "quality is 'best'", pierce.Scene, V, T, quality="best")
    refused(ValueError, "2 masks for 1 geometries", pierce.Scene, V, T, masks=[1, 2])
    refused(ValueError, "side is 'left'", SCENE.next_origin, ask(RAYS), "left")
    refused(TypeError, "give the Hits of a query", SCENE.step, RAYS)
    refused(ValueError, "hits are of another scene", SCENE.step,
            FLOAT.closest_hit([0, 0, 1, 0, 0, 1]))


def test_points():
    solid = pierce.Scene(*TETRAHEDRON)
    error = refused(pierce.InvalidPoint, "point 1 ", solid.locate, [[0, 0, 0], [0, np.inf, 0]])
    assert isinstance(error, ValueError) and error.index == 1
    refused(pierce.InvalidPoint, "point 0", solid.nearest, [np.nan, 0, 0])
    refused(ValueError, r"points has the shape \(2,\)", solid.locate, [1, 2])
    refused(ValueError, "radius", solid.nearest, [0, 0, 0], -1)
    refused(ValueError, "radius has the shape", solid.nearest, [[0, 0, 0]], [1, 2, 3])
    refused(ValueError, "radius", solid.nearest, [[0, 0, 0]], [np.nan])
    refused(ValueError, "rule is 'even'", solid.locate, [0, 0, 0], rule="even")
    for call in (SCENE.locate, SCENE.signed_distance):
        error = refused(pierce.NotClosed, "edge", call, [[0, 0, 0]])
        assert isinstance(error, ValueError)
        call([[0, 0, 1]], open_mesh=True)
    for wrong in ("x", b"1", None, [1e-3], [[1]], True, 1j):
        refused(TypeError, "^tolerance (is|has|holds) .*give", SCENE.winding_number, [0, 0, 1],
                wrong)
    for right in (1, np.float32(0.5), np.array(1e-3), 1e-9):
        assert SCENE.winding_number([0, 0, 1], right)[0].shape == ()


def test_grids():
    solid = pierce.Scene(*TETRAHEDRON)
    refused(ValueError, "shape", solid.voxelise, [0, 0, 0], 1, 5)
    refused(ValueError, "shape is 2097153", solid.voxelise, [0, 0, 0], 1, (2**21 + 1, 1, 1))
    refused(ValueError, "origin and spacing", solid.voxelise, [0, 0], 1, (1, 1, 1))
    refused(ValueError, "spacing", solid.voxelise, [0, 0, 0], [1, 0, 1], (1, 1, 1))
    refused(TypeError, "shape is 1.5", solid.voxelise, [0, 0, 0], 1, (1.5, 1, 1))
    for deep in (2**20, 2**21):
        refused(MemoryError, f"grid of 2097152 x 2097152 x {deep} cells takes .*; ask for fewer",
                solid.voxelise, [0, 0, 0], 1, (2**21, 2**21, deep))
    assert solid.voxelise([0, 0, 0], 1, (0, 5, 5)).shape == (0, 5, 5)


def test_files(tmp_path):
    refused(FileNotFoundError, "no such mesh file", pierce.Scene, tmp_path / "none.ply")
    bad = tmp_path / "bad.ply"
    bad.write_text("ply\nnonsense\n")
    error = refused(pierce.BadFile, "bad.ply", pierce.Scene, str(bad))
    assert isinstance(error, ValueError)
    refused(pierce.BadFile, "", pierce.Scene, tmp_path)
    strange = tmp_path / "x.step"
    strange.write_text("ISO-10303-21;")
    refused(pierce.BadFile, "neither PLY, STL, OBJ, OFF nor glTF", pierce.Scene, strange)


def test_transforms():
    matrix = np.eye(4)
    matrix[3, 0] = 1
    refused(ValueError, r"last row is \[1.0, 0.0, 0.0, 1.0\]", pierce.Scene, ((V, T), matrix))
    refused(ValueError, "finite|transform", pierce.Scene, ((V, T), np.full((3, 4), np.nan)))
    refused(TypeError, "0.1 is no float32", pierce.Scene,
            ((V.astype(np.float32), T), np.eye(4) * [[0.1], [1], [1], [1]]))
    refused(TypeError, "cannot be placed once more", pierce.Scene,
            (((V, T), np.eye(4)), np.eye(4)))


def test_updates():
    scene = pierce.Scene(V, T)
    refused(ValueError, r"vertices have the shape \(3, 3\)", scene.update, V[:3])
    refused(TypeError, "float32", scene.update, V.astype(np.float32))
    bad = V.copy()
    bad[0] = np.inf
    refused(pierce.NonFiniteVertex, "vertex 0", scene.update, bad)
    assert scene.closest_hit(RAYS).t.tolist() == [1] * 4  # as it was
    hits = scene.closest_hit(RAYS)
    scene.update(V + [0, 0, 0.5])
    refused(RuntimeError, "points: the scene was updated since", lambda: hits.points)
    refused(RuntimeError, "step: the scene was updated since", scene.step, hits)
    refused(ValueError, "2 transforms for 1", scene.update, transforms=[np.eye(4)] * 2)
    for one in ([V + 2], (V + 2,), [(V + 2).tolist()]):
        scene.update(V)
        scene.update(one)
        assert np.array_equal(scene.geometries[0][0], V + 2)
    refused(ValueError, r"have the shape \(2, 4, 3\)", scene.update, [V, V])
    pierce.Scene([[0, 0, 0]], []).update([[1, 1, 1]])  # one vertex


def test_empty():
    for scene in (pierce.Scene([]), pierce.Scene(np.zeros((0, 3)), []), pierce.Scene([[]], [])):
        assert scene.dtype == np.float64 and not scene.any_hit(RAYS).any()
        assert scene.locate([0, 0, 0]) == -1 and scene.signed_distance([0, 0, 0]) == np.inf
        near = scene.nearest([[0, 0, 0]])
        assert not near.found.any() and np.isnan(near.point).all() and near.triangle[0] == -1
        assert scene.info()["triangles"] == 0
        assert len(scene.all_hits(RAYS)) == 0
    assert SCENE.closest_hit(np.zeros((0, 6))).points.shape == (0, 3)
    assert SCENE.all_hits(np.zeros((0, 6))).offsets.tolist() == [0]
    assert SCENE.step(SCENE.closest_hit(np.zeros((0, 6)))).shape == (0,)
    assert pierce.Scene(*CUBE).locate(np.zeros((0, 3))).shape == (0,)


def test_errors_can_be_pickled():
    with pytest.raises(pierce.InvalidRay) as caught:
        SCENE.any_hit(np.zeros(6))
    again = pickle.loads(pickle.dumps(caught.value))
    assert type(again) is pierce.InvalidRay and str(again) == str(caught.value)
    assert again.index == 0 and again.count == 1


def test_environment(monkeypatch):
    monkeypatch.setenv("PIERCE_KERNEL", "abacus")
    refused(pierce.UnknownKernel, "abacus", pierce.Scene, V, T)


def test_words_that_are_nearly_right():
    refused(ValueError, "sides is 'Front'; give one of .*; did you mean 'front'", SCENE.closest_hit,
            RAYS, sides="Front")
    refused(ValueError, "rule is 'non-zero'; .* did you mean 'nonzero'", SCENE.locate, [0, 0, 0],
            rule="non-zero")
    hits = SCENE.closest_hit(RAYS)
    refused(AttributeError, "no column 'normal' here; .* did you mean 'normals'", getattr, hits,
            "normal")
    refused(AttributeError, "no column 'point' here; .* did you mean 'points'", getattr, hits,
            "point")
    refused(ValueError, r"not \(..., 3\); give points.T", SCENE.locate, np.zeros((3, 5)))
    refused(ValueError, r"give rays.T", SCENE.closest_hit, RAYS.T)
    refused(ValueError, r"give rays\[..., 0, :\], rays\[..., 1, :\]", SCENE.closest_hit,
            RAYS.reshape(4, 2, 3))


def test_open_meshes_name_the_arguments():
    lid = pierce.Scene(V, T)
    for ask in (lid.locate, lid.signed_distance):
        error = refused(pierce.NotClosed, "go on regardless with open_mesh=True or rule='winding'$",
                        ask, [0.5, 0.5, 0.5])
        assert str(pickle.loads(pickle.dumps(error))) == str(error)
        assert ask([0.5, 0.5, 0.5], open_mesh=True).shape == ()
