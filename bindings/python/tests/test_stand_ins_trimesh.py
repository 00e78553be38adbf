# SPDX-License-Identifier: Apache-2.0
"""pierce.trimesh: trimesh's queries, exactly; without trimesh on plain meshes, and with it."""

import copy
import importlib.util
import pickle
from fractions import Fraction
from types import SimpleNamespace

import numpy as np
import oracle
import pytest
from meshes import CUBE, SQUARE, TETRAHEDRON, sheets

import pierce
from pierce.trimesh import (ProximityQuery, RayMeshIntersector, closest_point, longest_ray,
                            max_tangent_sphere, scene_of, signed_distance, thickness)

needs_trimesh = pytest.mark.skipif(importlib.util.find_spec("trimesh") is None,
                                   reason="trimesh is not installed")


def plain(mesh):
    return SimpleNamespace(vertices=mesh[0].copy(), faces=mesh[1].astype(np.int64))


DOWN = [0, 0, -1]


def test_rows():
    engine = RayMeshIntersector(plain(CUBE))
    origins = [[1, 1, 5], [9, 9, 9], [0.5, 1.25, 5], [0, 0, 5]]
    tri, ray = engine.intersects_id(origins, [DOWN] * 4)
    assert ray.tolist() == [0, 0, 2, 2, 3, 3]  # one row for each different t, at edges too
    assert tri.dtype == ray.dtype == np.int64
    points, ray, tri = engine.intersects_location(origins, [DOWN] * 4)
    assert points.dtype == np.float64 and points[:, 2].tolist() == [2, 0] * 3
    assert ray.tolist() == [0, 0, 2, 2, 3, 3] and len(tri) == 6
    points, ray, tri = engine.intersects_location(origins, [DOWN] * 4, multiple_hits=False)
    assert points[:, 2].tolist() == [2, 2, 2] and ray.tolist() == [0, 2, 3]
    first = engine.intersects_first(origins, [DOWN] * 4)
    assert first.tolist() == [tri[0], -1, tri[1], tri[2]]
    assert engine.intersects_any(origins, [DOWN] * 4).tolist() == [True, False, True, True]
    assert len(RayMeshIntersector(plain(sheets(150))).intersects_id([[0.5, 0.5, 999]], [DOWN])[0]
               ) == 150  # trimesh stops at 100


def test_both_orders_of_flags():
    class Other(RayMeshIntersector):
        _order = ("return_locations", "multiple_hits")

    origins, directions = [[0.5, 1, 5], [1, 1.5, 5]], [DOWN] * 2
    for engine, single in ((RayMeshIntersector(plain(CUBE)), 2), (Other(plain(CUBE)), 3)):
        def ask(*flags, **named):
            found = engine.intersects_id(origins, directions, *flags, **named)
            return len(found), len(found[0])

        assert ask() == (2, 4)
        assert ask(True) == (single, 4)
        assert ask(True, False) == (3, 2)  # return_locations, multiple_hits
        assert ask(False, True) == (2, 4)
        assert ask(True, 1, True) == (3, 2)  # multiple_hits, max_hits, return_locations
        assert ask(False, 100) == (2, 2)
        assert ask(True, multiple_hits=False) == (3, 2)  # so the first is return_locations
        assert ask(False, return_locations=True) == (3, 2)  # so the first is multiple_hits
        assert ask(multiple_hits=True, max_hits=1, return_locations=True) == (3, 2)
        with pytest.raises(TypeError):
            ask(True, 100, False, True)
        with pytest.raises(TypeError):
            ask(True, False, multiple_hits=False)


