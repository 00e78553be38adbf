# SPDX-License-Identifier: Apache-2.0
"""pierce.pyvista: without pyvista on what looks like its meshes, and with it."""

import importlib.util
import pickle
import subprocess
import sys
from types import SimpleNamespace

import numpy as np
import pytest
from meshes import CUBE, SQUARE

import pierce
from pierce import _pyvista_mesh
from pierce import pyvista as stand_in

needs_pyvista = pytest.mark.skipif(importlib.util.find_spec("pyvista") is None,
                                   reason="pyvista is not installed")


class Plain(SimpleNamespace):
    """As much of a pyvista.PolyData of triangles as the functions look at."""

    def __init__(self, mesh, dtype=np.float32):
        faces = np.concatenate([np.full((len(mesh[1]), 1), 3), mesh[1]], axis=1).ravel()
        super().__init__(points=mesh[0].astype(dtype), faces=faces, strips=np.zeros(0, int),
                         n_open_edges=0, n_cells=len(mesh[1]), is_all_triangles=True,
                         point_data={}, active=None)

    def copy(self, deep=True):
        other = Plain((self.points, self.faces.reshape(-1, 4)[:, 1:]), self.points.dtype)
        other.point_data = dict(self.point_data)
        return other

    def set_active_scalars(self, name):
        self.active = name


def cloud(points):
    return Plain((np.array(points), np.zeros((0, 3), int)), np.float64)


def test_ray_trace():
    mesh = Plain(CUBE)
    points, cells = stand_in.ray_trace(mesh, [1, 1, 5], [1, 1, 1])
    assert points.tolist() == [[1, 1, 2]] and len(cells) == 1  # on an edge: one point
    points, cells = stand_in.ray_trace(mesh, (0.5, 1.25, 4), (0.5, 1.25, 0))
    assert points[:, 2].tolist() == [2, 0]  # both ends belong to it
    points, _ = stand_in.ray_trace(mesh, (0.5, 1.25, -1), (0.5, 1.25, 3))
    assert points[:, 2].tolist() == [0, 2]  # in the order of the segment
    point, cell = stand_in.ray_trace(mesh, (0.5, 1.25, 4), (0.5, 1.25, 0), first_point=True)
    assert point.tolist() == [0.5, 1.25, 2] and cell.tolist() == cells[:1].tolist()
    points, cells = stand_in.ray_trace(mesh, [5, 5, 5], [6, 6, 6], first_point=True)
    assert points.shape == (0, 3) and cells.shape == (0,) and cells.dtype == np.int64
    with pytest.raises(TypeError, match="three"):
        stand_in.ray_trace(mesh, [1, 2], [1, 2, 3])
    with pytest.raises(TypeError, match="extract_surface"):
        stand_in.ray_trace(SimpleNamespace(points=1), [0, 0, 0], [1, 1, 1])


def test_multi_ray_trace():
    mesh = Plain(CUBE)
    origins, down = [[1, 1, 5], [9, 9, 9], [0.5, 1.25, 1], [0, 0, 0]], [[0, 0, -1]] * 3 + [[0] * 3]
    points, rays, cells = stand_in.multi_ray_trace(mesh, origins, down)
    assert rays.tolist() == [0, 0, 2] and points[:, 2].tolist() == [2, 0, 0]
    points, rays, cells = stand_in.multi_ray_trace(mesh, origins, down, first_point=True,
                                                   retry=True)
    assert rays.tolist() == [0, 2] and points.dtype == np.float64
    with pytest.raises(ValueError, match="as many"):
        stand_in.multi_ray_trace(mesh, origins, down[:1])


def test_changes_are_seen():
    mesh = Plain(SQUARE)
    scene = stand_in.scene_of(mesh)
    assert stand_in.scene_of(mesh) is scene
    mesh.points[:, 2] = 7
    assert stand_in.ray_trace(mesh, [0.5, 0.25, 9], [0.5, 0.25, 0])[0].tolist() == [[0.5, 0.25, 7]]
    assert stand_in.scene_of(Plain(SQUARE)) is scene  # whoever has the same mesh
    for height in range(20):
        mesh.points[:, 2] = height
        stand_in.scene_of(mesh)
    assert len(_pyvista_mesh._recent) <= 4


