# SPDX-License-Identifier: Apache-2.0
"""Exact ray casting, containment, distances and voxels for pyvista's meshes.

With pyvista 0.48 or newer every dataset has them at `mesh.pierce`, without an import:
`mesh.pierce.ray_trace(a, b)` instead of `mesh.ray_trace(a, b)`. With older ones call the functions
here, `pierce.pyvista.ray_trace(mesh, a, b)`. Checked against pyvista 0.49.1.

What differs from pyvista, and who is right:

- Every hit is decided exactly for the mesh's numbers, and the points are the exact ones rounded
  once to float64. pyvista (VTK) has a tolerance: it reports hits beside a triangle, and rays that
  lie in the plane of a triangle hit it. Here such a ray hits nothing, which is exact for a triangle
  that it passes within its own plane: there is no first point. `multi_ray_trace` there is trimesh
  with Embree in float32, which loses rays, so that it has `retry`; here that does nothing.
- `select_interior_points` and `implicit_distance` decide the sign of a closed surface exactly, by
  parity, whichever way its faces wind: negative is inside. pyvista goes by normals, and finds the
  inside outside where they point inwards. For open surfaces both go by normals; and
  `check_surface` (of `select_interior_points`) takes pierce's word for what is closed.
- `voxelize` fills the voxels whose centre is inside or on the surface, exactly.
- Polygons of more than three corners are triangulated as pyvista does it; cells are still those of
  the mesh. They need not be planar.
- Each call compares the mesh with what it was at the last, so that changes are seen. Ask for many
  rays in one call.
"""

from __future__ import annotations

from typing import Any, Callable

import numpy as np

from ._arrays import Array
from ._errors import NotClosed
from ._faces import Faces, above
from ._scene import Scene
from ._stand_in import installed, package

__all__ = ["Accessor", "implicit_distance", "multi_ray_trace", "ray_trace", "scene_of",
           "select_interior_points", "voxelize", "voxelize_binary_mask", "voxelize_rectilinear"]


class _Surface:
    """A mesh as it was when it was looked at last, and what was made of it."""

    def __init__(self, points: Array, cells: Array, scene: Scene, cell: Array | None):
        self.points, self.cells = points, cells
        self.scene = scene
        self.cell = cell  #: the mesh's cell of each triangle, None if they are the same
        self._faces: Faces | None = None

    @property
    def faces(self) -> Faces:
        if self._faces is None:
            self._faces = Faces(*self.scene.geometries[0])
        return self._faces

    def cells_of(self, triangle: Array) -> Array:
        return triangle if self.cell is None else self.cell[triangle]


_recent: list[_Surface] = []


def _surface(mesh: Any) -> _Surface:
    if not hasattr(mesh, "faces") or not hasattr(mesh, "n_open_edges"):
        raise TypeError(f"{type(mesh).__name__} is no surface; give a PolyData: "
                        "mesh.extract_surface()")
    points = np.asarray(mesh.points)
    cells = np.concatenate([np.asarray(mesh.faces), np.asarray(mesh.strips)])
    for known in _recent:
        if (known.points.dtype == points.dtype and np.array_equal(known.points, points)
                and np.array_equal(known.cells, cells)):
            return known
    made = _made(mesh, points.copy(), cells.copy())
    _recent.insert(0, made)
    del _recent[4:]
    return made


def _made(mesh: Any, points: Array, cells: Array) -> _Surface:
    corners = points.astype(np.float64)
    plain = mesh.n_cells == 0 or (mesh.is_all_triangles and not len(mesh.strips)
                                  and 4 * mesh.n_cells == len(mesh.faces))
    if plain:
        triangles = np.asarray(mesh.faces).reshape(-1, 4)[:, 1:]
        return _Surface(points, cells, Scene(corners, triangles, copy=False), None)
    numbered = mesh.copy(deep=False)
    numbered.clear_data()
    numbered.cell_data["pierce"] = np.arange(mesh.n_cells)
    split = numbered.triangulate()
    triangles = np.asarray(split.faces).reshape(-1, 4)[:, 1:]
    scene = Scene(np.asarray(split.points, np.float64), triangles)
    return _Surface(points, cells, scene, np.asarray(split.cell_data["pierce"]))


