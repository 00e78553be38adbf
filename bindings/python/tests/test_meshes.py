# SPDX-License-Identifier: Apache-2.0
"""Scenes from everything that meshes come in."""

import copy
import os
import pickle
import struct
import warnings
from types import SimpleNamespace as Thing

import numpy as np
import pytest
from meshes import CUBE, SQUARE, TETRAHEDRON, grid, sheets

import pierce

V, T = SQUARE
DOWN = np.array([[0.5, 0.25, 9, 0, 0, -1], [7, 7, 9, 0, 0, -1]])


class Manifold:
    """What a manifold3d.Manifold offers."""

    def status(self):
        return 0

    def to_mesh(self):
        properties = np.zeros((4, 5), np.float32)
        properties[:, :3] = V
        return Thing(vert_properties=properties, tri_verts=T.astype(np.int32))


class Tensor:
    """What an open3d.core.Tensor offers."""

    def __init__(self, array):
        self.array = array

    def numpy(self):
        return self.array


FORMS = {
    "two arrays in a tuple": (V, T),
    "lists": (V.tolist(), T.tolist()),
    "corners": V[T],
    "trimesh": Thing(vertices=V, faces=T.astype(np.int64)),
    "pyvista": Thing(points=V.astype(np.float32), regular_faces=T.astype(np.int64)),
    "pyvista's strips": Thing(points=V.astype(np.float32), faces=np.zeros(0, np.int64),
                              strips=np.array([3, 0, 1, 2, 3, 0, 2, 3])),
    "pyvista's faces and strips": Thing(points=V.astype(np.float32), faces=np.array([3, 0, 1, 2]),
                                        strips=np.array([3, 0, 2, 3]), n_cells=7),
    "open3d": Thing(vertices=list(map(tuple, V)), triangles=T.astype(np.int32)),
    "open3d tensors": Thing(vertex=Thing(positions=Tensor(V.astype(np.float32))),
                            triangle=Thing(indices=Tensor(T.astype(np.int64)))),
    "manifold3d": Manifold(),
    "manifold3d mesh": Manifold().to_mesh(),
    "a list of one": [(V, T)],
    "placed": ((V, T), np.eye(4)),
    "placed by lists": ((V, T), [[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0]]),
}
FLOATS = ("pyvista", "pyvista's strips", "pyvista's faces and strips", "open3d tensors",
          "manifold3d", "manifold3d mesh")


@pytest.mark.parametrize("name", FORMS)
def test_forms(name):
    scene = pierce.Scene(FORMS[name])
    assert scene.dtype == (np.float32 if name in FLOATS else np.float64)
    hits = scene.closest_hit(DOWN.astype(scene.dtype))
    assert hits.t.tolist() == [9, np.inf] and hits.triangle.tolist() == [0, -1]
    assert scene.info()["triangles"] == 2


def test_what_vtk_holds_beside_triangles():
    def poly(faces=(), strips=(), cells=1):
        return Thing(points=V, faces=np.array(faces, int), strips=np.array(strips, int),
                     n_cells=cells)

    with pytest.raises(ValueError, match="holds no triangle: its 1 cells are vertices or lines"):
        pierce.Scene(poly())
    with pytest.raises(ValueError, match=r"mesh 1: .* faces that are no triangles; .*triangulate"):
        pierce.Scene([(V, T), poly([4, 0, 1, 2, 3])])
    with pytest.raises(ValueError, match="faces that are no triangles"):
        pierce.Scene(poly([3, 0, 1, 2, 4, 0, 1, 2, 3]))
    assert not len(pierce.Scene(poly(cells=0)).geometries[0][1])  # as of arrays and of trimesh
    strip = pierce.Scene(poly(strips=[6, 0, 1, 3, 2, 0, 1]))
    assert strip.geometries[0][1].tolist() == [[0, 1, 3], [3, 1, 2], [3, 2, 0], [0, 2, 1]]