def test_cells_are_numbered_as_in_vtk():
    """Vertices and lines first, then faces, then strips."""
    ask = [0.75, 0.25, 9], [0.75, 0.25, -9]
    mesh = Plain(SQUARE)
    assert stand_in.ray_trace(mesh, *ask)[1].tolist() == [0]
    mesh.n_verts, mesh.n_lines = 1, 2
    assert stand_in.ray_trace(mesh, *ask)[1].tolist() == [3]  # and is not taken for the one before
    mesh.strips = np.array([3, 0, 1, 3, 4, 0, 1, 3, 2])
    mesh.points = mesh.points + np.float32([0, 0, 5])
    mesh.faces = np.array([3, 0, 1, 2])
    points, cells = stand_in.ray_trace(mesh, [0.75, 0.875, 9], [0.75, 0.875, -9])
    assert points.tolist() == [[0.75, 0.875, 5]] and cells.tolist() == [5]


def test_faces_are_not_taken_for_strips():
    square = Plain(SQUARE)
    ask = [0.125, 0.5, 9], [0.125, 0.5, -9]
    strip = Plain(SQUARE)
    strip.faces, strip.strips = np.zeros(0, int), np.array([4, 0, 1, 2, 3])
    assert len(stand_in.ray_trace(strip, *ask)[1]) == 0  # (0, 1, 2) and (2, 1, 3)
    square.faces = np.array([3, 0, 1, 2, 3, 0, 2, 3])
    assert stand_in.ray_trace(square, *ask)[1].tolist() == [1]
    assert len(stand_in.ray_trace(strip, *ask)[1]) == 0


def test_points_of_a_closed_surface():
    surface = Plain(CUBE)
    mesh = cloud([[1, 1, 1], [2, 1, 1], [3, 1, 1], [1, 1, 1.75]])
    out = stand_in.select_interior_points(mesh, surface)
    assert out.point_data["selected_points"].tolist() == [True, True, False, True]
    assert out.active == "selected_points" and "selected_points" not in mesh.point_data
    out = stand_in.select_interior_points(mesh, surface, inside_out=True, method="cell_locator")
    assert out.point_data["selected_points"].tolist() == [False, True, True, False]
    out = stand_in.implicit_distance(mesh, surface)
    assert out.point_data["implicit_distance"].tolist() == [-1, 0, 1, -0.25]
    assert mesh.point_data == {}
    assert stand_in.implicit_distance(mesh, surface, inplace=True) is mesh
    inwards = Plain((CUBE[0], CUBE[1][:, ::-1]))
    out = stand_in.implicit_distance(mesh, inwards)
    assert out.point_data["implicit_distance"].tolist() == [-1, 0, 1, -0.25]
    with pytest.raises(ValueError, match="method"):
        stand_in.select_interior_points(mesh, surface, method="guess")
    nothing = cloud(np.zeros((0, 3)))
    for inside_out in (False, True):
        out = stand_in.select_interior_points(mesh, nothing, inside_out=inside_out)
        assert out.point_data["selected_points"].tolist() == [inside_out] * 4


def test_points_of_an_open_surface():
    """By normals; right at edges and vertices too, where one face's normal may be wrong."""
    mesh = cloud([[0.5, 0.25, 3], [0.5, 0.25, -3], [0.5, 0.5, 1], [5, 5, -1], [0.5, 0.5, 0]])
    out = stand_in.implicit_distance(mesh, Plain(SQUARE))
    assert np.sign(out.point_data["implicit_distance"]).tolist() == [1, -1, 1, -1, 0]
    with pytest.raises(RuntimeError, match="not closed: .* with check_surface=False$"):
        stand_in.select_interior_points(mesh, Plain(SQUARE))
    with pytest.raises(pierce.NotClosed):
        stand_in.select_interior_points(mesh, Plain(SQUARE))
    out = stand_in.select_interior_points(mesh, Plain(SQUARE), check_surface=False)
    assert out.point_data["selected_points"].tolist() == [False, True, False, True, True]
    # A cone without its base: far above its tip all faces look sideways.
    turn = np.linspace(0, 2 * np.pi, 17)[:-1]
    rim = np.stack([np.cos(turn), np.sin(turn), np.full(16, -9.0)], axis=1)
    number = np.arange(16)
    cone = (np.concatenate([rim, [[0, 0, 0]]]),
            np.stack([number, (number + 1) % 16, np.full(16, 16)], axis=1))
    mesh = cloud([[0, 0, 1], [0.25, 0.125, 2], [0, 0, -5]])
    out = stand_in.implicit_distance(mesh, Plain(cone, np.float64))
    assert np.sign(out.point_data["implicit_distance"]).tolist() == [1, 1, -1]


