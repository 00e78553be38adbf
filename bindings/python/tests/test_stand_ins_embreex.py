# SPDX-License-Identifier: Apache-2.0
"""pierce.embreex: embreex's classes, compared with it where it is installed."""

import sys

import numpy as np
import pytest
from meshes import SQUARE, grid

import pierce
import pierce.embreex
from pierce.embreex import EmbreeScene, mesh_construction, rtcore, rtcore_scene

HEXAHEDRON = np.array([[1, 0, 0], [1, 1, 0], [0, 1, 0], [0, 0, 0],
                       [1, 0, 1], [1, 1, 1], [0, 1, 1], [0, 0, 1]], np.float32)
TETRAHEDRON = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]], np.float32)


def f4(values):
    return np.array(values, np.float32)


def square():
    scene = rtcore_scene.EmbreeScene(rtcore.EmbreeDevice(), robust=True)
    mesh = mesh_construction.TriangleMesh(scene, f4(SQUARE[0]), SQUARE[1].astype(np.int32))
    assert mesh.mesh == 0 and "pierce" in repr(scene.device)
    return scene


ORIGINS, DOWN = f4([[0.5, 0.5, 3], [5, 5, 3], [0.75, 0.25, 0], [np.nan, 0, 0]]), f4([[0, 0, -2]])


def test_queries():
    scene = square()
    assert scene.run(ORIGINS, DOWN).tolist() == [0, -1, 0, -1]
    assert scene.run(ORIGINS, DOWN).dtype == np.int32
    assert scene.run(ORIGINS, np.tile(DOWN, (4, 1)), query="OCCLUDED").tolist() == [0, -1, 0, -1]
    far = scene.run(ORIGINS, DOWN, query="DISTANCE")
    assert far.dtype == np.float32 and far.tolist() == f4([1.5, 1e37, 0, 1e37]).tolist()


def test_output():
    found = square().run(ORIGINS, DOWN, dists=100, output=1)
    assert {k: (v.dtype.str[1:], v.shape) for k, v in found.items()} == {
        "u": ("f4", (4,)), "v": ("f4", (4,)), "Ng": ("f4", (4, 3)), "tfar": ("f4", (4,)),
        "primID": ("i4", (4,)), "geomID": ("i4", (4,))}
    assert found["u"].tolist() == [0, 0, 0.5, 0] and found["v"].tolist() == [0.5, 0, 0.25, 0]
    assert found["tfar"].tolist() == [1.5, 100, 0, 100]
    assert found["Ng"].tolist() == [[0, 0, 1], [0, 0, 0], [0, 0, 1], [0, 0, 0]]
    assert found["primID"].tolist() == found["geomID"].tolist() == [0, -1, 0, -1]
    both = square().run(ORIGINS, DOWN, query="OCCLUDED", output=True)
    assert both["geomID"].tolist() == [0, -1, 0, -1]


def test_distances():
    scene = square()
    assert scene.run(ORIGINS, DOWN, dists=1.0).tolist() == [-1, -1, 0, -1]
    dists = f4([9, 8, 7, 6])
    assert scene.run(ORIGINS, DOWN, dists=dists, query="DISTANCE") is dists
    assert dists.tolist() == [1.5, 8, 0, 6]
    assert scene.run(ORIGINS[:1], DOWN, dists=f4([1.5])).tolist() == [0]  # the end belongs to it
    assert scene.run(ORIGINS[:0], DOWN).shape == (0,)
    assert scene.run(ORIGINS[:0], DOWN, output=True)["Ng"].shape == (0, 3)


def test_scenes_grow_and_may_be_empty():
    scene = EmbreeScene()
    assert scene.run(ORIGINS, DOWN).tolist() == [-1] * 4
    mesh_construction.TriangleMesh(scene, f4(SQUARE[0])[SQUARE[1]])
    assert scene.run(ORIGINS, DOWN).tolist() == [0, -1, 0, -1] and scene.is_committed == 1
    raised = f4(SQUARE[0]) + f4([0, 0, 1])
    assert mesh_construction.TriangleMesh(scene, raised, SQUARE[1]).mesh == 1
    assert scene.run(ORIGINS, DOWN, output=True)["geomID"].tolist() == [1, -1, 0, -1]


