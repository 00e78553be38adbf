# SPDX-License-Identifier: Apache-2.0
"""pierce.open3d: what Open3D's RaycastingScene promises, exactly; with Open3D and without."""

import importlib.util
import pickle
from fractions import Fraction

import numpy as np
import oracle
import pytest
from meshes import CUBE, SQUARE, TETRAHEDRON, grid

import pierce
from pierce import open3d

HAVE = importlib.util.find_spec("open3d") is not None
INVALID = open3d.RaycastingScene.INVALID_ID


@pytest.fixture(params=["arrays", "tensors"], autouse=True)
def kind(request, monkeypatch):
    """Each test runs as if Open3D were not there, and with it where it is."""
    if request.param == "arrays":
        monkeypatch.setattr(open3d, "installed", lambda name: None)
    elif not HAVE:
        pytest.skip("Open3D is not installed")
    return request.param


def f4(values):
    return np.array(values, np.float32)


def scene_of(*meshes):
    scene = open3d.RaycastingScene()
    for number, (vertices, triangles) in enumerate(meshes):
        assert scene.add_triangles(f4(vertices), triangles.astype(np.uint32)) == number
    return scene


def moved(mesh, by):
    return mesh[0] + np.array(by, float), mesh[1]


def numbers(answer):
    return {name: value.numpy() for name, value in answer.items()}


def test_cast_rays():
    rays = f4([[[0.25, 0.5, 3, 0, 0, -2], [9, 9, 9, 1, 0, 0]]])
    found = numbers(scene_of(SQUARE, moved(SQUARE, (0, 0, 1))).cast_rays(rays))
    assert {k: (v.dtype.str[1:], v.shape) for k, v in found.items()} == {
        "t_hit": ("f4", (1, 2)), "geometry_ids": ("u4", (1, 2)), "primitive_ids": ("u4", (1, 2)),
        "primitive_uvs": ("f4", (1, 2, 2)), "primitive_normals": ("f4", (1, 2, 3))}
    assert found["t_hit"].tolist() == [[1, np.inf]]
    assert found["geometry_ids"].tolist() == [[1, INVALID]]
    assert found["primitive_ids"].tolist() == [[1, INVALID]]
    assert found["primitive_uvs"].tolist() == [[[0.25, 0.25], [0, 0]]]
    assert found["primitive_normals"].tolist() == [[[0, 0, 1], [0, 0, 0]]]


def test_every_number_is_the_exact_one():
    vertices, triangles = grid(5)
    random = np.random.default_rng(3)
    rays = np.concatenate([random.uniform(0, 5, (40, 2)), np.full((40, 1), 4.0),
                           random.uniform(-0.3, 0.3, (40, 2)), np.full((40, 1), -1.7)], axis=1)
    rays = rays.astype(np.float32)
    found = numbers(scene_of((vertices, triangles)).cast_rays(rays))
    for i, ray in enumerate(rays):
        hits = oracle.all_hits(f4(vertices), triangles, [*ray, 0, np.inf])
        assert (found["primitive_ids"][i] == INVALID) == (not hits)
        if hits:
            assert found["t_hit"][i] == oracle.rounded(hits[0].t, np.float32)
            assert found["primitive_ids"][i] == hits[0].triangle
            assert found["primitive_uvs"][i].tolist() == [
                oracle.rounded(hits[0].u, np.float32), oracle.rounded(hits[0].v, np.float32)]


def test_bad_rays_miss_and_an_empty_scene_answers():
    rays = f4([[0.5, 0.2, 1, 0, 0, 0], [np.nan, 0, 1, 0, 0, -1], [0.5, 0.2, 1, 0, np.inf, -1]])
    for scene in (scene_of(SQUARE), open3d.RaycastingScene()):
        assert numbers(scene.cast_rays(rays))["t_hit"].tolist() == [np.inf] * 3
        assert not scene.test_occlusions(rays).numpy().any()
        assert scene.count_intersections(rays).numpy().tolist() == [0, 0, 0]
        assert numbers(scene.list_intersections(rays))["ray_splits"].tolist() == [0, 0, 0, 0]
    nothing = f4(np.zeros((0, 6)))
    assert numbers(scene_of(SQUARE).list_intersections(nothing))["ray_splits"].tolist() == [0]
    assert scene_of(SQUARE).count_intersections(nothing).numpy().shape == (0,)