def test_import_needs_no_pyvista():
    code = ("import sys; sys.modules['pyvista'] = None\n"
            "import pierce.pyvista, pierce.trimesh, pierce.open3d, pierce.embreex\n"
            "assert not {'trimesh', 'open3d', 'embreex'} & set(sys.modules)\n")
    subprocess.run([sys.executable, "-c", code], check=True)
    code = ("import sys, pierce\n"
            "assert not {'pyvista', 'trimesh', 'open3d', 'embreex'} & set(sys.modules)\n"
            "assert 'pierce.trimesh' not in sys.modules\n")
    subprocess.run([sys.executable, "-c", code], check=True)


@needs_pyvista
def test_accessor():
    import pyvista

    if not hasattr(pyvista, "register_dataset_accessor"):
        pytest.skip("this pyvista has no accessors")
    code = ("import pyvista, sys\n"
            "assert 'pierce' not in sys.modules\n"
            "sphere = pyvista.Sphere()\n"
            "assert 'pierce' not in sys.modules\n"
            "assert sphere.pierce.ray_trace([0, 0, 0], [0, 0, 1])[0].tolist() == [[0, 0, 0.5]]\n")
    subprocess.run([sys.executable, "-c", code], check=True)
    sphere = pyvista.Sphere()
    assert sphere.pierce is sphere.pierce
    copied = pickle.loads(pickle.dumps(sphere))
    assert copied.pierce.scene is sphere.pierce.scene
    points, rays, cells = sphere.pierce.multi_ray_trace([[0, 0, 3]], [[0, 0, -1]])
    assert points[:, 2].tolist() == [0.5, -0.5]
    inside = pyvista.ImageData(dimensions=(3, 3, 3)).pierce.select_interior_points(sphere)
    assert inside["selected_points"].tolist() == [True] + [False] * 26
    distance = sphere.pierce.implicit_distance(pyvista.Plane())
    assert np.allclose(distance["implicit_distance"], sphere.points[:, 2])
    assert pyvista.Plane().pierce.compute_implicit_distance(sphere).n_arrays > 0


@needs_pyvista
def test_polygons():
    import pyvista

    cube = pyvista.Cube()
    assert not cube.is_all_triangles
    points, cells = stand_in.ray_trace(cube, [0.1, 0.2, 2], [0.1, 0.2, -2])
    theirs = cube.ray_trace([0.1, 0.2, 2], [0.1, 0.2, -2])
    assert points.tolist() == [[0.1, 0.2, 0.5], [0.1, 0.2, -0.5]]
    assert cells.tolist() == theirs[1].tolist()
    strips = pyvista.Sphere().strip()
    assert len(strips.strips) and len(stand_in.ray_trace(strips, [0, 0, 2], [0, 0, 0])[0]) == 1
    with pytest.raises(Exception, match="triangles"):
        stand_in.multi_ray_trace(cube, [[0, 0, 0]], [[0, 0, 1]])