def test_subclasses_are_copied_as_they_are(tmp_path):
    scene = Named(V, T, "a square")
    scene.note = [1]
    scene.save(tmp_path / "square.pierce")
    stored = pierce.open(tmp_path / "square.pierce")
    stored.note = [1]
    for one in (scene, stored):
        for again in (copy.copy(one), copy.deepcopy(one), pickle.loads(pickle.dumps(one))):
            assert type(again) is type(one) and again.note == [1] and again is not one
            assert again.closest_hit(DOWN).t.tolist() == [9, np.inf]
            assert getattr(again, "name", None) == getattr(one, "name", None)


class Named(pierce.Scene):
    def __init__(self, vertices, triangles, name):
        super().__init__(vertices, triangles)
        self.name = name


def test_packages():
    """The real ones, as far as they are installed."""
    boxes = []
    try:
        import trimesh
        boxes.append(trimesh.creation.box())
    except ImportError:
        pass
    try:
        import open3d
        boxes.append(open3d.geometry.TriangleMesh.create_box().translate([-0.5, -0.5, -0.5]))
        boxes.append(open3d.t.geometry.TriangleMesh.create_box().translate([-0.5, -0.5, -0.5]))
    except ImportError:
        pass
    try:
        import pyvista
        boxes.append(pyvista.Cube().triangulate())
    except ImportError:
        pass
    try:
        import manifold3d
        boxes.append(manifold3d.Manifold.cube([1, 1, 1], True))
    except ImportError:
        pass
    if not boxes:
        pytest.skip("none of them is installed")
    for box in boxes:
        scene = pierce.Scene(box)
        assert scene.locate(np.zeros((1, 3), scene.dtype)).tolist() == [1]
        ray = np.array([0.1, 0.2, 2, 0, 0, -1], scene.dtype)
        assert scene.all_hits(ray).t.tolist() == [1.5, 2.5]


