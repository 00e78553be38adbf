# SPDX-License-Identifier: Apache-2.0
"""Exact ray casting, containment, distances and voxels for pyvista's meshes.

With pyvista 0.48 or newer every dataset has them at `mesh.pierce`, without an import:
`mesh.pierce.ray_trace(a, b)` instead of `mesh.ray_trace(a, b)`. With older ones call the functions
here, `pierce.pyvista.ray_trace(mesh, a, b)`; or `install()` once, and `mesh.ray_trace` is this one.
Checked against pyvista 0.49.1.

What differs from pyvista, and who is right:

- Every hit is decided exactly for the mesh's numbers, and the points are the exact ones rounded
  once to float64, in the order of the segment. pyvista 0.49.1 sorts them by their coordinates, so
  that the one that it gives with `first_point=True` is often not the first:

  >>> sheets = np.array([[0, 0, z] for z in (1, 2)] + [[9, 0, z] for z in (1, 2)]
  ...                   + [[0, 9, z] for z in (1, 2)], float)
  >>> mesh = type("Mesh", (), {"points": sheets, "faces": np.array([3, 0, 2, 4, 3, 1, 3, 5]),
  ...             "strips": np.zeros(0, int), "n_open_edges": 6})()  # as much of a PolyData as
  ...                                                                # is asked for
  >>> ray_trace(mesh, [1, 1, 0], [1, 1, 3], first_point=True)[0]  # pyvista 0.49.1: [1, 1, 2]
  array([1., 1., 1.])

  With `first_point=True` `cells` has the cell of that point alone, there of all points.
- A segment that lies in the plane of a triangle hits it in pyvista, and not here: it meets it in a
  segment of points, none of which it pierces.
- `multi_ray_trace` there is trimesh with Embree in float32, which loses rays, so that it has
  `retry`; here that does nothing.
- `select_interior_points` and `implicit_distance` decide the sign of a closed surface exactly, by
  parity, whichever way its faces wind: negative is inside. pyvista goes by normals, and finds the
  inside outside where they point inwards. For open surfaces both go by normals; and
  `check_surface` (of `select_interior_points`) takes pierce's word for what is closed.
- `voxelize` fills the voxels whose centre is inside or on the surface, exactly.
- Polygons of more than three corners and strips are triangulated as pyvista does it; cells are
  still those of the mesh, and are numbered as in VTK: vertices, lines, polygons, strips. Polygons
  need not be planar.
- Each call compares the mesh with what it was at the last, so that changes are seen. Ask for many
  rays in one call.
"""

from __future__ import annotations

import functools
from typing import Any, Callable

import numpy as np

from ._arrays import Array
from ._errors import NotClosed
from ._faces import above
from ._pyvista_mesh import scene_of, surface_of
from ._pyvista_voxels import voxelize, voxelize_binary_mask, voxelize_rectilinear
from ._scene import Scene
from ._stand_in import installed, package

__all__ = ["Accessor", "implicit_distance", "install", "multi_ray_trace", "ray_trace", "scene_of",
           "select_interior_points", "uninstall", "voxelize", "voxelize_binary_mask",
           "voxelize_rectilinear"]


def _vectors(value: Any, name: str) -> Array:
    table = np.asarray(value, np.float64)
    if table.size == 0:
        table = table.reshape(0, 3)
    if table.ndim == 1:
        table = table[None]
    if table.ndim != 2 or table.shape[1] != 3:
        raise ValueError(f"{name} have the shape {table.shape}, not (n, 3)")
    return table


