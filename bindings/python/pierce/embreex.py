# SPDX-License-Identifier: Apache-2.0
"""embreex's classes with exact answers: for programs that use Embree through embreex.

Instead of `from embreex import rtcore_scene, mesh_construction` write `from pierce.embreex import
rtcore_scene, mesh_construction`; the classes are here by their own names too. Or call `install()`
once, and programs stay as they are. embreex itself is not needed. Checked against embreex
4.4.0.post1.

What differs from embreex, and who is right:

- Embree computes in float32 and loses or misplaces hits at edges, at vertices and far away. Here
  every hit is decided exactly, t, u and v are rounded once, and of triangles hit at the same t the
  first counts, whereas Embree's depends on its tree.

  >>> corners = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]], np.float32)
  >>> scene = EmbreeScene()
  >>> mesh = TriangleMesh(scene, corners, np.array([[0, 1, 2], [0, 2, 3]]))
  >>> origins = np.array([[0.5, 0.5, 3], [1, 1, 3], [2, 1, 3]], np.float32)
  >>> scene.run(origins, np.array([[0, 0, -2]], np.float32), query="DISTANCE")
  array([1.5e+00, 1.5e+00, 1.0e+37], dtype=float32)

- A mesh added after the first `run` counts. embreex commits its scene once and never sees it.
- query="OCCLUDED" with output=True has ids and zeros; embreex returns memory that nobody wrote.
- Too few directions are a ValueError; embreex reads beyond the array. So are vertices that are NaN
  or infinite in a triangle (pierce.NonFiniteVertex) and indices of vertices that do not exist
  (IndexError), which Embree leaves out or reads beyond the array for.
- `run` uses all cores, embreex one. `robust` is accepted, and means nothing.
"""

from __future__ import annotations

import numbers
import sys
from types import ModuleType, SimpleNamespace
from typing import Any

import numpy as np

from . import _core
from ._arrays import Array
from ._question import control
from ._scene import Scene
from ._stand_in import GrowingScene

__all__ = ["ElementMesh", "EmbreeDevice", "EmbreeScene", "TriangleMesh", "install",
           "mesh_construction", "rtcore", "rtcore_scene", "uninstall"]

QUERIES = ("INTERSECT", "OCCLUDED", "DISTANCE")
FAR = np.float32(1e37)  # what embreex has where nothing is hit

# Corners of the triangles that an element becomes, in embreex's order.
_TETRAHEDRON = [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]]
_HEXAHEDRON = [[0, 2, 1], [0, 3, 2], [4, 5, 6], [4, 6, 7], [0, 1, 5], [0, 5, 4],
               [1, 2, 6], [1, 6, 5], [0, 7, 3], [0, 4, 7], [3, 6, 2], [3, 7, 6]]


class EmbreeDevice:
    """Takes the place of Embree's device. There is nothing in it."""

    def __repr__(self) -> str:
        return f"pierce {_core.__version__}, in the place of Embree"