def scene_of(mesh: Any) -> Scene:
    """The pierce.Scene, float64, of a pyvista.PolyData: all else that pierce can answer.

    Its triangles are the cells of the mesh if these are all triangles.
    """
    return _surface(mesh).scene


def _vectors(value: Any, name: str) -> Array:
    table = np.asarray(value, np.float64)
    if table.size == 0:
        table = table.reshape(0, 3)
    if table.ndim == 1:
        table = table[None]
    if table.ndim != 2 or table.shape[1] != 3:
        raise ValueError(f"{name} have the shape {table.shape}, not (n, 3)")
    return table


def ray_trace(mesh: Any, origin: Any, end_point: Any, first_point: bool = False
              ) -> tuple[Array, Array]:
    """Where the segment from `origin` to `end_point` meets the mesh: points, cells.

    Args:
        mesh: a pyvista.PolyData.
        origin, end_point: (3,). Both ends belong to the segment; `end_point - origin` is rounded to
            float64, so that what lies on `end_point` may be missed by that.
        first_point: True: only the first point, of the shape (3,) if there is one.

    Returns float64 (k, 3) and int64 (k,), one row for each different point, in order.
    """
    start, end = (np.asarray(x, np.float64) for x in (origin, end_point))
    if start.size != 3 or end.size != 3:
        raise TypeError("origin and end_point must be three numbers each")
    start, end = start.reshape(1, 3), end.reshape(1, 3)
    surface = _surface(mesh)
    hits = surface.scene.all_hits(start, end - start, t_max=1.0, distinct=True, invalid="miss",
                                  max_hits=1 if first_point else None)
    points = hits.points
    if first_point and len(points):
        points = points[0]
    return points, surface.cells_of(hits.triangle)


def multi_ray_trace(mesh: Any, origins: Any, directions: Any, first_point: bool = False,
                    retry: bool = False) -> tuple[Array, Array, Array]:
    """Where rays meet the mesh: points, rays, cells.

    Args:
        mesh: a pyvista.PolyData of triangles; others raise pyvista's NotAllTrianglesError.
        origins, directions: (n, 3); directions of any length. Rays that are NaN, or whose
            directions are zero, miss.
        first_point: True: only the first of each ray.
        retry: as in pyvista; makes no difference, no ray is lost.

    Returns float64 (k, 3), int64 (k,) and int64 (k,), ray after ray, in order; one row for each
    different point of a ray.
    """
    starts, along = _vectors(origins, "origins"), _vectors(directions, "directions")
    if starts.shape != along.shape:
        raise ValueError(f"origins and directions have the shapes {starts.shape} and "
                         f"{along.shape}; give as many of both")
    surface = _surface(mesh)
    if surface.cell is not None:
        raise package("pyvista", "multi_ray_trace").core.errors.NotAllTrianglesError(
            "Input mesh for multi_ray_trace must be all triangles; triangulate() it.")
    hits = surface.scene.all_hits(starts, along, distinct=True, invalid="miss",
                                  max_hits=1 if first_point else None)
    return hits.points, hits.ray, surface.cells_of(hits.triangle)


def implicit_distance(mesh: Any, surface: Any, inplace: bool = False) -> Any:
    """The mesh with the distance of each point to a surface, as point data "implicit_distance".

    Args:
        mesh: any pyvista.DataSet.
        surface: a pyvista.PolyData.
        inplace: True: writes to the mesh itself.

    float64; negative inside a closed surface, exact and rounded once. Of an open one the size is
    exact, and negative is where its normals do not point.
    """
    made = _surface(surface)
    points = np.asarray(mesh.points, np.float64).reshape(-1, 3)
    try:
        distance = made.scene.signed_distance(points)
    except NotClosed:
        near = made.scene.nearest(points)
        distance = np.where(above(made.scene, made.faces, near, points), near.distance,
                            0.0 - near.distance)
    out = mesh if inplace else mesh.copy()
    out.point_data["implicit_distance"] = distance
    out.set_active_scalars("implicit_distance")
    return out


