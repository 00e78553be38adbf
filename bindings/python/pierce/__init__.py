# SPDX-License-Identifier: Apache-2.0
"""Exact, fast answers to which triangles a ray pierces.

>>> import pierce
>>> vertices = [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]]
>>> scene = pierce.Scene(vertices, [[0, 1, 2], [0, 2, 3]])
>>> hits = scene.closest_hit([[0.25, 0.25, 1], [5, 0, 1]], [0, 0, -3])
>>> hits.triangle
array([ 0, -1])
"""

from . import barycentric, io, rays, textbook
from ._core import __version__
from ._errors import (BadFile, Error, IndexOutOfRange, InvalidArgument, InvalidPoint, InvalidRay,
                      MeshWarning, NonFiniteVertex, NotClosed, SizeMismatch, Stopped,
                      TooManyTriangles, UnknownKernel)
from ._hits import Crossings, HitLists, Hits, Nearest
from ._lists import NearestLists, TriangleLists
from ._measure import closedness, measure, self_intersections
from ._scene import Scene, open
from ._weld import Welded, weld

__all__ = [
    "BadFile", "Crossings", "Error", "HitLists", "Hits", "IndexOutOfRange", "InvalidArgument",
    "InvalidPoint", "InvalidRay", "MeshWarning", "Nearest", "NearestLists", "NonFiniteVertex",
    "NotClosed", "Scene", "SizeMismatch", "Stopped", "TooManyTriangles", "TriangleLists",
    "UnknownKernel", "Welded", "__version__", "barycentric", "closedness", "io", "measure", "open",
    "rays", "self_intersections", "textbook", "weld",
]