def test_bad_rays_and_shapes():
    engine = RayMeshIntersector(plain(SQUARE))
    bad = [[0.5, 0.2, 1], [np.nan, 0, 1], [0.5, 0.2, np.inf]]
    assert engine.intersects_first(bad, [[0, 0, 0], DOWN, DOWN]).tolist() == [-1] * 3
    assert len(engine.intersects_id(bad, [[0, 0, 0], DOWN, DOWN])[0]) == 0
    points, ray, tri = engine.intersects_location(np.zeros((0, 3)), np.zeros((0, 3)))
    assert points.shape == (0, 3) and ray.shape == tri.shape == (0,)
    assert engine.intersects_location([[0.5, 0.2, 0]], [[1, 1, 0]])[0].shape == (0, 3)
    with pytest.raises(ValueError, match="match"):
        engine.intersects_any([[0, 0, 0]], [DOWN, DOWN])
    with pytest.raises(ValueError, match="shape"):
        engine.intersects_any([0, 0, 0], DOWN)
    empty = RayMeshIntersector(plain((np.zeros((0, 3)), np.zeros((0, 3), int))))
    assert empty.intersects_first([[0, 0, 0]], [DOWN]).tolist() == [-1]
    assert empty.contains_points([[0, 0, 0]]).tolist() == [False]
    broken = plain(SQUARE)
    broken.vertices[2] = np.nan
    with pytest.raises(pierce.NonFiniteVertex):
        RayMeshIntersector(broken).intersects_any([[0, 0, 1]], [DOWN])


def test_locations_are_the_exact_points():
    random = np.random.default_rng(1)
    mesh = plain((random.standard_normal((12, 3)), random.integers(0, 12, (9, 3))))
    origins, directions = random.standard_normal((2, 60, 3))
    points, ray, tri = RayMeshIntersector(mesh).intersects_location(origins, directions)
    rows = 0
    for i, (o, d) in enumerate(zip(origins, directions)):
        for hit in oracle.all_hits(mesh.vertices, mesh.faces, [*o, *d, 0, np.inf]):
            exact = [Fraction(float(p)) + hit.t * Fraction(float(q)) for p, q in zip(o, d)]
            assert (ray[rows], tri[rows]) == (i, hit.triangle)
            assert points[rows].tolist() == [oracle.rounded(x, np.float64) for x in exact]
            rows += 1
    assert rows == len(points) > 10


def test_changes_are_seen_and_copies_share():
    mesh = plain(SQUARE)
    engine = RayMeshIntersector(mesh)
    assert engine.intersects_any([[0.5, 0.2, 1]], [DOWN]).all()
    mesh.vertices[:, 0] += 10
    assert not engine.intersects_any([[0.5, 0.2, 1]], [DOWN]).any()
    assert copy.copy(engine).mesh is copy.deepcopy(engine).mesh is mesh
    again = pickle.loads(pickle.dumps(engine))
    assert again.mesh is not mesh and again.intersects_any([[10.5, 0.2, 1]], [DOWN]).all()
    assert scene_of(mesh) is engine.scene
    with pytest.raises(TypeError):
        RayMeshIntersector()


def test_what_outsiders_use():
    engine = RayMeshIntersector(plain(SQUARE), scale_to_box=False)
    run = engine._scene.run
    assert run(np.array([[0.5, 0.5, 1], [5, 5, 5]]), np.array([DOWN] * 2)).tolist() == [0, -1]
    far = run(np.array([[0.5, 0.5, 1]]), np.array([DOWN]), query="DISTANCE")
    assert (far / engine._scale).tolist() == [1]
    assert run(np.array([[0.5, 0.5, 1]]), np.array([DOWN]), output=True)["Ng"].shape == (1, 3)


def test_contains():
    engine = RayMeshIntersector(plain(TETRAHEDRON))
    points = [[1, 1, 1], [1, 1, 0], [5, 5, 5], [np.nan, 0, 0], [2, 1, 1], [4 / 3] * 3, [2, 1, 1.1]]
    assert engine.contains_points(points).tolist() == [True, True, False, False, True, True, False]
    assert engine.contains_points(np.zeros((0, 3))).shape == (0,)
    with pytest.raises(ValueError, match=r"\(n,3\)"):
        engine.contains_points([1, 1, 1])
    inwards = plain((TETRAHEDRON[0], TETRAHEDRON[1][:, ::-1]))
    assert RayMeshIntersector(inwards).contains_points([[1, 1, 1], [3, 3, 3]]).tolist() == [1, 0]
    opened = RayMeshIntersector(plain((CUBE[0], CUBE[1][2:])))
    grid = np.stack(np.meshgrid(*[np.linspace(-0.9, 2.9, 8)] * 3), axis=-1).reshape(-1, 3)
    found = opened.contains_points(grid)
    assert (found == opened.contains_points(grid)).all()  # no chance in it
    outside = (np.abs(grid - 1) > 1).any(axis=1)
    assert not found[outside].any() and found[~outside].mean() > 0.7


