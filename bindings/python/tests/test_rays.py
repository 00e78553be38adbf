# SPDX-License-Identifier: Apache-2.0
"""pierce.rays: where rays start, where they go, and what is refused."""

from fractions import Fraction

import numpy as np
import pytest

from pierce import rays

VIEW = {"fov": 90, "center": (0, 0, 0), "eye": (0, 0, -5), "up": (0, 1, 0)}


def lengths(array):
    return np.linalg.norm(array[..., 3:6], axis=-1)


# Cameras.


def test_pinhole_by_view_is_open3ds():
    """What Open3D 0.20's create_rays_pinhole answers to the same arguments."""
    got = rays.pinhole(4, 2, **VIEW)
    assert got.shape == (2, 4, 6)
    assert np.allclose(got[..., :3], [0, 0, -5])
    x, y = [-0.75, -0.25, 0.25, 0.75], [-0.25, 0.25]
    expected = [[[a, b, 1] for a in x] for b in y]
    assert np.allclose(got[..., 3:], expected)


def test_pinhole_by_matrices_is_open3ds():
    extrinsic = np.eye(4)
    extrinsic[:3, 3] = 1, 2, 3
    got = rays.pinhole(4, 2, intrinsic=[[100, 0, 3], [0, 110, 4], [0, 0, 1]], extrinsic=extrinsic)
    assert np.allclose(got[..., :3], [-1, -2, -3])
    assert np.allclose(got[0, :, 3], [-0.025, -0.015, -0.005, 0.005])
    assert np.allclose(got[0, :, 4], -3.5 / 110)
    assert (got[..., 5] == 1).all()


def test_pinhole_beside_open3d():
    o3d = pytest.importorskip("open3d")
    create = o3d.t.geometry.RaycastingScene.create_rays_pinhole
    theirs = create(fov_deg=57.0, center=np.array([1.0, 2, 3]), eye=np.array([-4.0, 6, 2]),
                    up=np.array([0.1, 0.9, 0.3]), width_px=31, height_px=17).numpy()
    ours = rays.pinhole(31, 17, fov=57, center=(1, 2, 3), eye=(-4, 6, 2), up=(0.1, 0.9, 0.3))
    assert np.allclose(ours, theirs, atol=1e-5)


def test_the_two_forms_of_pinhole_agree():
    fov, width, height = 50.0, 12, 8
    by_view = rays.pinhole(width, height, fov=fov, center=(0, 0, 7), eye=(0, 0, 1), up=(0, 1, 0))
    focal = width / 2 / np.tan(np.radians(fov) / 2)
    intrinsic = [[focal, 0, width / 2], [0, focal, height / 2], [0, 0, 1]]
    extrinsic = np.eye(4)
    extrinsic[2, 3] = -1
    by_matrix = rays.pinhole(width, height, intrinsic=intrinsic, extrinsic=extrinsic)
    assert np.allclose(by_view, by_matrix)


def test_t_of_pinhole_is_depth_and_rows_follow_up():
    got = rays.pinhole(9, 7, fov=70, center=(3, 1, 2), eye=(-1, 0, 5), up=(0, 0, -1))
    ahead = np.array([4, 1, -3]) / np.sqrt(26)
    assert np.allclose(got[..., 3:] @ ahead, 1)
    assert (np.diff(got[..., 5], axis=0) < 0).all()  # down the picture, down in the world
    right = np.cross(ahead, [0, 0, 1])
    assert (np.diff(got[..., 3:] @ right, axis=1) > 0).all()  # and no mirror image


@pytest.mark.parametrize("change, error", [
    ({"fov": 0}, "fov"), ({"fov": 180}, "fov"), ({"fov": np.nan}, "fov"),
    ({"up": (0, 0, 2)}, "line of sight"), ({"up": (0, 0, 0)}, "zero"),
    ({"eye": (0, 0, 0)}, "center - eye"), ({"eye": (0, 0)}, "eye has the shape"),
    ({"width": 0}, "width"),
])
def test_bad_views(change, error):
    arguments = {"width": 4, "height": 2, **VIEW, **change}
    with pytest.raises(ValueError, match=error):
        rays.pinhole(**arguments)