def test_the_ends_of_a_range_belong_to_it():
    scene, rays = scene_of(SQUARE), f4([[0.5, 0.2, 1, 0, 0, -1]])
    for tnear, tfar, hit in ((0, np.inf, True), (1, 1, True), (0, 1, True), (1.5, 9, False),
                             (0, 0.99999994, False), (0.1, 0.3, False)):
        assert scene.test_occlusions(rays, tnear=tnear, tfar=tfar).numpy().tolist() == [hit]


def test_one_row_for_each_geometry_and_each_exact_t():
    # Through the diagonals of two faces of each cube, of which two faces are at one t.
    scene = scene_of(CUBE, moved(CUBE, (0, 0, 2)))
    rays = f4([[1, 1, -1, 0, 0, 1], [1, 1, 1, 0, 0, 2], [7, 7, 7, 1, 0, 0]])
    assert scene.count_intersections(rays).numpy().tolist() == [4, 3, 0]
    found = numbers(scene.list_intersections(rays))
    assert found["ray_splits"].tolist() == [0, 4, 7, 7]
    assert found["ray_ids"].tolist() == [0] * 4 + [1] * 3
    assert found["t_hit"].tolist() == [1, 3, 3, 5, 0.5, 0.5, 1.5]
    assert found["geometry_ids"].tolist() == [0, 0, 1, 1, 0, 1, 1]
    assert found["ray_splits"].dtype == found["primitive_ids"].dtype == np.uint32
    assert found["primitive_uvs"].shape == (7, 2)


def test_t_that_round_to_one_number_are_two_rows():
    near = np.float32(1) + np.float32(2**-23)
    planes = [(np.array([[0, 0, z], [1, 0, z], [0, 1, z]]), np.array([[0, 1, 2]]))
              for z in (1.0, float(near))]
    one = (np.concatenate([p[0] for p in planes]), np.array([[0, 1, 2], [3, 4, 5]]))
    rays = f4([[0.25, 0.25, -2**25, 0, 0, 1]])
    for scene in (scene_of(one), scene_of(*planes), scene_of(one, planes[0])):
        t = numbers(scene.list_intersections(rays))["t_hit"]
        assert np.unique(t).tolist() == [2.0**25]
        assert scene.count_intersections(rays).numpy().tolist() == [len(t)]
    assert len(t) == 3  # of the last: geometry 0 twice, geometry 1 once


def test_lists_agree_with_brute_force():
    random = np.random.default_rng(5)
    meshes = [(random.integers(-2, 3, (9, 3)).astype(float), random.integers(0, 9, (12, 3)))
              for _ in range(3)]
    rays = random.integers(-2, 3, (60, 6)).astype(np.float32)
    rays[np.all(rays[:, 3:] == 0, axis=1), 5] = 1
    found = numbers(scene_of(*meshes).list_intersections(rays))
    for i, ray in enumerate(rays):
        rows = slice(found["ray_splits"][i], found["ray_splits"][i + 1])
        expected = {(hit.t, g) for g, (vertices, triangles) in enumerate(meshes)
                    for hit in oracle.all_hits(vertices, triangles, [*ray, 0, np.inf])}
        mine = list(zip(found["t_hit"][rows].tolist(), found["geometry_ids"][rows].tolist()))
        assert mine == [(oracle.rounded(t, np.float32), g) for t, g in sorted(expected)]
    counts = scene_of(*meshes).count_intersections(rays).numpy()
    assert counts.tolist() == np.diff(found["ray_splits"].astype(np.int64)).tolist()


def test_points():
    scene = scene_of(moved(TETRAHEDRON, (0, 0, 0)), moved(CUBE, (10, 0, 0)))
    points = f4([[[1, 1, 0.5], [11, 1, 1.75]], [[0, 0, -3], [np.nan, 0, 0]]])
    near = numbers(scene.compute_closest_points(points))
    assert near["points"][:, :, 2].tolist()[0] == [0, 2]
    assert near["geometry_ids"].tolist() == [[0, 1], [0, INVALID]]
    assert near["primitive_ids"][1, 1] == INVALID and np.isnan(near["points"][1, 1]).all()
    assert near["primitive_normals"].tolist()[0] == [[0, 0, -1], [0, 0, 1]]
    assert near["primitive_uvs"].shape == (2, 2, 2)
    assert scene.compute_distance(points).numpy()[0].tolist() == [0.5, 0.25]
    signed = scene.compute_signed_distance(points).numpy()
    assert signed.dtype == np.float32 and signed[:, 0].tolist() == [-0.5, 3]
    assert np.isnan(signed[1, 1])
    inside = scene.compute_occupancy(points, nsamples=3).numpy()
    assert inside.dtype == np.float32 and inside.tolist() == [[1, 1], [0, 0]]
    surface = f4([[1, 1, 0], [0, 0, 0]])
    assert scene.compute_occupancy(surface).numpy().tolist() == [1, 1]
    assert scene.compute_signed_distance(surface).numpy().tolist() == [0, 0]