@needs_pyvista
def test_cells_among_lines_and_vertices():
    import pyvista

    sphere = pyvista.Sphere()
    ask = (-5, 0.01, 0.1), (5, 0.01, 0.1)
    for mesh in (sphere, sphere.strip(), pyvista.Cube(),
                 pyvista.PolyData(sphere.points, faces=sphere.faces, lines=[2, 0, 1]),
                 pyvista.PolyData(sphere.points, faces=sphere.faces, verts=[1, 0]),
                 sphere.append_polydata(pyvista.Line((0, 0, -2), (0, 0, 2))),
                 pyvista.Cube().append_polydata(pyvista.Line((0, 0, -2), (0, 0, 2))),
                 pyvista.Cube().append_polydata(sphere.strip())):
        theirs, mine = mesh.ray_trace(*ask), stand_in.ray_trace(mesh, *ask)
        assert len(mine[1]) and sorted(mine[1]) == sorted(theirs[1])
    tube = pyvista.Line((0, 0, -1), (0, 0, 1)).tube(radius=0.2)
    assert tube.n_strips and pierce.Scene(tube).closest_hit(np.float32([-5, 0.01, 0.1, 1, 0, 0]))
    triangles = tube.triangulate().faces.reshape(-1, 4)[:, 1:]
    assert np.array_equal(pierce.Scene(tube).geometries[0][1], triangles)
    with pytest.raises(ValueError, match="holds no triangle"):
        pierce.Scene(pyvista.Line())
    with pytest.raises(ValueError, match="faces that are no triangles; give mesh.triangulate"):
        pierce.Scene(pyvista.PolyData(SQUARE[0], faces=[3, 0, 1, 2, 4, 0, 1, 2, 3]))
    assert not len(pierce.Scene(pyvista.PolyData()).geometries[0][1])


@needs_pyvista
def test_nothing_leaks():
    code = ("import pyvista, numpy\n"
            "sphere = pyvista.Sphere()\n"
            "print(sphere.pierce.ray_trace((-5, 0.01, 0.1), (5, 0.01, 0.1)))\n")
    done = subprocess.run([sys.executable, "-c", code], check=True, capture_output=True, text=True)
    assert "nanobind" not in done.stderr


@needs_pyvista
def test_voxels():
    import pyvista

    cube = pyvista.Cube(x_length=2, y_length=1, z_length=1).triangulate()
    mask = cube.pierce.voxelize_binary_mask(spacing=0.25)
    assert mask.dimensions == (8, 4, 4) and mask["mask"].dtype == np.uint8
    assert mask["mask"].all() and mask.origin == (-0.875, -0.375, -0.375)
    cells = cube.pierce.voxelize(dimensions=(5, 3, 3))
    assert isinstance(cells, pyvista.UnstructuredGrid) and cells.n_cells == 16
    assert np.allclose(cells.bounds, cube.bounds) and cells.n_arrays == 0
    sphere = pyvista.Sphere(theta_resolution=40, phi_resolution=40)
    mine = stand_in.voxelize_rectilinear(sphere, spacing=0.05, foreground_value=7)
    theirs = sphere.voxelize_rectilinear(spacing=0.05, foreground_value=7)
    assert isinstance(mine, pyvista.RectilinearGrid) and mine.dimensions == theirs.dimensions
    assert np.allclose(mine.x, theirs.x) and (mine["mask"] != theirs["mask"]).mean() < 0.02
    straight = pyvista.ImageData(dimensions=(17, 16, 15), spacing=(0.0625,) * 3, origin=(-0.5,) * 3)
    straight.extent = (1, 17, 0, 15, -1, 13)
    scene = pierce.Scene(sphere.points.astype(float), sphere.regular_faces)
    turned = pyvista.ImageData(dimensions=(9, 8, 7), spacing=(0.1, 0.1, 0.1), origin=(-0.3,) * 3)
    turned.direction_matrix = [[0, -1, 0], [1, 0, 0], [0, 0, 1]]
    for volume in (straight, turned):
        mask = stand_in.voxelize_binary_mask(sphere, reference_volume=volume)
        assert np.array_equal(mask.points, volume.points)
        assert np.array_equal(mask["mask"], scene.locate(volume.points.astype(float)) >= 0)
    assert stand_in.voxelize_binary_mask(sphere).dimensions == sphere.voxelize_binary_mask(
        ).dimensions  # by the lengths of its cells
    with pytest.raises(TypeError):
        stand_in.voxelize(sphere, spacing=0.1, dimensions=(3, 3, 3))
    with pytest.raises(TypeError):
        stand_in.voxelize_binary_mask(sphere, reference_volume=turned, spacing=1)
    with pytest.raises(pierce.NotClosed):
        stand_in.voxelize(pyvista.Plane().triangulate(), spacing=0.1)
    assert stand_in.voxelize(pyvista.Plane(), spacing=0.1, open_mesh=True).n_cells >= 0
    box = pyvista.Cube().triangulate()
    cup = pyvista.PolyData(box.points, faces=box.faces[:40])
    assert cup.n_open_edges and cup.pierce.voxelize(spacing=0.25, rule="winding").n_cells == 64
    with pytest.raises(ValueError, match="faces"):
        stand_in.voxelize(pyvista.PolyData(), dimensions=(2, 2, 2))