def ray_trace(mesh: Any, origin: Any, end_point: Any, first_point: bool = False,
              plot: bool = False, off_screen: bool | None = None) -> tuple[Array, Array]:
    """Where the segment from `origin` to `end_point` meets the mesh: points, cells.

    Args:
        mesh: a pyvista.PolyData.
        origin, end_point: (3,). Both ends belong to the segment; `end_point - origin` is rounded to
            float64, so that what lies on `end_point` may be missed by that.
        first_point: True: only the first point, of the shape (3,) if there is one.
        plot, off_screen: True shows the mesh, the segment and the points.

    Returns float64 (k, 3) and int64 (k,), one row for each different point, in order.
    """
    start, end = (np.asarray(x, np.float64) for x in (origin, end_point))
    if start.size != 3 or end.size != 3:
        raise TypeError("origin and end_point must be three numbers each")
    start, end = start.reshape(1, 3), end.reshape(1, 3)
    surface = surface_of(mesh)
    hits = surface.built.all_hits(start, end - start, t_max=1.0, distinct=True, invalid="miss",
                                  max_hits=1 if first_point else None)
    points = hits.points
    if first_point and len(points):
        points = points[0]
    if plot:
        plotter = package("pyvista", "plot=True").Plotter(off_screen=off_screen)
        plotter.add_mesh(mesh)
        plotter.add_lines(np.concatenate([start, end]), color="b")
        if points.size:
            plotter.add_points(points, color="r", point_size=10)
        plotter.show()
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
    surface = surface_of(mesh)
    if surface.cell is not None:
        raise package("pyvista", "multi_ray_trace").core.errors.NotAllTrianglesError(
            "Input mesh for multi_ray_trace must be all triangles; triangulate() it.")
    hits = surface.built.all_hits(starts, along, distinct=True, invalid="miss",
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
    made = surface_of(surface)
    points = np.asarray(mesh.points, np.float64).reshape(-1, 3)
    try:
        distance = made.built.signed_distance(points)
    except NotClosed:
        near = made.built.nearest(points)
        distance = np.where(above(made.built, made.faces, near, points), near.distance,
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
        method, locator_tolerance: as in pyvista; make no difference, but the tolerance is refused
            where pyvista refuses it.
        inside_out: True: marks what is outside. Points on the surface are marked either way.
        check_surface: False: answers for a surface that is not closed as well, by its normals;
            True: raises pierce.NotClosed, which is also a RuntimeError here.
    """
    if method not in ("signed_distance", "cell_locator"):
        raise ValueError(f"method is {method!r}; give 'signed_distance' or 'cell_locator'")
    if method == "signed_distance" and locator_tolerance is not None:
        raise ValueError("locator_tolerance cannot be used with the signed_distance method: leave "
                         "it out")
    made = surface_of(surface)
    points = np.asarray(mesh.points, np.float64).reshape(-1, 3)
    try:
        place = made.built.locate(points).astype(np.int64)
    except NotClosed as error:
        if check_surface:
            said = str(error).replace("open_mesh=True or rule='winding'", "check_surface=False")
            raise SurfaceNotClosed(f"Surface is not closed: {said}") from None
        near = made.built.nearest(points)
        place = np.where(above(made.built, made.faces, near, points), -1, 1)
        place[near.distance == 0] = 0
    out = mesh.copy(deep=False)
    if not len(made.built.geometries[0][1]):
        chosen: Array = np.full(len(points), inside_out)
    else:
        chosen = place <= 0 if inside_out else place >= 0
    out.point_data["selected_points"] = chosen
    out.set_active_scalars("selected_points")
    return out


class SurfaceNotClosed(NotClosed, RuntimeError):
    """The surface must be closed, and is not. pyvista raises RuntimeError for that."""


class Accessor:
    """What pyvista's datasets have at `mesh.pierce`: the functions of pierce.pyvista."""

    def __init__(self, dataset: Any):
        self._dataset = dataset

    @property
    def scene(self) -> Scene:
        """scene_of of this mesh."""
        return scene_of(self._dataset)

    def ray_trace(self, origin: Any, end_point: Any, first_point: bool = False,
                  **options: Any) -> tuple[Array, Array]:
        """See pierce.pyvista.ray_trace."""
        return ray_trace(self._dataset, origin, end_point, first_point, **options)

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


_ORIGINALS: dict[str, Any] = {}
_METHODS: dict[str, Callable[..., Any]] = {
    "ray_trace": ray_trace, "multi_ray_trace": multi_ray_trace,
    "select_interior_points": select_interior_points,
    "compute_implicit_distance": implicit_distance, "voxelize": voxelize,
    "voxelize_rectilinear": voxelize_rectilinear, "voxelize_binary_mask": voxelize_binary_mask}


def _class_of(name: str) -> Any:
    module = package("pyvista", "pierce.pyvista.install")
    return module.PolyData if name.endswith("ray_trace") else module.DataSet


def install() -> None:
    """Makes the methods of pyvista's meshes these, until `uninstall`, so that programs stay.

    Those of the names above, `mesh.compute_implicit_distance` and so on. Needs pyvista 0.46.
    """
    for name, function in _METHODS.items():
        if name not in _ORIGINALS:
            where = _class_of(name)
            _ORIGINALS[name] = where.__dict__.get(name)
            setattr(where, name, _as_method(function))


def _as_method(function: Callable[..., Any]) -> Callable[..., Any]:
    @functools.wraps(function)
    def method(mesh: Any, *args: Any, **options: Any) -> Any:
        options.pop("progress_bar", None)
        return function(mesh, *args, **options)

    return method


def uninstall() -> None:
    """Undoes `install`."""
    while _ORIGINALS:
        name, original = _ORIGINALS.popitem()
        if original is None:  # inherited
            delattr(_class_of(name), name)
        else:
            setattr(_class_of(name), name, original)


def _register() -> None:
    module = installed("pyvista")
    if module is not None and hasattr(module, "register_dataset_accessor"):
        module.register_dataset_accessor("pierce", module.DataSet)(Accessor)


_register()