def select_interior_points(mesh: Any, surface: Any, *, method: str = "signed_distance",
                           inside_out: bool = False, check_surface: bool = True,
                           locator_tolerance: float | None = None) -> Any:
    """The mesh with whether each point is inside a surface, as point data "selected_points".

    Args:
        mesh: any pyvista.DataSet.
        surface: a closed pyvista.PolyData.
        method, locator_tolerance: as in pyvista; make no difference.
        inside_out: True: marks what is outside. Points on the surface are marked either way.
        check_surface: False: answers for a surface that is not closed as well, by its normals;
            True: raises pierce.NotClosed, which is also a RuntimeError here.
    """
    if method not in ("signed_distance", "cell_locator"):
        raise ValueError(f"method is {method!r}; give 'signed_distance' or 'cell_locator'")
    made = _surface(surface)
    points = np.asarray(mesh.points, np.float64).reshape(-1, 3)
    try:
        place = made.scene.locate(points).astype(np.int64)
    except NotClosed as error:
        if check_surface:
            raise SurfaceNotClosed(f"Surface is not closed: {error}") from None
        near = made.scene.nearest(points)
        place = np.where(above(made.scene, made.faces, near, points), -1, 1)
        place[near.distance == 0] = 0
    out = mesh.copy(deep=False)
    if not len(made.scene.geometries[0][1]):
        chosen = np.full(len(points), inside_out)
    else:
        chosen = place <= 0 if inside_out else place >= 0
    out.point_data["selected_points"] = chosen
    out.set_active_scalars("selected_points")
    return out


class SurfaceNotClosed(NotClosed, RuntimeError):
    """The surface must be closed, and is not. pyvista raises RuntimeError for that."""


def _volume(mesh: Any, reference_volume: Any, dimensions: Any, spacing: Any,
            rounding_func: Callable[[Any], Any] | None, estimate: dict[str, Any]) -> Any:
    """The pyvista.ImageData whose points are the voxels' centres."""
    image = package("pyvista", "pierce.pyvista.voxelize").ImageData()
    if reference_volume is not None:
        if any(x is not None for x in (dimensions, spacing, rounding_func)) or estimate:
            raise TypeError("give reference_volume, or what it is made from, not both")
        return reference_volume
    if dimensions is None and spacing is None:  # by the lengths of cells, as pyvista has it
        return mesh.voxelize_binary_mask(rounding_func=rounding_func, **estimate)
    if estimate or dimensions is not None and spacing is not None:
        raise TypeError("give one of dimensions, spacing and cell_length_percentile")
    bounds = np.asarray(mesh.bounds, np.float64)
    size = bounds[1::2] - bounds[::2]
    if dimensions is None:
        counts = np.maximum(size / np.broadcast_to(np.asarray(spacing, np.float64), 3), 1)
        dimensions = np.array((rounding_func or np.round)(counts), int)
    elif rounding_func is not None:
        raise TypeError("rounding_func has no effect on dimensions")
    image.dimensions = dimensions
    image.spacing = size / np.array(image.dimensions)
    image.origin = bounds[::2] + np.array(image.spacing) / 2
    return image


def _cells(mesh: Any, image: Any) -> Array:
    """Which voxels are filled, bool, x fastest."""
    scene = scene_of(mesh)
    counts = np.array(image.dimensions)
    if np.array_equal(image.direction_matrix, np.eye(3)) and (np.array(image.spacing) > 0).all():
        step = np.array(image.spacing, np.float64)
        corner = np.array(image.origin) + (np.array(image.extent[::2]) - 0.5) * step
        return (scene.voxelise(corner, step, counts.tolist()) >= 0).ravel(order="F")
    return scene.locate(np.asarray(image.points, np.float64)) >= 0


def voxelize_binary_mask(mesh: Any, *, background_value: float = 0, foreground_value: float = 1,
                         reference_volume: Any = None, dimensions: Any = None,
                         spacing: Any = None, rounding_func: Callable[[Any], Any] | None = None,
                         **cell_length: Any) -> Any:
    """The closed surface as a pyvista.ImageData with point data "mask".

    Args:
        mesh: a closed pyvista.PolyData.
        background_value, foreground_value: of what is outside, and inside or on the surface.
        reference_volume: a pyvista.ImageData; its points are asked about.
        dimensions: how many points along each axis, which fill the bounds of the mesh.
        spacing: about how far apart they are, a number or (3,); `rounding_func` makes whole numbers
            of points of it, numpy.round if not given.
        cell_length: cell_length_percentile and cell_length_sample_size, as in pyvista, which then
            decides the spacing; as it does if nothing is given.

    Raises pierce.NotClosed.
    """
    if not len(scene_of(mesh).geometries[0][1]):
        raise ValueError("Input mesh must have faces for voxelization.")
    image = _volume(mesh, reference_volume, dimensions, spacing, rounding_func, cell_length)
    filled = _cells(mesh, image)
    values = np.array([background_value, foreground_value])
    if values.dtype.kind in "iub" and 0 <= values.min() and values.max() < 256:
        values = values.astype(np.uint8)
    mask = type(image)()
    mask.extent, mask.spacing, mask.origin = image.extent, image.spacing, image.origin
    mask.direction_matrix = image.direction_matrix
    mask.point_data["mask"] = values[filled.astype(np.intp)]
    mask.set_active_scalars("mask")
    return mask