def test_points_on_a_sphere_of_edges_are_inside_exactly():
    """Rays along (1, 1, 1) from a grid meet edges and vertices; the answer is that of a sum."""
    octahedron = (f4([[1, 0, 0], [-1, 0, 0], [0, 1, 0], [0, -1, 0], [0, 0, 1], [0, 0, -1]]),
                  np.array([[0, 2, 4], [2, 1, 4], [1, 3, 4], [3, 0, 4], [2, 0, 5], [1, 2, 5],
                            [3, 1, 5], [0, 3, 5]], np.uint32))
    axis = np.linspace(-1.25, 1.25, 11, dtype=np.float32)
    points = np.stack(np.meshgrid(axis, axis, axis), axis=-1)
    truth = [sum(abs(Fraction(float(c))) for c in p) <= 1 for p in points.reshape(-1, 3)]
    inside = scene_of(octahedron).compute_occupancy(points).numpy()
    assert inside.shape == (11, 11, 11) and inside.ravel().tolist() == truth


def test_an_open_mesh_answers():
    scene = scene_of((CUBE[0], CUBE[1][:4]))  # bottom and top are left
    points = f4([[1, 1, 1], [1, 1, 5]])
    assert scene.compute_occupancy(points).numpy().shape == (2,)
    assert np.abs(scene.compute_signed_distance(points).numpy()).tolist() == [1, np.sqrt(f4(10))]


def test_later_meshes_count():
    scene, rays = scene_of(SQUARE), f4([[0.5, 0.2, 5, 0, 0, -1]])
    assert scene.cast_rays(rays)["t_hit"].numpy().tolist() == [5]
    assert scene.add_triangles(f4(SQUARE[0]) + f4([0, 0, 2]), SQUARE[1]) == 1
    assert scene.cast_rays(rays)["t_hit"].numpy().tolist() == [3]
    again = pickle.loads(pickle.dumps(scene))
    assert again.cast_rays(rays)["geometry_ids"].numpy().tolist() == [1]
    vertices = f4(SQUARE[0])
    scene.add_triangles(vertices, SQUARE[1])
    vertices[:] = 100  # it has its own copy
    assert scene.count_intersections(rays).numpy().tolist() == [3]


def test_pinhole():
    make = open3d.RaycastingScene.create_rays_pinhole
    rays = make(fov_deg=90, center=[0, 0, 1], eye=[0, 0, 0], up=[0, 1, 0], width_px=2, height_px=2)
    assert rays.numpy().dtype == np.float32
    assert np.abs(rays.numpy()[..., 3:].reshape(4, 3)).tolist() == [[0.5, 0.5, 1]] * 4
    assert rays.numpy()[0, 0, 4] == -0.5  # row 0 is opposite of up
    by_matrix = make(f4([[100, 0, 1.5], [0, 50, 1], [0, 0, 1]]), np.eye(4), 3, 2).numpy()
    assert by_matrix.shape == (2, 3, 6)
    assert by_matrix[1, 2].tolist() == [0, 0, 0, f4(0.01), f4(0.01), 1]
    with pytest.raises(RuntimeError):
        make(np.eye(3), np.eye(3), 3, 2)
    with pytest.raises(RuntimeError):
        make(60, [0, 0, 0], [0, 0, 0], [0, 1, 0], 3, 2)
    with pytest.raises(TypeError):
        make(60, [0, 0, 0])