class EmbreeScene:
    """A scene: meshes are added to it, then it is asked by `run`.

    Args:
        device: an EmbreeDevice or None; makes no difference.
        robust: as in embreex; makes no difference, every answer is exact.

    >>> scene = EmbreeScene()
    >>> mesh = TriangleMesh(scene, np.array([[[0, 0, 0], [1, 0, 0], [0, 1, 0]]], np.float32))
    >>> scene.run(np.float32([[0.25, 0.25, 1], [2, 2, 1]]), np.float32([[0, 0, -1]]))
    array([ 0, -1], dtype=int32)
    """

    def __init__(self, device: Any = None, robust: bool = True):
        self.device = EmbreeDevice() if device is None else device
        self.is_committed = 0
        self._meshes = GrowingScene()

    def run(self, vec_origins: Any, vec_directions: Any, dists: Any = None,
            query: str = "INTERSECT", output: Any = None) -> Any:
        """Asks which triangle each ray hits first.

        Args:
            vec_origins: (n, 3) float32.
            vec_directions: (n, 3) float32, or (1, 3) for all rays. Any length; t counts in it.
            dists: how far to look, a number or (n,) float32; None: 1e37. The array is written to
                if distances are asked for, as embreex does it.
            query: "INTERSECT": triangles, int32, -1 a miss. "OCCLUDED": 0 where anything is hit,
                else -1. "DISTANCE": t, float32, and where nothing is hit what `dists` says.
            output: True: a dict of `u, v` and `tfar` (n,) float32, `Ng` (n, 3) float32 (the normal
                (b - a) x (c - a), not of unit length), `primID, geomID` (n,) int32.

        Rays that are NaN, or whose directions are zero, miss. Raises ValueError and TypeError, as
        embreex does, for arrays of another type or shape.
        """
        for array, name in ((vec_origins, "vec_origins"), (vec_directions, "vec_directions")):
            _check(array, name)
            if array.ndim != 2:
                raise ValueError("Buffer has wrong number of dimensions (expected 2, got "
                                 f"{array.ndim}): {name}")
        scene, self.is_committed = self._meshes.built(), 1
        return run(scene, vec_origins, vec_directions, dists, query, output)


def _check(array: Any, name: str) -> None:
    if not isinstance(array, np.ndarray):
        raise TypeError(f"Argument '{name}' has incorrect type (expected numpy.ndarray, got "
                        f"{type(array).__name__})")
    if array.dtype != np.float32:
        raise ValueError(f"Buffer dtype mismatch, expected float32 but got {array.dtype}: give "
                         f"{name}.astype(np.float32)")


def run(scene: Scene, origins: Array, directions: Array, dists: Any = None,
        query: str = "INTERSECT", output: Any = None) -> Any:
    """What EmbreeScene.run does, of a scene of float32 or float64."""
    if query not in QUERIES:
        raise ValueError(f"Embree ray query type {query} not recognized.\nAccepted types are "
                         f"({','.join(QUERIES)})")
    n = len(origins)
    if origins.shape != (n, 3) or directions.shape not in ((1, 3), (n, 3)):
        raise ValueError(f"origins and directions have the shapes {origins.shape} and "
                         f"{directions.shape}; give (n, 3) and (n, 3) or (1, 3)")
    if dists is None or isinstance(dists, numbers.Real):
        far = np.full(n, FAR if dists is None else float(dists), scene.dtype)
    elif isinstance(dists, np.ndarray) and dists.dtype == scene.dtype and dists.shape == (n,):
        far = dists
    else:
        raise ValueError(f"dists must be a number, or {scene.dtype} of the shape ({n},)")
    directions = np.broadcast_to(directions, (n, 3))
    if query == "OCCLUDED" and not output:
        hit = scene.any_hit(origins, directions, None, far, invalid="miss")
        return np.where(hit, 0, -1).astype(np.int32)
    hits = scene.closest_hit(origins, directions, None, far, invalid="miss",
                             columns=("t", "u", "v", "geometry", "triangle"))
    if query == "INTERSECT" and not output:
        return hits.triangle.astype(np.int32)
    np.copyto(far, hits.t, where=hits.hit)
    if not output:
        return far
    normals = np.zeros((n, 3), scene.dtype)
    if n:
        scene._core.normals(hits._refs(), False, normals, hits._version, control(0, None))
    normals[~hits.hit] = 0
    return {"u": hits.u, "v": hits.v, "Ng": normals, "tfar": far,
            "primID": hits.triangle.astype(np.int32), "geomID": hits.geometry.astype(np.int32)}