@pytest.mark.parametrize("corners", [TETRAHEDRON, HEXAHEDRON])
def test_elements(corners):
    scene = EmbreeScene()
    elements = np.arange(len(corners))[None]
    mesh_construction.ElementMesh(scene, corners, elements)
    shell = scene._meshes.built()
    assert (shell.locate(corners.mean(axis=0)[None]) == 1).all()  # closed, and
    volume = np.einsum("ij,ij->i", *(lambda c: (c[:, 0], np.cross(c[:, 1], c[:, 2])))(
        corners[shell.geometries[0][1]] - corners.mean(axis=0))).sum() / 6
    assert np.isclose(volume, 1 / 6 if len(corners) == 4 else 1)  # its faces look outwards


def test_errors():
    scene = square()
    for origins, directions, error, word in (
            (ORIGINS.astype(float), DOWN, ValueError, "dtype"),
            (ORIGINS.tolist(), DOWN, TypeError, "numpy.ndarray"),
            (ORIGINS[0], DOWN, ValueError, "dimensions"),
            (ORIGINS, np.tile(DOWN, (2, 1)), ValueError, "shapes")):
        with pytest.raises(error, match=word):
            scene.run(origins, directions)
    with pytest.raises(ValueError, match="INTERSECT,OCCLUDED,DISTANCE"):
        scene.run(ORIGINS, DOWN, query="NEAREST")
    with pytest.raises(ValueError, match="dists"):
        scene.run(ORIGINS, DOWN, dists=f4([1, 2]))
    with pytest.raises(TypeError, match="vertices"):
        mesh_construction.TriangleMesh(scene, [[0, 0, 0]])
    with pytest.raises(ValueError, match="vertices"):
        mesh_construction.TriangleMesh(scene, f4(SQUARE[0]))
    with pytest.raises(IndexError):
        mesh_construction.TriangleMesh(scene, f4(SQUARE[0]), np.array([[0, 1, 4]]))
    with pytest.raises(NotImplementedError):
        mesh_construction.ElementMesh(scene, f4(SQUARE[0]), np.array([[0, 1, 2]]))
    mesh_construction.TriangleMesh(scene, np.full((1, 3, 3), np.nan, np.float32))
    with pytest.raises(pierce.NonFiniteVertex):
        scene.run(ORIGINS, DOWN)


def test_as_embreex():
    pytest.importorskip("embreex")
    from embreex import mesh_construction as their_meshes
    from embreex import rtcore_scene as their_scenes

    random = np.random.default_rng(2)
    for corners in (TETRAHEDRON, HEXAHEDRON):  # triangles of elements in the same order
        answers = []
        for scenes, meshes in ((rtcore_scene, mesh_construction), (their_scenes, their_meshes)):
            scene = scenes.EmbreeScene()
            meshes.ElementMesh(scene, corners, np.arange(len(corners), dtype=np.int64)[None])
            towards = f4(np.random.default_rng(1).standard_normal((500, 3)))
            centre = np.tile(corners.mean(axis=0), (500, 1))
            answers.append(scene.run(centre, towards, output=True))
        assert np.array_equal(answers[0]["primID"], answers[1]["primID"])
        for name in ("u", "v", "tfar", "Ng"):
            assert np.allclose(answers[0][name], answers[1][name], atol=1e-5), name
    vertices, triangles = grid(8, np.float32)
    origins = np.concatenate([random.uniform(0, 8, (500, 2)), np.full((500, 1), 3)], axis=1)
    towards = f4(random.uniform(-1, 1, (500, 3)) - [0, 0, 1.5])
    pair = []
    for scenes, meshes in ((rtcore_scene, mesh_construction), (their_scenes, their_meshes)):
        scene = scenes.EmbreeScene()
        meshes.TriangleMesh(scene, vertices, triangles.astype(np.int32))
        pair.append(scene.run(f4(origins), towards))
    assert (pair[0] != pair[1]).mean() < 0.01


def test_install_and_uninstall():
    before = {name: module for name, module in sys.modules.items() if name.startswith("embreex")}
    pierce.embreex.install()
    pierce.embreex.install()
    try:
        import embreex
        from embreex import rtcore as installed
        from embreex.mesh_construction import TriangleMesh
        from embreex.rtcore_scene import EmbreeScene as Scene

        assert Scene is EmbreeScene and embreex.rtcore_scene.EmbreeScene is EmbreeScene
        assert installed.EmbreeDevice is rtcore.EmbreeDevice
        assert TriangleMesh is mesh_construction.TriangleMesh
    finally:
        pierce.embreex.uninstall()
        pierce.embreex.uninstall()
    after = {name: module for name, module in sys.modules.items() if name.startswith("embreex")}
    assert after == before