def test_matrices_that_are_no_rigid_motion():
    """As Open3D has it, transposed; checked against it where it is installed."""
    make = open3d.RaycastingScene.create_rays_pinhole
    random = np.random.default_rng(2)
    rotation = np.linalg.qr(random.normal(size=(3, 3)))[0]
    upper = np.array([[100, 5, 32], [0, 90, 24], [0, 0, 1.0]])
    lower = np.array([[100, 0, 32], [3, 100, 24], [0, 0.001, 1.0]])
    for intrinsic in (upper, lower, 2 * upper, random.normal(size=(3, 3))):
        for part in (rotation, rotation + 1e-3, 2 * rotation, np.diag([-1.0, 1, 1]),
                     random.normal(size=(3, 3))):
            extrinsic = np.eye(4)
            extrinsic[:3, :3], extrinsic[:3, 3] = part, (1, 2, 3)
            rays = make(intrinsic, extrinsic, 7, 5).numpy()
            assert rays.dtype == np.float32 and rays.shape == (5, 7, 6)
            along = part.T @ np.linalg.inv(intrinsic) @ [3.5, 1.5, 1]
            assert np.allclose(rays[1, 3], [*(-part.T @ [1, 2, 3]), *along], rtol=1e-5, atol=1e-6)
            if HAVE:
                import open3d as original
                theirs = original.t.geometry.RaycastingScene.create_rays_pinhole(
                    original.core.Tensor(intrinsic), original.core.Tensor(extrinsic), 7, 5)
                assert np.allclose(rays, theirs.numpy(), rtol=1e-4, atol=1e-5)
    flat, bad = np.diag([1.0, 1, 0, 1]), np.eye(4)
    bad[0, 3] = np.nan
    for intrinsic, extrinsic, words in (
            (np.diag([1.0, 0, 1]), np.eye(4), "intrinsic_matrix has no inverse"),
            (upper, flat, "extrinsic_matrix.* has no inverse"),
            (upper, bad, "extrinsic_matrix: nan")):
        with pytest.raises(RuntimeError, match=words):
            make(intrinsic, extrinsic, 7, 5)


def test_errors():
    scene = scene_of(SQUARE)
    for rays, word in ((f4([0, 0, 0, 1, 1, 1]), "dimensions"), (f4([[0, 0, 0]]), "last dimension"),
                       (np.zeros((1, 6)), "Float32")):
        with pytest.raises(RuntimeError, match=word):
            scene.cast_rays(rays)
    for samples in (0, 2, -1):
        with pytest.raises(RuntimeError, match="odd"):
            scene.compute_occupancy(f4([[0, 0, 0]]), nsamples=samples)
    square = f4(SQUARE[0])
    with pytest.raises(RuntimeError, match="UInt32"):
        scene.add_triangles(square, SQUARE[1].astype(np.int64))
    with pytest.raises(RuntimeError, match="Float32"):
        scene.add_triangles(SQUARE[0], SQUARE[1])
    with pytest.raises(IndexError, match="vertex 7"):
        scene.add_triangles(square, np.array([[0, 1, 7]], np.uint32))
    with pytest.raises(TypeError, match="open3d.t.geometry"):
        scene.add_triangles(square)
    with pytest.raises(RuntimeError, match="CPU"):
        open3d.RaycastingScene(device="CUDA:0")
    assert issubclass(pierce.NotClosed, pierce.Error)


def test_tensors_in_and_out(kind):
    if kind == "arrays":
        answer = scene_of(SQUARE).compute_distance(f4([[0, 0, 2]]))
        assert type(answer.numpy()) is np.ndarray and answer.cpu() is answer
        with pytest.raises(ImportError, match="Open3D|open3d") if not HAVE else _nothing():
            open3d.install()
            open3d.uninstall()
        return
    import open3d as original

    cube = original.t.geometry.TriangleMesh.create_box()
    scene = open3d.RaycastingScene(device=original.core.Device("CPU:0"))
    assert scene.add_triangles(cube) == 0
    rays = original.core.Tensor([[0.5, 0.5, -1, 0, 0, 1]], dtype=original.core.float32)
    answer = scene.cast_rays(rays)["t_hit"]
    assert isinstance(answer, original.core.Tensor) and answer.item() == 1
    their = original.t.geometry.RaycastingScene
    open3d.install()
    open3d.install()
    assert original.t.geometry.RaycastingScene is open3d.RaycastingScene
    open3d.uninstall()
    open3d.uninstall()
    assert original.t.geometry.RaycastingScene is their
    view = dict(fov_deg=70, center=[1, 2, 3], eye=[7, 5, 4], up=[0, 0, 1], width_px=9, height_px=7)
    close = [kind.create_rays_pinhole(**view).numpy() for kind in (their, open3d.RaycastingScene)]
    assert np.allclose(*close, rtol=1e-5, atol=1e-6)


class _nothing:
    def __enter__(self):
        return self

    def __exit__(self, *error):
        return False