def test_closest_point():
    mesh = plain(TETRAHEDRON)
    closest, distance, triangle = closest_point(mesh, [[1, 1, -2], [2, 2, 2]])
    assert closest.tolist() == [[1, 1, 0], [4 / 3] * 3] and triangle.tolist() == [0, 3]
    assert distance.tolist() == [2, oracle.rounded_root(Fraction(4, 3), np.float64)]
    assert ProximityQuery(mesh).on_surface([[1, 1, -2]])[2].tolist() == [0]
    assert [len(x) for x in closest_point(mesh, np.zeros((0, 3)))] == [0, 0, 0]
    for bad in ([1, 2, 3], [[1, 2]]):
        with pytest.raises(ValueError, match=r"\(n,3\)"):
            closest_point(mesh, bad)


def test_of_faces_at_an_edge_the_one_below_counts():
    """A blade: above its edge each point belongs to the face that looks at it."""
    blade = plain((np.array([[-1, 0, 0], [1, 0, 0], [0, -3, 1], [0, -3, -1]], float),
                   np.array([[0, 1, 2], [1, 0, 3], [0, 2, 3], [1, 3, 2]])))
    points = np.array([[0, 1, z] for z in (-0.5, -0.01, 0.01, 0.5)])
    normals = scene_of(blade)._normals(np.array([[0, 0], [0, 1]], np.uint32))
    for split in (blade, plain((blade.vertices[blade.faces].reshape(-1, 3),
                                np.arange(12).reshape(-1, 3)))):  # the same without shared vertices
        closest, _, triangle = closest_point(split, points)
        assert closest.tolist() == [[0, 0, 0]] * 4
        assert triangle.tolist() == np.argmax(points @ normals.T, axis=1).tolist()
    corner = closest_point(plain(CUBE), [[3, 2.5, 2.25]])
    normal = scene_of(plain(CUBE))._normals(np.array([[0, corner[2][0]]], np.uint32))
    assert corner[0].tolist() == [[2, 2, 2]] and np.abs(normal).tolist() == [[1, 0, 0]]


def test_signed_distance():
    mesh = plain(TETRAHEDRON)
    points = [[1, 1, 0.5], [1, 1, 0], [1, 1, -1e-12], [-3, 0, 0]]
    assert signed_distance(mesh, points).tolist() == [0.5, 0, -1e-12, -3]
    assert not np.signbit(signed_distance(mesh, points)[1])
    mesh.faces = mesh.faces[:, ::-1]  # windings have no say
    assert signed_distance(mesh, points).tolist() == [0.5, 0, -1e-12, -3]
    assert ProximityQuery(mesh).signed_distance(points).tolist() == [0.5, 0, -1e-12, -3]
    opened = plain((CUBE[0], np.delete(CUBE[1], [0, 1], axis=0)))
    points = [[1.875, 1, 1], [2.5, 1, 1], [1, 1, 1.75], [3, 3, 3]]
    assert signed_distance(opened, points).tolist() == [0.125, -0.5, 0.25, -np.sqrt(3)]


def test_longest_ray_and_thickness():
    mesh = plain(CUBE)
    points = np.array([[1, 0.75, 2.0], [1, 0.75, 1], [9, 9, 9], [1, 1, 1]])
    down = np.array([[0, 0, -3.0], [0, 0, -3.0], [0, 0, -3.0], [0, 0, 0]])
    assert longest_ray(mesh, points, down).tolist() == [2, 1, np.inf, np.inf]
    up = np.tile([0.0, 0, 1], (2, 1))
    for method in ("ray", "max_sphere"):
        wall = thickness(mesh, points[[0, 0]], normals=up, method=method)
        assert wall.tolist() == pytest.approx([2, 2] if method == "ray" else [1.5, 1.5])
        assert np.isinf(thickness(mesh, points[:1], True, up[:1], method)).all()
    centers, radii = max_tangent_sphere(mesh, points[:1], normals=up[:1])
    assert centers[0].tolist() == pytest.approx([1, 0.75, 1.25]) and radii[0] == pytest.approx(0.75)
    assert np.isnan(max_tangent_sphere(mesh, points[:1], False, up[:1])[0]).all()
    assert thickness(mesh, [[1, 0.75, 2.0]], method="ray").tolist() == [2]  # own normals
    with pytest.raises(ValueError, match="max_sphere"):
        thickness(mesh, points[:1], method="guess")
    for call in (longest_ray, lambda m, p, n: thickness(m, p, normals=n)):
        with pytest.raises(ValueError, match="number"):
            call(mesh, points, down[:2])