def test_pinhole_wants_one_form():
    with pytest.raises(TypeError, match="or intrinsic and extrinsic"):
        rays.pinhole(4, 2, fov=60)
    with pytest.raises(TypeError, match="or intrinsic and extrinsic"):
        rays.pinhole(4, 2, **VIEW, intrinsic=np.eye(3), extrinsic=np.eye(4))
    with pytest.raises(ValueError, match="rigid"):
        rays.pinhole(4, 2, intrinsic=np.eye(3), extrinsic=2 * np.eye(4))
    with pytest.raises(ValueError, match="triangular"):
        rays.pinhole(4, 2, intrinsic=np.ones((3, 3)), extrinsic=np.eye(4))
    with pytest.raises(TypeError, match="width"):
        rays.pinhole(4.0, 2, **VIEW)


def test_orthographic():
    got = rays.orthographic(4, 2, size=8, center=(0, 0, 0), eye=(0, 0, 9), up=(0, -1, 0))
    assert (got[..., 3:] == [0, 0, -1]).all()
    assert np.allclose(got[0, :, 0], [-3, -1, 1, 3])
    assert np.allclose(got[:, 0, 1], [1, -1])
    assert (got[..., 2] == 9).all()
    with pytest.raises(ValueError, match="size"):
        rays.orthographic(4, 2, size=0, center=(0, 0, 0), eye=(0, 0, 9), up=(0, 1, 0))


# Lidars.


@pytest.mark.parametrize("name, beams, top, bottom", [
    ("VLP-16", 16, 15, -15), ("HDL-32E", 32, 10.67, -30.67), ("HDL-64E", 64, 2, -24.33),
    ("OS1-64", 64, 16.611, -16.611), ("OS1-128", 128, 21.2, -21.2)])
def test_sensors(name, beams, top, bottom):
    known = rays.SENSORS[name]
    got = rays.lidar(name)
    assert got.shape == (beams, known.columns, 6)
    angles = np.degrees(np.arcsin(got[:, 0, 5]))
    assert angles[0] == pytest.approx(top, abs=0.006)
    assert angles[-1] == pytest.approx(bottom, abs=0.006)
    assert (np.diff(angles) < 0).all()
    assert np.allclose(lengths(got), 1, atol=1e-15)
    assert len(known.offsets) == beams and "Velodyne" in known.source or "Ouster" in known.source


def test_hdl_64e_has_two_blocks():
    steps = -np.diff(rays.SENSORS["HDL-64E"].elevations)
    assert np.allclose(steps[:31], 1 / 3) and np.allclose(steps[32:], 1 / 2)
    assert steps[31] == pytest.approx(0.5, abs=0.01)


def test_lidar_turns_clockwise_and_looks_ahead_in_the_middle():
    got = rays.lidar("VLP-16", columns=360)
    azimuth = np.degrees(np.arctan2(got[7, :, 4], got[7, :, 3]))
    assert azimuth[180] == pytest.approx(0, abs=1e-12)
    assert azimuth[90] == pytest.approx(90)
    assert np.allclose(np.diff(azimuth[1:]), -1)


def test_lidar_offsets_and_pose():
    one = rays.lidar("OS1-64", columns=4, start=0)[:4, 0]
    assert np.allclose(np.degrees(np.arctan2(one[:, 4], one[:, 3])), [-3.164, -1.055, 1.055, 3.164])
    pose = [[0, -1, 0, 5], [1, 0, 0, 6], [0, 0, 1, 7], [0, 0, 0, 1]]
    plain, turned = rays.lidar("VLP-16"), rays.lidar("VLP-16", pose)
    assert np.allclose(turned[..., :3], [5, 6, 7])
    assert np.allclose(turned[..., 3], -plain[..., 4])
    assert np.allclose(turned[..., 4], plain[..., 3])