class TriangleMesh:
    """Adds triangles to a scene, which keeps a copy of them as float32.

    Args:
        scene: the EmbreeScene.
        vertices: (triangles, 3, 3), the corners of each; or, with `indices`, (vertices, 3).
        indices: (triangles, 3) integers, or None.

    >>> scene = EmbreeScene()
    >>> vertices = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0]], np.float32)
    >>> TriangleMesh(scene, vertices, np.array([[0, 1, 2]])).mesh
    0
    """

    def __init__(self, scene: EmbreeScene, vertices: Any, indices: Any = None):
        points = _array(vertices, "vertices")
        if indices is None:
            if points.ndim != 3 or points.shape[1:] != (3, 3):
                raise ValueError(f"vertices have the shape {points.shape}; without indices give "
                                 "(triangles, 3, 3)")
            points = points.reshape(-1, 3)
            corners: Array = np.arange(len(points), dtype=np.uint32).reshape(-1, 3)
        else:
            corners = _array(indices, "indices")
        #: Its number in the scene, which `geomID` says.
        self.mesh = _add(scene, points, corners)


class ElementMesh(TriangleMesh):
    """Adds the faces of tetrahedra or hexahedra to a scene, as triangles.

    Args:
        scene: the EmbreeScene.
        vertices: (vertices, 3).
        indices: (elements, 4) or (elements, 8) integers, numbered as embreex has them (Exodus
            order). Element i becomes the triangles 4 i to 4 i + 3, or 12 i to 12 i + 11.

    >>> scene = EmbreeScene()
    >>> corners = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]], np.float32)
    >>> mesh = ElementMesh(scene, corners, np.array([[0, 1, 2, 3]]))
    >>> scene.run(np.float32([[-1, 0.2, 0.2]]), np.float32([[1, 0, 0]]))
    array([2], dtype=int32)
    """

    def __init__(self, scene: EmbreeScene, vertices: Any, indices: Any):
        points, elements = _array(vertices, "vertices"), _array(indices, "indices")
        columns = elements.shape[1] if elements.ndim == 2 else 0
        if columns not in (4, 8):
            raise NotImplementedError(f"indices have the shape {elements.shape}; give (n, 4), "
                                      "tetrahedra, or (n, 8), hexahedra")
        table = _TETRAHEDRON if columns == 4 else _HEXAHEDRON
        self.mesh = _add(scene, points, elements[:, table].reshape(-1, 3))


def _array(value: Any, name: str) -> Array:
    if not isinstance(value, np.ndarray):
        raise TypeError(f"Argument '{name}' has incorrect type (expected numpy.ndarray, got "
                        f"{type(value).__name__})")
    return value


def _add(scene: EmbreeScene, points: Array, corners: Array) -> int:
    if points.ndim != 2 or points.shape[1] != 3:
        raise ValueError(f"vertices have the shape {points.shape}, not (n, 3)")
    scene.is_committed = 0
    with np.errstate(over="ignore"):
        return scene._meshes.add(points.astype(np.float32), corners)


#: The names that embreex's modules have.
rtcore = SimpleNamespace(EmbreeDevice=EmbreeDevice)
rtcore_scene = SimpleNamespace(EmbreeScene=EmbreeScene)
mesh_construction = SimpleNamespace(TriangleMesh=TriangleMesh, ElementMesh=ElementMesh)

_ORIGINALS: dict[str, Any] = {}


def install() -> None:
    """Makes `import embreex` and its modules mean this one, until `uninstall`.

    For what is imported from now on; programs then stay as they are.
    """
    if _ORIGINALS:
        return
    top = ModuleType("embreex")
    top.__path__ = []
    made = {"embreex": top}
    for name, has in (("rtcore", rtcore), ("rtcore_scene", rtcore_scene),
                      ("mesh_construction", mesh_construction)):
        module = made[f"embreex.{name}"] = ModuleType(f"embreex.{name}")
        module.__dict__.update(vars(has))
        setattr(top, name, module)
    for name, module in made.items():
        _ORIGINALS[name] = sys.modules.get(name)
        sys.modules[name] = module


def uninstall() -> None:
    """Undoes `install`."""
    while _ORIGINALS:
        name, module = _ORIGINALS.popitem()
        if module is None:
            del sys.modules[name]
        else:
            sys.modules[name] = module
