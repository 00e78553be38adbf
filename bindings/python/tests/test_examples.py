# SPDX-License-Identifier: Apache-2.0
"""The programs of examples/python run, small, and what they find is right."""

import importlib
import struct
import zlib

import numpy as np
import pytest
from example_modules import FOLDER, example_modules

HELPERS = {"meshes", "picture"}

pytestmark = pytest.mark.skipif(not FOLDER.is_dir(), reason="the package without its repository")


@pytest.fixture(autouse=True)
def folder():
    with example_modules():
        yield


def pixels(path):
    """The picture in a PNG of ours: (height, width, channels)."""
    data = path.read_bytes()
    assert data[:8] == b"\x89PNG\r\n\x1a\n"
    position, body = 8, b""
    while position < len(data):
        size, name = struct.unpack(">I4s", data[position:position + 8])
        content = data[position + 8:position + 8 + size]
        assert zlib.crc32(name + content) == struct.unpack(
            ">I", data[position + 8 + size:position + 12 + size])[0]
        if name == b"IHDR":
            width, height, depth, kind = struct.unpack(">2I2B", content[:10])
        body += content if name == b"IDAT" else b""
        position += 12 + size
    assert depth == 8
    rows = np.frombuffer(zlib.decompress(body), np.uint8).reshape(height, -1)
    assert (rows[:, 0] == 2).all()
    up = np.cumsum(rows[:, 1:], axis=0, dtype=np.uint8)
    return up.reshape(height, width, 3 if kind == 2 else 1)


def run(name, path, **smaller):
    found = importlib.import_module(name).main(out=str(path / f"{name}.png"), **smaller)
    image = pixels(path / f"{name}.png")
    assert image.std() > 1, "an empty picture"
    return found, image


def test_depth_map(tmp_path):
    depth, image = run("depth_map", tmp_path, size=40)
    assert image.shape == (40, 40, 3) and depth.shape == (40, 40)
    seen = np.isfinite(depth)
    assert 0.2 < seen.mean() < 0.6 and 4 < depth[seen].min() < depth[seen].max() < 12
    assert (image[~seen] == 255).all() and not (image[seen] == 255).all(axis=-1).any()


def test_lidar_street(tmp_path):
    cloud, _ = run("lidar_street", tmp_path, columns=200, size=60)
    assert 8000 < len(cloud) <= 64 * 200
    assert (cloud[:, 2] > -1e-9).all() and (np.linalg.norm(cloud - (0, -2, 2), axis=1) < 80.1).all()
    assert (np.abs(cloud[:, 2]) < 1e-9).mean() > 0.3  # the ground


def test_distance_slice(tmp_path):
    distance, _ = run("distance_slice", tmp_path, size=40)
    assert -0.41 < distance.min() < -0.2 and distance.max() > 1


def test_inside_points(tmp_path):
    share, volume = run("inside_points", tmp_path, count=40_000, size=40)[0]
    assert abs(share / volume - 1) < 0.04 and volume > 0


def test_ambient_occlusion(tmp_path):
    light, _ = run("ambient_occlusion", tmp_path, size=40, samples=16)
    assert 0 <= light.min() < 0.4 and light.max() == 1


def test_wall_thickness(tmp_path):
    thickness, _ = run("wall_thickness", tmp_path, size=60)
    assert np.isfinite(thickness).all() and (thickness > 0).all()
    assert 0.2 < np.median(thickness) < 0.5


def test_sun_hours(tmp_path):
    hours, _ = run("sun_hours", tmp_path, size=30, minutes=60)
    assert hours.min() < 3 and 9 < hours.max() <= 12
    assert np.array_equal(hours, hours.round())


def test_visibility(tmp_path):
    count, _ = run("visibility", tmp_path, size=80)
    assert np.nanmax(count) >= 3 and np.nanmin(count) == 0 and np.isnan(count).any()


def test_picking(tmp_path):
    meshes = importlib.import_module("meshes")
    (triangle, corner), image = run("picking", tmp_path, size=100)
    assert corner in meshes.knot(along=90, around=12)[1][triangle]
    assert (image.astype(int) @ [1, -1, 0] > 100).any()  # red


def test_voxels(tmp_path):
    meshes = importlib.import_module("meshes")
    grid, _ = run("voxels", tmp_path, cells=24, size=60)
    mesh = meshes.knot()
    side = (mesh[0].max(axis=0) - mesh[0].min(axis=0)).max() / 24
    assert abs((grid > 0).sum() * side**3 / meshes.volume(mesh) - 1) < 0.05


def test_the_meshes_are_closed_and_face_outward():
    meshes = importlib.import_module("meshes")
    pierce = importlib.import_module("pierce")
    ball = meshes.ball(np.array([1.0, 2, 3]), 2.0)
    for mesh in (meshes.knot(60, 9), meshes.bracket(30), meshes.street(), ball,
                 meshes.box((0, 0, 0), (1, 2, 3))):
        assert meshes.volume(mesh) > 0
        assert pierce.Scene(*mesh).signed_distance([1e3, 0, 0]) > 0  # or NotClosed
    corners = meshes.terrain(17)[0][meshes.terrain(17)[1]]
    up = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    assert (up[:, 2] > 0).all()


def test_each_program_is_tested_and_in_the_gallery():
    programs = {path.stem for path in FOLDER.glob("*.py")} - HELPERS
    tests = {name[5:] for name in globals() if name.startswith("test_")}
    page = (FOLDER.parents[1] / "docs" / "python.md").read_text()
    for name in programs:
        assert name in tests
        assert f"examples/python/{name}.py" in page and f"images/python/{name}.png" in page
    assert len(programs) == 10
