# SPDX-License-Identifier: Apache-2.0
"""What trimesh's tests import as `generic`, which its source distribution lacks, and its models.

Written anew for scripts/stand_in_tests.py: the names that the ray, proximity, thickness, sample and
voxel tests use, and for each model that they load a mesh made here that has the property the test
is about. What has no such mesh is skipped.
"""

import logging
import time
import types
import unittest
from collections import deque

import numpy as np
import pytest
import trimesh
from shapely.geometry import Point, Polygon
from trimesh import Trimesh
from trimesh.constants import tol

__all__ = ["Point", "Polygon", "Trimesh", "data", "deque", "get_mesh", "get_meshes", "has_binvox",
           "log", "np", "random", "time", "tol", "transforms", "trimesh", "unittest"]

log = logging.getLogger("trimesh")
has_binvox = False
_generator = np.random.default_rng(0)
transforms = [trimesh.transformations.random_rotation_matrix(row)
              for row in np.random.default_rng(1).random((20, 3))]


def random(shape):
    return _generator.random(shape)


def box(low, high):
    return trimesh.creation.box(bounds=[low, high])


def less(mesh, *parts):
    return trimesh.boolean.difference([mesh, *parts], engine="manifold")


def open_ball():
    ball = trimesh.creation.icosphere(subdivisions=3, radius=6)
    return Trimesh(ball.vertices, ball.faces[40:])


MODELS = {
    "unit_sphere.STL": lambda: trimesh.creation.icosphere(subdivisions=2, radius=0.5),
    "ballA.off": lambda: trimesh.creation.icosphere(subdivisions=3),
    "ballB.off": lambda: trimesh.creation.uv_sphere(),
    "unit_cube.STL": trimesh.creation.box,
    "20mm-xyz-cube.stl": lambda: trimesh.creation.box(extents=[20, 20, 20]),
    "7_8ths_cube.stl": lambda: less(box([-5, -5, -5], [5, 5, 5]), box([0, 0, 0], [5, 5, 5])),
    "teapot.stl": open_ball,  # not watertight
    "featuretype.STL": lambda: less(  # a part with a bore and a pocket
        box([-2, -1.5, 0], [2, 1.5, 1]), box([-1.5, -1, 0.5], [0, 1, 1]),
        trimesh.creation.cylinder(radius=0.4, height=4, sections=64,
                                  transform=trimesh.transformations.translation_matrix([1, 0, 0]))),
    # The origin is inside, nearest to an edge, and in the plane of a face of that edge.
    "origin_inside.STL": lambda: less(box([-1, -1, -1], [1, 1, 1]), box([0.2, 0, -1], [1, 1, 1])),
    "1002_tray_bottom.STL": lambda: trimesh.creation.box(extents=[10, 8, 0.125]),  # a plate
}


def get_mesh(file_name, use_embree=True, force=None):
    if file_name not in MODELS:
        pytest.skip(f"the model {file_name} is not in the source distribution")
    made = MODELS[file_name]()
    mesh = Trimesh(made.vertices, made.faces, use_embree=use_embree)
    mesh._source = types.SimpleNamespace(file_name=file_name)
    return mesh


def get_meshes(count):
    return [get_mesh(name) for name in list(MODELS)[:count]]


_rays = {"ray_origins": np.column_stack([random((50, 2)) * 2 - 1, np.full(50, -3.0)]),
         "ray_directions": np.tile([0.0, 0.0, 1.0], (50, 1))}
data = {"ray_data": {
    "load_kwargs": [{"file_name": name, "use_embree": embree}
                    for name in ("ballA.off", "ballB.off") for embree in (True, False)],
    "rays": {"ballA.off": _rays, "ballB.off": _rays}}}