def test_lidar_of_ones_own():
    got = rays.lidar(None, (1, 2, 3), columns=10, elevations=[1, 0], start=45, sweep=90, t_max=50,
                     dtype=np.float32)
    assert got.shape == (2, 10, 8) and got.dtype == np.float32
    assert (got[..., 6:] == [0, 50]).all()
    assert (got[..., 3] > 0).all()
    with pytest.raises(TypeError, match="columns and elevations"):
        rays.lidar(None, columns=10)
    with pytest.raises(ValueError, match="HDL-64E"):
        rays.lidar("VLP16")
    with pytest.raises(ValueError, match="pose"):
        rays.lidar("VLP-16", np.eye(3))
    for change in (2 * np.eye(4), np.diag([2, 1, 1, 1]), np.vstack([np.eye(4)[:3], [1, 0, 0, 1]])):
        with pytest.raises(ValueError, match="pose is no rigid motion: .*to the world"):
            rays.lidar("VLP-16", change)


# Bundles.


def test_sphere_is_even():
    got = rays.sphere(2000, center=(1, 2, 3), radius=4)
    assert np.allclose(lengths(got), 1)
    assert np.allclose(got[:, :3], np.array([1, 2, 3]) + 4 * got[:, 3:])
    assert np.abs(got[:, 3:].mean(axis=0)).max() < 1e-3
    octant = (got[:, 3:] > 0) @ [1, 2, 4]
    assert (np.abs(np.bincount(octant) - 250) <= 6).all()
    inward = rays.sphere(10, radius=4, inward=True)
    assert np.allclose(inward[:, :3], -4 * inward[:, 3:])
    assert rays.sphere(1).shape == (1, 6)


NORMALS = np.array([[0, 0, 1], [0, 0, -1], [1, 0, 0], [0, -3e-200, 0], [1, 1, 1],
                    [-1e200, 2e200, 0], [1e-9, 0, -1]])


@pytest.mark.parametrize("sampling, mean", [("cosine", 2 / 3), ("uniform", 1 / 2)])
def test_hemisphere(sampling, mean):
    got = rays.hemisphere(np.zeros(3), NORMALS, 1000, sampling=sampling)
    assert got.shape == (len(NORMALS), 1000, 6)
    assert np.allclose(lengths(got), 1)
    unit = NORMALS / np.abs(NORMALS).max(axis=-1, keepdims=True)
    unit /= np.linalg.norm(unit, axis=-1, keepdims=True)
    height = np.einsum("nkx,nx->nk", got[..., 3:], unit)
    assert (height > 0).all()
    assert np.allclose(height.mean(axis=1), mean, atol=2e-3)
    beside = got[..., 3:].mean(axis=1) - mean * unit  # as much to the left as to the right
    assert np.abs(beside).max() < 5e-3


def test_hemisphere_is_determined_by_the_seed():
    points, up = np.zeros((3, 3), np.float32), np.array([[0, 0, 1]], np.float32)
    once = rays.hemisphere(points, up, 16)
    assert once.dtype == np.float32
    assert np.array_equal(once, rays.hemisphere(points, up, 16, seed=0))
    assert not np.array_equal(once, rays.hemisphere(points, up, 16, seed=1))
    assert not np.array_equal(once[0], once[1])
    with pytest.raises(ValueError, match=r"normals at \(1,\) is zero"):
        rays.hemisphere(points[:2], [[0, 0, 1], [0, 0, 0]], 4)
    with pytest.raises(ValueError, match="sampling"):
        rays.hemisphere(points, up, 4, sampling="even")


def test_shifts_are_those_of_splitmix64():
    """The generator's published first outputs for the seed 1234567, without our own seeding."""
    mask = 2**64 - 1
    state, words = 0, []
    for _ in range(4):
        state = (state + 0x9E3779B97F4A7C15) & mask
        z = state
        z = ((z ^ (z >> 30)) * 0xBF58476D1CE4E5B9) & mask
        z = ((z ^ (z >> 27)) * 0x94D049BB133111EB) & mask
        words.append(z ^ (z >> 31))
    expected = np.array([(word >> 11) / 2**53 for word in words]).reshape(2, 2)
    assert np.array_equal(rays._shifts(2, 0), expected)