def _voxel_cells(mesh: Any, options: dict[str, Any]) -> Any:
    """The same with a cell for each of those points, about it."""
    if options.get("dimensions") is not None:
        options["dimensions"] = np.asarray(options["dimensions"]) - 1
    mask = voxelize_binary_mask(mesh, **options)
    step = np.array(mask.spacing)
    cells = type(mask)()
    cells.dimensions = np.array(mask.dimensions) + 1
    cells.spacing, cells.direction_matrix = step, mask.direction_matrix
    first = np.array(mask.extent[::2]) - 0.5
    cells.origin = np.array(mask.origin) + np.array(mask.direction_matrix) @ (first * step)
    cells.cell_data["mask"] = mask.point_data["mask"]
    return cells


def voxelize(mesh: Any, **options: Any) -> Any:
    """The voxels of the closed surface as a pyvista.UnstructuredGrid of cells.

    Options: those of voxelize_binary_mask without the values; `dimensions` are one more than there
    are cells along each axis, as in pyvista.
    """
    cells = _voxel_cells(mesh, options)
    grid = cells.threshold(0.5, scalars="mask")
    for name in list(grid.cell_data):
        del grid.cell_data[name]
    return grid


def voxelize_rectilinear(mesh: Any, **options: Any) -> Any:
    """The same as a pyvista.RectilinearGrid of all cells, with cell data "mask".

    Options: those of voxelize_binary_mask, `dimensions` as in voxelize.
    """
    return _voxel_cells(mesh, options).cast_to_rectilinear_grid()


class Accessor:
    """What pyvista's datasets have at `mesh.pierce`: the functions of pierce.pyvista."""

    def __init__(self, dataset: Any):
        self._dataset = dataset

    @property
    def scene(self) -> Scene:
        """scene_of of this mesh."""
        return scene_of(self._dataset)

    def ray_trace(self, origin: Any, end_point: Any, first_point: bool = False
                  ) -> tuple[Array, Array]:
        """See pierce.pyvista.ray_trace."""
        return ray_trace(self._dataset, origin, end_point, first_point)

    def multi_ray_trace(self, origins: Any, directions: Any, first_point: bool = False,
                        retry: bool = False) -> tuple[Array, Array, Array]:
        """See pierce.pyvista.multi_ray_trace."""
        return multi_ray_trace(self._dataset, origins, directions, first_point, retry)

    def implicit_distance(self, surface: Any, inplace: bool = False) -> Any:
        """See pierce.pyvista.implicit_distance."""
        return implicit_distance(self._dataset, surface, inplace)

    compute_implicit_distance = implicit_distance

    def select_interior_points(self, surface: Any, **options: Any) -> Any:
        """See pierce.pyvista.select_interior_points."""
        return select_interior_points(self._dataset, surface, **options)

    def voxelize(self, **options: Any) -> Any:
        """See pierce.pyvista.voxelize."""
        return voxelize(self._dataset, **options)

    def voxelize_rectilinear(self, **options: Any) -> Any:
        """See pierce.pyvista.voxelize_rectilinear."""
        return voxelize_rectilinear(self._dataset, **options)

    def voxelize_binary_mask(self, **options: Any) -> Any:
        """See pierce.pyvista.voxelize_binary_mask."""
        return voxelize_binary_mask(self._dataset, **options)


def _register() -> None:
    module = installed("pyvista")
    if module is not None and hasattr(module, "register_dataset_accessor"):
        module.register_dataset_accessor("pierce", module.DataSet)(Accessor)


_register()
