# SPDX-License-Identifier: Apache-2.0
"""Open3D's RaycastingScene with exact answers.

Instead of `open3d.t.geometry.RaycastingScene` write `pierce.open3d.RaycastingScene`; or call
`install()` once, and programs stay as they are. Where Open3D is installed tensors come out, else
NumPy arrays that have `.numpy()`. Checked against Open3D 0.20.0.

What differs from Open3D, and who is right:

- Every hit is decided exactly, each number is the exact one rounded once. Open3D computes in
  float32 and can miss a surface, or give t = 0.99999994 where t is 1:

  >>> scene = RaycastingScene()
  >>> square = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]], np.float32)
  >>> scene.add_triangles(square, np.array([[0, 1, 2], [0, 2, 3]], np.uint32))
  0
  >>> scene.cast_rays(np.float32([[0.5, 0.5, -1, 0, 0, 1]]))["t_hit"].numpy()
  array([1.], dtype=float32)

- `count_intersections` and `list_intersections` have one row for each geometry and each different
  exact t, in the order of t. Open3D drops a row if float t and geometry are those of the row that
  its tree visited just before, so counts depend on the tree:

  >>> scene.count_intersections(np.float32([[0.5, 0.5, -1, 0, 0, 1]])).numpy()
  array([1], dtype=int32)

- Inside and outside are exact for closed meshes, whatever `nsamples` is: no vote of rays. A point
  on the surface is occupied and its distance 0. Meshes that are not closed answer as in Open3D by
  the parity of a ray, which goes along z here.
- Points that are NaN, and points in an empty scene, have NaN and INVALID_ID, their distance is NaN
  or inf; Open3D returns memory that nobody wrote. No rays at all give an empty list; Open3D 0.20.0
  crashes. Indices of vertices that do not exist raise IndexError; Open3D reads beyond the array.
- The range of `test_occlusions` includes both ends.
- `create_rays_pinhole` rounds once; Open3D computes in float32. It raises where the camera points
  nowhere or its matrices have no inverse, for which Open3D has NaN or rays that are flat.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from ._arrays import Array
from ._errors import NotClosed
from ._question import control
from ._scene import Scene
from ._stand_in import GrowingScene, installed, package
from .rays import matrix, pinhole, rays_of_matrices

__all__ = ["RaycastingScene", "TensorArray", "install", "uninstall"]

INVALID = 0xFFFFFFFF
FLOAT32 = np.dtype(np.float32)


class TensorArray(np.ndarray[Any, Any]):
    """A NumPy array with the methods of tensors that programs for Open3D call on answers."""

    def numpy(self) -> Array:
        """The same numbers as a plain array."""
        return self.view(np.ndarray)

    def cpu(self) -> TensorArray:
        """Itself."""
        return self


def _tensor(array: Array) -> Any:
    module = installed("open3d")
    array = np.ascontiguousarray(array)
    if module is None:
        return array.view(TensorArray)
    return module.core.Tensor.from_numpy(array)


def _array(value: Any) -> Array:
    if hasattr(value, "cpu") and hasattr(value, "numpy"):
        value = value.cpu().numpy()
    return np.asarray(value)


def _table(value: Any, name: str, columns: int) -> Array:
    """Rows of float32, as Open3D demands them."""
    array = _array(value)
    if array.ndim < 2:
        raise RuntimeError(f"{name} has the shape {array.shape}, expected at least 2 dimensions, "
                           f"(.., {columns})")
    if array.shape[-1] != columns:
        raise RuntimeError(f"{name} has the shape {array.shape}, the last dimension must be "
                           f"{columns}")
    if array.dtype != FLOAT32:
        raise RuntimeError(f"{name} has dtype {array.dtype}, but is expected to have Float32: give "
                           f"{name}.astype(np.float32)")
    return array


def _ids(numbers: Array) -> Array:
    return numbers.astype(np.uint32)  # -1 becomes INVALID_ID


class RaycastingScene:
    """Triangle meshes that are asked about rays and points, as Open3D's class is.

    Args:
        nthreads: how many threads build; 0: as many as the machine has.
        device: None, or the CPU's; others raise RuntimeError.

    The scene is built at the first question after `add_triangles`; threads may share it. Rays are
    float32 (.., 6) and points float32 (.., 3) with two dimensions or more, tensors or arrays;
    answers have their leading shape. What is not so raises RuntimeError. Rays that are NaN, or
    whose directions are zero, miss.

    >>> scene = RaycastingScene()
    >>> scene.add_triangles(np.eye(3, dtype=np.float32), np.array([[0, 1, 2]], np.uint32))
    0
    >>> answer = scene.cast_rays(np.float32([[0, 0, 0, 1, 1, 1], [0, 0, 0, -1, 0, 0]]))
    >>> answer["t_hit"].numpy(), answer["primitive_ids"].numpy()
    (array([0.33333334,        inf], dtype=float32), array([         0, 4294967295], dtype=uint32))
    """

    #: The number that is no geometry's and no triangle's.
    INVALID_ID = INVALID

    def __init__(self, nthreads: int = 0, device: Any = None):
        if device is not None and not str(device).upper().startswith("CPU"):
            raise RuntimeError(f"device is {device}; pierce has the CPU only")
        self._meshes = GrowingScene(nthreads)
        self._open = False

    def add_triangles(self, vertex_positions: Any = None, triangle_indices: Any = None, *,
                      mesh: Any = None) -> int:
        """Adds a mesh, which is copied; returns its geometry's number.

        Args:
            vertex_positions: (n, 3) float32, with `triangle_indices` (m, 3) uint32; or alone, a
                mesh of open3d.t.geometry, whose positions must be float32.
            mesh: such a mesh by name.
        """
        if triangle_indices is None:
            mesh = vertex_positions if mesh is None else mesh
            if not hasattr(mesh, "vertex") or not hasattr(mesh, "triangle"):
                raise TypeError(f"add_triangles is given {type(mesh).__name__}; give a mesh of "
                                "open3d.t.geometry, or positions and indices")
            vertex_positions = mesh.vertex.positions
            triangle_indices = _array(mesh.triangle.indices).astype(np.uint32)
        corners = _array(triangle_indices)
        if corners.dtype != np.uint32:
            raise RuntimeError(f"triangle_indices has dtype {corners.dtype}, but is expected to "
                               "have UInt32: give triangle_indices.astype(np.uint32)")
        points = _table(vertex_positions, "vertex_positions", 3)
        for array, name in ((points, "vertex_positions"), (corners, "triangle_indices")):
            if array.ndim != 2 or array.shape[1] != 3:
                raise RuntimeError(f"{name} has the shape {array.shape}, but is expected to have "
                                   "(n, 3)")
        self._open = False
        return self._meshes.add(points, corners)

    def cast_rays(self, rays: Any, nthreads: int = 0) -> dict[str, Any]:
        """The first hit of each ray.

        Returns a dict: `t_hit` float32, inf a miss; `geometry_ids` and `primitive_ids` uint32,
        INVALID_ID a miss; `primitive_uvs` (.., 2) and `primitive_normals` (.., 3) float32, 0 a
        miss. `hit = (1 - u - v) a + u b + v c`; normals are of unit length, (b - a) x (c - a).
        """
        table = _table(rays, "rays", 6)
        hits = self._meshes.built().closest_hit(
            table, columns=("t", "u", "v", "geometry", "triangle", "normals"), invalid="miss",
            threads=nthreads)
        normals = hits.normals
        normals[~hits.hit] = 0
        return {"t_hit": _tensor(hits.t), "geometry_ids": _tensor(_ids(hits.geometry)),
                "primitive_ids": _tensor(_ids(hits.triangle)),
                "primitive_uvs": _tensor(np.stack([hits.u, hits.v], axis=-1)),
                "primitive_normals": _tensor(normals)}

    def test_occlusions(self, rays: Any, tnear: float = 0.0, tfar: float = float("inf"),
                        nthreads: int = 0) -> Any:
        """Whether each ray hits anything at tnear <= t <= tfar: bool."""
        table = _table(rays, "rays", 6)
        return _tensor(self._meshes.built().any_hit(
            table, None, np.float32(tnear), np.float32(tfar), invalid="miss", threads=nthreads))

    def count_intersections(self, rays: Any, nthreads: int = 0) -> Any:
        """How many hits each ray has, one for each geometry and different t: int32."""
        table = _table(rays, "rays", 6)
        scene = self._meshes.built()
        if len(scene.geometries) == 1:
            counts = scene.count_hits(table, distinct=True, invalid="miss", threads=nthreads)
            return _tensor(counts.astype(np.int32))
        flat = table.reshape(-1, 6)
        counts = np.zeros(len(flat), np.int32)
        for first in range(0, len(flat), 1 << 20):  # as lists are long
            rows = slice(first, first + (1 << 20))
            ray = _rows(scene, flat[rows], nthreads)[0]
            counts[rows] = np.bincount(ray, minlength=len(counts[rows]))
        return _tensor(counts.reshape(table.shape[:-1]))

    def list_intersections(self, rays: Any, nthreads: int = 0) -> dict[str, Any]:
        """All hits of each ray, one for each geometry and different t, in the order of t.

        Returns a dict of a row for each hit, ray after ray: `ray_ids, geometry_ids, primitive_ids`
        uint32, `t_hit` float32, `primitive_uvs` (h, 2) float32; and `ray_splits` (rays + 1,)
        uint32: the hits of ray i are the rows ray_splits[i] to ray_splits[i + 1].
        """
        table = _table(rays, "rays", 6).reshape(-1, 6)
        ray, hits, keep = _rows(self._meshes.built(), table, nthreads)
        ends = np.cumsum(np.bincount(ray, minlength=len(table))[:len(table)])
        splits = np.concatenate([np.zeros(1, np.int64), ends])
        uvs = np.stack([hits.u[keep], hits.v[keep]], axis=-1)
        return {"ray_splits": _tensor(_ids(splits)), "ray_ids": _tensor(_ids(ray)),
                "geometry_ids": _tensor(_ids(hits.geometry[keep])),
                "primitive_ids": _tensor(_ids(hits.triangle[keep])),
                "t_hit": _tensor(hits.t[keep]), "primitive_uvs": _tensor(uvs)}

    def compute_closest_points(self, query_points: Any, nthreads: int = 0) -> dict[str, Any]:
        """The point of the surface that is nearest to each point.

        Returns a dict: `points` (.., 3), `geometry_ids` and `primitive_ids` uint32,
        `primitive_uvs` (.., 2) and `primitive_normals` (.., 3), float32. Of equally near triangles
        the first of the first geometry.
        """
        table = _table(query_points, "query_points", 3)
        scene = self._meshes.built()
        flat, good = _finite(table)
        near = scene.nearest(flat, threads=nthreads)
        n = len(good)
        ids = np.full((n, 2), INVALID, np.uint32)
        ids[good, 0], ids[good, 1] = _ids(near.geometry), _ids(near.triangle)
        points = np.full((n, 3), np.nan, np.float32)
        points[good] = near.point
        uvs, normals = np.zeros((n, 2), np.float32), np.zeros((n, 3), np.float32)
        uvs[good, 0], uvs[good, 1] = near.u, near.v
        if n:
            scene._core.normals(ids, True, normals, 0, control(nthreads, None))
        normals[ids[:, 1] == INVALID] = 0
        lead = table.shape[:-1]
        return {"points": _tensor(points.reshape(*lead, 3)),
                "geometry_ids": _tensor(ids[:, 0].reshape(lead)),
                "primitive_ids": _tensor(ids[:, 1].reshape(lead)),
                "primitive_uvs": _tensor(uvs.reshape(*lead, 2)),
                "primitive_normals": _tensor(normals.reshape(*lead, 3))}

    def compute_distance(self, query_points: Any, nthreads: int = 0) -> Any:
        """The distance of each point to the surface: float32."""
        table = _table(query_points, "query_points", 3)
        flat, good = _finite(table)
        result = np.full(len(good), np.nan, np.float32)
        result[good] = self._meshes.built().nearest(flat, threads=nthreads).distance
        return _tensor(result.reshape(table.shape[:-1]))

    def compute_signed_distance(self, query_points: Any, nthreads: int = 0,
                                nsamples: int = 1) -> Any:
        """The same, negative inside. `nsamples` must be odd, and makes no difference."""
        return self._inside("signed_distance", query_points, nthreads, nsamples, np.nan)

    def compute_occupancy(self, query_points: Any, nthreads: int = 0, nsamples: int = 1) -> Any:
        """1 for points that are inside or on the surface, else 0: float32."""
        return self._inside("locate", query_points, nthreads, nsamples, 0)

    def _inside(self, question: str, query_points: Any, nthreads: int, nsamples: int,
                nothing: float) -> Any:
        if nsamples < 1 or nsamples % 2 == 0:
            raise RuntimeError(f"nsamples must be odd and >= 1, but is {nsamples}")
        table = _table(query_points, "query_points", 3)
        flat, good = _finite(table)
        ask = getattr(self._meshes.built(), question)
        if not self._open:
            try:
                found = ask(flat, threads=nthreads)
            except NotClosed:
                self._open = True
        if self._open:
            found = ask(flat, open_mesh=True, threads=nthreads)
        result = np.full(len(good), nothing, np.float32)
        result[good] = found if question == "signed_distance" else found >= 0
        return _tensor(result.reshape(table.shape[:-1]))

    @staticmethod
    def create_rays_pinhole(*args: Any, **kwargs: Any) -> Any:
        """The rays of a camera: float32 (height, width, 6), through the centres of pixels.

        create_rays_pinhole(fov_deg, center, eye, up, width_px, height_px): `fov_deg` from the left
        edge to the right one; rows follow one another along `up`.

        create_rays_pinhole(intrinsic_matrix, extrinsic_matrix, width_px, height_px): (3, 3), and
        (4, 4), from the world to the camera. Of matrices that are no rigid motion Open3D takes the
        transpose for the inverse, and so does this; `pierce.rays.pinhole` refuses them.

        >>> rays = RaycastingScene.create_rays_pinhole(90, [0, 0, 0], [0, 0, 2], [0, 1, 0], 4, 2)
        >>> rays.numpy().shape
        (2, 4, 6)
        """
        by_view = "fov_deg" in kwargs or bool(args) and np.ndim(_array(args[0])) == 0
        rays = _by_view if by_view else _by_matrix
        try:
            return _tensor(rays(*args, **kwargs))
        except ValueError as error:
            raise RuntimeError(str(error)) from error


def _by_view(fov_deg: Any, center: Any, eye: Any, up: Any, width_px: int, height_px: int) -> Array:
    center, eye, up = _array(center), _array(eye), _array(up)
    return pinhole(width_px, height_px, fov=float(fov_deg), center=center, eye=eye, up=up,
                   dtype=np.float32)


def _by_matrix(intrinsic_matrix: Any, extrinsic_matrix: Any, width_px: int,
               height_px: int) -> Array:
    intrinsic = matrix(_array(intrinsic_matrix), 3, "intrinsic_matrix")
    extrinsic = matrix(_array(extrinsic_matrix), 4, "extrinsic_matrix")
    for part, name in ((intrinsic, "intrinsic_matrix"),
                       (extrinsic[:3, :3], "extrinsic_matrix[:3, :3]")):
        if np.linalg.matrix_rank(part) < 3:
            raise ValueError(f"{name} has no inverse, so there are no such rays; give the matrix "
                             "of a camera")
    return rays_of_matrices(width_px, height_px, intrinsic, extrinsic, FLOAT32)


def _finite(table: Array) -> tuple[Array, Array]:
    """The points that are, and which of all these are."""
    flat = table.reshape(-1, 3)
    good = np.asarray(np.isfinite(flat).all(axis=1))
    return (flat if good.all() else flat[good]), good


def _rows(scene: Scene, rays: Array, threads: int) -> tuple[Array, Any, Any]:
    """(ray of each row, hits, which of the hits are rows): one for each geometry and exact t."""
    if len(scene.geometries) == 1:
        hits = scene.all_hits(rays, distinct=True, invalid="miss", threads=threads)
        return hits.ray, hits, slice(None)
    hits = scene.all_hits(rays, invalid="miss", threads=threads)
    first = scene.all_hits(rays, distinct=True, invalid="miss", threads=threads)
    # Of hits at one exact t the first begins a group; groups are in the order (t, geometry).
    ray, begins = hits.ray, np.zeros(len(hits), bool)
    key = np.stack([ray, hits.geometry, hits.triangle])
    heads = np.stack([first.ray, first.geometry, first.triangle])
    begins[_positions(key, heads)] = True
    new = begins.copy()
    new[1:] |= hits.geometry[1:] != hits.geometry[:-1]
    keep = np.flatnonzero(new)
    return ray[keep], hits, keep


def _positions(rows: Array, some: Array) -> Array:
    """Where each of `some` columns is among `rows`; all are different, and in the same order."""
    count = np.array([1, *(rows[1:].max(axis=1, initial=0) + 1)], np.int64)
    weights = np.array([count[1] * count[2], count[2], 1], np.int64)
    number, wanted = weights @ rows, weights @ some
    order = np.argsort(number, kind="stable")
    return np.asarray(order[np.searchsorted(number, wanted, sorter=order)])


_ORIGINALS: dict[str, Any] = {}


def install() -> None:
    """Makes open3d.t.geometry.RaycastingScene this one, until `uninstall`. Needs Open3D."""
    geometry = package("open3d", "pierce.open3d.install").t.geometry
    if not _ORIGINALS:
        _ORIGINALS["RaycastingScene"] = geometry.RaycastingScene
        geometry.RaycastingScene = RaycastingScene


def uninstall() -> None:
    """Undoes `install`."""
    if _ORIGINALS:
        module = package("open3d", "pierce.open3d.uninstall")
        module.t.geometry.RaycastingScene = _ORIGINALS.pop("RaycastingScene")