def test_grid_wants_the_lower_corner_first():
    assert rays.grid((0, 0, 0), (1, 1, 0), (1, 1)).tolist() == [[[0.5, 0.5, 0, 0, 0, 1]]]
    with pytest.raises(ValueError, match=r"lower is \[0.0, 2.0, 0.0\], upper .*lower corner first"):
        rays.grid((0, 2, 0), (1, 1, 1), (1, 1))


def test_grid():
    got = rays.grid((0, 10, 20), (1, 12, 23), (4, 2), axis=1)
    assert got.shape == (4, 2, 6)
    assert np.allclose(got[:, 0, 0], [0.125, 0.375, 0.625, 0.875])
    assert np.allclose(got[0, :, 2], [20.75, 22.25])
    assert (got[..., 1] == 10).all() and (got[..., 3:] == [0, 1, 0]).all()
    back = rays.grid((0, 10, 20), (1, 12, 23), (4, 2), axis=1, reverse=True)
    assert (back[..., 1] == 12).all() and (back[..., 3:] == [0, -1, 0]).all()
    with pytest.raises(ValueError, match="axis"):
        rays.grid((0, 0, 0), (1, 1, 1), (2, 2), axis=3)
    with pytest.raises(ValueError, match="two numbers"):
        rays.grid((0, 0, 0), (1, 1, 1), 2)


@pytest.mark.parametrize("dtype", [np.float32, np.float64])
def test_between_rounds_the_difference_once(dtype):
    random = np.random.default_rng(1)
    a = (random.standard_normal((200, 3)) * 10.0 ** random.integers(-9, 9, (200, 1))).astype(dtype)
    b = (random.standard_normal((200, 3)) * 10.0 ** random.integers(-9, 9, (200, 1))).astype(dtype)
    got = rays.between(a, b)
    assert got.dtype == dtype and (got[:, 6:] == [0, 1]).all()
    for p, q, d in zip(a.ravel(), b.ravel(), got[:, 3:6].ravel()):
        exact = Fraction(float(q)) - Fraction(float(p))
        error = abs(Fraction(float(d)) - exact)
        assert error <= Fraction(float(np.spacing(abs(d)))) / 2


def test_between_all_pairs_and_open_ends():
    a, b = np.arange(6.0).reshape(2, 3), -np.arange(9.0).reshape(3, 3) - 1
    got = rays.between(a[:, None], b, closed=False)
    assert got.shape == (2, 3, 8)
    assert np.array_equal(got[1, 2, :3] + got[1, 2, 3:6], b[2])
    assert (got[..., 7] == 1 - 2.0**-53).all()
    single = rays.between(a.astype(np.float32), np.float32([[9, 9, 9]]), closed=False)
    assert single.dtype == np.float32 and (single[..., 7] == np.float32(1 - 2.0**-24)).all()
    with pytest.raises(ValueError, match=r"same point at \(1,\)"):
        rays.between(a, a * [[2], [1]])


@pytest.mark.parametrize("make", [
    lambda dtype: rays.pinhole(2, 2, **VIEW, dtype=dtype),
    lambda dtype: rays.sphere(5, dtype=dtype),
    lambda dtype: rays.lidar(columns=3, dtype=dtype),
    lambda dtype: rays.grid((0, 0, 0), (1, 1, 1), (2, 2), dtype=dtype),
    lambda dtype: rays.hemisphere((0, 0, 0), (0, 0, 1), 4, dtype=dtype),
    lambda dtype: rays.between((0, 0, 0), (0, 0, 1), dtype=dtype)])
def test_types(make):
    assert make(np.float32).dtype == np.float32
    assert make("float64").dtype == np.float64
    assert np.allclose(make(np.float32), make(np.float64), atol=1e-6)
    with pytest.raises(TypeError, match="float16"):
        make(np.float16)