def test_files(tmp_path):
    path = tmp_path / "square \u00e9.off"
    corners = "\n".join(f"{x} {y} {z}" for x, y, z in V)
    path.write_text(f"OFF\n4 2 0\n{corners}\n3 0 1 2\n3 0 2 3\n")
    for given in (path, str(path), os.fsencode(path)):
        scene = pierce.Scene(given)
        assert scene.closest_hit(DOWN).t[0] == 9 and scene.dtype == np.float64
    assert np.array_equal(scene.geometries[0][0], V) and np.array_equal(scene.geometries[0][1], T)
    stl = tmp_path / "square.stl"
    record = np.zeros(2, [("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("more", "<u2")])
    record["corners"] = V[T]
    stl.write_bytes(bytes(80) + np.uint32(2).tobytes() + record.tobytes())
    assert pierce.Scene(stl).dtype == np.float32
    two = pierce.Scene([path, (path, np.eye(4) * 2 - np.diag([0, 0, 0, 1]))])
    assert two.all_hits(DOWN[0]).geometry.tolist() == [0, 1]
    up = np.eye(4)
    up[2, 3] = 0.1  # no float32
    for other, t in ((path, 9), ((V, T), 9), ((path, up), 8.9)):  # files of float32 are widened
        mixed = pierce.Scene([stl, (stl, np.eye(4)), other])
        assert mixed.dtype == np.float64 and mixed.closest_hit(DOWN).t[0] == t
    with pytest.raises(TypeError, match="mesh 0: vertices is float32 and mesh 1: .* is float64"):
        pierce.Scene([(np.float32(V), T), path])  # but not what the caller has chosen


def test_placed():
    up = np.eye(4)
    up[2, 3] = 3
    mesh = (V, T)
    over = np.array([[0, 1, 0, 0], [1, 0, 0, 0], [0, 0, 1, -3]])
    scene = pierce.Scene([mesh, (mesh, up), (Thing(vertices=V, faces=T), over)])
    hits = scene.all_hits(DOWN[0])
    assert hits.geometry.tolist() == [1, 0, 2] and hits.t.tolist() == [6, 9, 12]
    assert hits.facing.tolist() == [0, 0, 1]
    assert repr(scene) == "Scene(float64, 3 geometries, 6 triangles)"
    assert len({id(v) for v, _ in scene.geometries[:2]}) == 1
    scene.update(transforms=[up, np.eye(4), np.eye(4)])
    assert scene.closest_hit(DOWN[0]).geometry == 0


def test_masks_hide_geometries():
    scene = pierce.Scene([(V, T), (V + [0, 0, 1], T)], masks=[1, 2])
    assert scene.closest_hit(DOWN[0], mask=1).geometry == 0
    assert scene.closest_hit(DOWN[0]).geometry == 1
    rays = np.repeat(DOWN[:1], 3, axis=0)
    assert scene.closest_hit(rays, mask=[1, 2, 4]).geometry.tolist() == [0, 1, -1]
    assert scene.count_hits(rays, mask=[1, 3, 0]).tolist() == [1, 2, 0]
    again = pickle.loads(pickle.dumps(scene))
    assert again.closest_hit(DOWN[0], mask=1).geometry == 0


@pytest.mark.parametrize("quality", ["fast", "balanced", "high", "compact"])
@pytest.mark.parametrize("dtype", [np.float32, np.float64])
def test_qualities_and_threads(quality, dtype):
    vertices, triangles = grid(20, dtype)
    rays = np.zeros((5000, 6), dtype)
    rays[:, :2] = np.random.default_rng(3).integers(0, 161, (5000, 2)) / 8
    rays[:, 2:] = [5, 0, 0, -1]
    told = []
    scene = pierce.Scene(vertices, triangles, quality=quality, threads=2, progress=told.append)
    expected = pierce.Scene(vertices, triangles, threads=1).closest_hit(rays, threads=1)
    got = scene.closest_hit(rays, threads=2, progress=told.append)
    assert got.hit.all() and np.array_equal(got.triangle, expected.triangle)
    assert np.array_equal(got.t, expected.t)
    assert told and all(0 <= x <= 1 for x in told) and told[-1] == 1


def test_progress_is_shown(capfd):
    vertices, triangles = grid(60)
    scene = pierce.Scene(vertices, triangles, progress=True)
    scene.any_hit(DOWN[0], progress=True)
    shown = capfd.readouterr().err
    assert "100 %" in shown and shown.endswith("\n")


def test_arrays_are_copied_or_not():
    vertices, triangles = V.copy(), T.copy()
    scene = pierce.Scene(vertices, triangles)
    vertices += 5
    assert scene.closest_hit(DOWN[0]).hit and scene.geometries[0][0] is not vertices
    vertices -= 5
    viewed = pierce.Scene(vertices, triangles, copy=False)
    assert np.shares_memory(viewed.geometries[0][0], vertices)
    assert np.shares_memory(viewed.geometries[0][1], triangles)
    with pytest.raises(ValueError, match="read-only"):
        scene.geometries[0][0][0] = 1


@pytest.mark.parametrize("dtype", [np.float32, np.float64])
def test_update(dtype):
    vertices, triangles = grid(8, dtype)
    rays = np.zeros((300, 6), dtype)
    rays[:, :2] = np.random.default_rng(5).integers(0, 33, (300, 2)) / 4
    rays[:, 2:] = [5, 0, 0, -1]
    scene = pierce.Scene(vertices, triangles)
    moved = (vertices[::-1] * dtype(0.5)).copy()
    scene.update(moved)
    expected = pierce.Scene(moved, triangles)
    for query in ("closest_hit", "all_hits"):
        got, want = getattr(scene, query)(rays), getattr(expected, query)(rays)
        for name in ("t", "u", "v", "w", "triangle", "facing"):
            assert np.array_equal(getattr(got, name), getattr(want, name))
    scene.update()
    assert np.array_equal(scene.geometries[0][0], moved)
    two = pierce.Scene([(V, T), (V, T)])
    two.update([V, V + 1])
    assert two.closest_hit(DOWN[0]).geometry == 0


@pytest.mark.parametrize("again", [copy.copy, copy.deepcopy,
                                   lambda x: pickle.loads(pickle.dumps(x))])
def test_copies(again):
    up = np.eye(4)
    up[2, 3] = 1
    scene = pierce.Scene([CUBE, (TETRAHEDRON, up)], quality="high", masks=[1, 3])
    other = again(scene)
    rays = np.random.default_rng(1).integers(-3, 4, (50, 6)).astype(float)
    rays[:, 5] += 9
    hits = scene.closest_hit(rays)
    assert np.array_equal(other.closest_hit(rays).t, hits.t) and hits.hit.any()
    other.update([CUBE[0] + 50, TETRAHEDRON[0] + 50])
    assert np.array_equal(scene.closest_hit(rays).t, hits.t)
    kept = again(hits)
    assert np.array_equal(kept.t, hits.t) and np.array_equal(kept[3:].triangle, hits.triangle[3:])
    lists = scene.all_hits(rays)
    assert np.array_equal(again(lists).of(3).t, lists.of(3).t)


def test_hits_come_through_pickle_without_their_scene():
    hits = pierce.Scene(*SQUARE).closest_hit(DOWN, columns=("t", "points"))
    kept = pickle.loads(pickle.dumps(hits))
    assert np.array_equal(kept.points, hits.points, equal_nan=True) and kept.hit.sum() == 1
    with pytest.raises(RuntimeError, match="without their scene"):
        kept.normals


def test_filters_step_in_exact_order():
    vertices, triangles = sheets(6)
    scene = pierce.Scene(vertices, triangles)
    rays = np.array([[0.5, 0.5, 9, 0, 0, -1], [0.5, 0.25, 9, 0, 0, -1], [3, 3, 9, 0, 0, -1]])
    seen = []

    def even_sheet(ray, hits):
        seen.extend(zip(ray.tolist(), hits.triangle.tolist()))
        return hits.triangle // 2 % 2 == 0

    hits = scene.closest_hit(rays, filter=even_sheet)
    assert hits.triangle.tolist() == [8, 8, -1] and hits.t.tolist() == [5, 5, np.inf]
    assert [x for ray, x in seen if ray == 0] == [10, 11, 8]
    assert [x for ray, x in seen if ray == 1] == [10, 8]
    lists = scene.all_hits(rays, filter=even_sheet, distinct=True, max_hits=2)
    assert lists.triangle.tolist() == [8, 4, 8, 4] and lists.offsets.tolist() == [0, 2, 4, 4]
    assert scene.count_hits(rays, filter=even_sheet).tolist() == [6, 3, 0]
    assert scene.any_hit(rays, filter=lambda ray, hits: hits.points[:, 2] < 1).tolist() == [
        True, True, False]


@pytest.mark.parametrize("dtype", [np.float32, np.float64])
def test_meshes_without_vertices_take_any_type(dtype):
    nothing = (np.zeros((0, 3), dtype), np.zeros((0, 3), np.uint32))
    assert pierce.Scene(*nothing).dtype == dtype
    for other in (np.float32, np.float64):
        scene = pierce.Scene([nothing, (SQUARE[0].astype(other), SQUARE[1])])
        assert scene.dtype == other
        assert scene.closest_hit(np.array([[0.5, 0.25, 1, 0, 0, -1]], other)).geometry == 1


def stl_with_a_tail(path):
    facet = struct.pack("<12fH", 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0)
    path.write_bytes(bytes(80) + struct.pack("<I", 1) + facet + b"7 bytes")
    return path


def test_what_readers_remark_upon_is_a_warning(tmp_path):
    path = stl_with_a_tail(tmp_path / "tail.stl")
    with pytest.warns(pierce.MeshWarning) as caught:
        scene = pierce.Scene(path)
    assert len(scene.geometries[0][1]) == 1
    assert len(caught) == 1 and caught[0].filename == __file__
    line = str(caught[0].message)
    assert line.startswith(f"{path}: ") and "7 bytes" in line and "\n" not in line
    with pytest.warns(pierce.MeshWarning, match="mesh 1: "):
        pierce.Scene([(np.float32(V), T), (path, np.eye(4))])


def test_strict_refuses_what_readers_remark_upon(tmp_path):
    path = stl_with_a_tail(tmp_path / "tail.stl")
    for mesh in (path, [path], [(path, np.eye(4))]):
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            with pytest.raises(pierce.BadFile, match="7 bytes .*strict=True"):
                pierce.Scene(mesh, strict=True)
    path.write_bytes(path.read_bytes()[:-7])
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        pierce.Scene(path, strict=True)