class Image(SimpleNamespace):
    """As much of a pyvista.ImageData: points of a grid, x fastest."""

    def __init__(self, counts=(1, 1, 1), spacing=(1, 1, 1), origin=(0, 0, 0)):
        super().__init__(dimensions=counts, spacing=spacing, origin=origin, point_data={},
                         extent=[e for n in counts for e in (0, n - 1)], direction_matrix=np.eye(3))

    def set_active_scalars(self, name):
        pass


def test_voxels_of_an_open_surface():
    """The advice of the error holds; without the top what is below it is still inside by rays."""
    cup = Plain((CUBE[0], np.array([t for t in CUBE[1] if not (CUBE[0][t][:, 2] == 2).all()])))
    volume = Image((3, 1, 1), (1, 1, 1), (-0.5, 0.5, 0.75))
    with pytest.raises(pierce.NotClosed, match="open_mesh=True or rule='winding'"):
        stand_in.voxelize_binary_mask(cup, reference_volume=volume)
    turned = Image((3, 1, 1), (1, 1, 1), (-0.5, 0.5, 0.75))
    turned.direction_matrix = np.diag([1, -1, -1])
    turned.points = np.array([[-0.5, 0.5, 0.75], [0.5, 0.5, 0.75], [1.5, 0.5, 0.75]])
    for options in ({"open_mesh": True}, {"rule": "winding"}):
        scene = stand_in.scene_of(cup)
        expected = scene.locate(turned.points, **options) >= 0
        for image in (volume, turned):
            mask = stand_in.voxelize_binary_mask(cup, reference_volume=image, **options)
            assert np.array_equal(mask.point_data["mask"], expected)
    assert expected.tolist() == [False, True, True]  # by winding


def test_options_of_voxels_that_there_are_not():
    for function in (stand_in.voxelize, stand_in.voxelize_rectilinear,
                     stand_in.voxelize_binary_mask):
        for options in ({"spacings": 0.2}, {"spacings": 0.2, "dimensions": (3, 3, 3)}):
            with pytest.raises(TypeError, match="spacings is no option .* did you mean 'spacing'"):
                function(Plain(CUBE), **options)


@needs_pyvista
def test_install_and_uninstall():
    import pyvista

    sphere, names = pyvista.Sphere(), list(stand_in._METHODS)
    before = [getattr(type(sphere), name) for name in names]
    stand_in.install()
    stand_in.install()
    try:
        assert sphere.ray_trace([0, 0, 0], [0, 0, 1])[0].tolist() == [[0, 0, 0.5]]
        assert sphere.ray_trace([0, 0, 0], [0, 0, 1])[0].dtype == np.float64
        cloud = pyvista.ImageData(dimensions=(2, 2, 2))
        assert cloud.select_interior_points(sphere)["selected_points"].sum() == 1
        assert cloud.compute_implicit_distance(sphere)["implicit_distance"].max() > 1
        assert sphere.voxelize_binary_mask().n_points > 8
        assert sphere.voxelize(spacing=0.5, progress_bar=False).n_cells == 8
    finally:
        stand_in.uninstall()
        stand_in.uninstall()
    assert [getattr(type(sphere), name) for name in names] == before