@needs_trimesh
def test_install_and_uninstall():
    import trimesh

    before = (trimesh.ray.ray_pyembree, trimesh.ray.has_embree, trimesh.proximity.closest_point,
              trimesh.ray.ray_triangle.RayMeshIntersector, trimesh.proximity.ProximityQuery)
    old = trimesh.creation.box()
    pierce.trimesh.install()
    pierce.trimesh.install()
    try:
        from trimesh.ray.ray_pyembree import RayMeshIntersector as found

        assert found is RayMeshIntersector and trimesh.ray.has_embree
        box = trimesh.creation.box()
        for mesh in (box, box.copy(), trimesh.creation.box(use_embree=False)):
            assert isinstance(mesh.ray, RayMeshIntersector)
            assert isinstance(mesh.nearest, ProximityQuery)
            assert mesh.contains([[0, 0, 0], [0.5, 0, 0], [0.75, 0, 0]]).tolist() == [1, 1, 0]
        assert not isinstance(old.ray, RayMeshIntersector)
        assert trimesh.proximity.closest_point(box, [[0, 0, 3]])[1].tolist() == [2.5]
        grid = box.voxelized(0.25, method="pierce")
        assert grid.filled_count == 125 and grid.is_filled([0, 0, 0])  # centres on the surface too
        points = grid.points
        assert np.allclose(points / 0.25, np.round(points / 0.25)) and np.abs(points).max() == 0.5
        sphere = trimesh.creation.icosphere()
        assert trimesh.sample.volume_mesh(sphere, 50).shape[1] == 3
        with pytest.raises(pierce.NotClosed):
            pierce.trimesh.voxelize(trimesh.Trimesh(sphere.vertices, sphere.faces[1:]), 0.5)
        with pytest.raises(ValueError, match="pitch"):
            pierce.trimesh.voxelize(sphere, 0)
    finally:
        pierce.trimesh.uninstall()
        pierce.trimesh.uninstall()
    after = (trimesh.ray.ray_pyembree, trimesh.ray.has_embree, trimesh.proximity.closest_point,
             trimesh.ray.ray_triangle.RayMeshIntersector, trimesh.proximity.ProximityQuery)
    assert after == before and "pierce" not in trimesh.voxel.creation.voxelizers
    assert box.ray.intersects_any([[0, 0, 3]], [DOWN]).all()


@needs_trimesh
def test_a_mesh_of_trimesh():
    import trimesh

    mesh = trimesh.creation.icosphere(subdivisions=2)
    mesh.ray = RayMeshIntersector(mesh)
    scene = mesh.ray.scene
    assert mesh.ray.scene is scene and scene_of(mesh) is scene  # built once
    assert mesh.ray.intersects_any([[0, 0, 3]], [DOWN]).all()
    mesh.apply_translation([10, 0, 0])
    assert not mesh.ray.intersects_any([[0, 0, 3]], [DOWN]).any()
    mesh.vertices[:, 0] -= 10  # in place
    assert mesh.ray.intersects_any([[0, 0, 3]], [DOWN]).all()
    mesh.update_faces(np.arange(len(mesh.faces)) > 0)
    assert len(mesh.ray.scene.geometries[0][1]) == len(mesh.faces)
    again = pickle.loads(pickle.dumps(mesh))
    assert isinstance(again.ray, RayMeshIntersector) and again.ray.mesh is again
    assert again.ray.intersects_any([[0, 0, 3]], [DOWN]).all()
    distance, vertex = ProximityQuery(mesh).vertex([[0, 0, 5]])
    assert distance[0] == pytest.approx(4) and mesh.vertices[vertex[0]].tolist() == [0, 0, 1]
    mesh.ray._cache.clear()
