# SPDX-License-Identifier: Apache-2.0
"""The part of pierce.pyvista that makes voxels."""

from __future__ import annotations

from typing import Any, Callable

import numpy as np

from ._arrays import Array, did_you_mean
from ._pyvista_mesh import scene_of
from ._stand_in import package

_CELL_LENGTH = ("cell_length_percentile", "cell_length_sample_size")  # pyvista's


def _volume(mesh: Any, reference_volume: Any, dimensions: Any, spacing: Any,
            rounding_func: Callable[[Any], Any] | None, estimate: dict[str, Any]) -> Any:
    """The pyvista.ImageData whose points are the voxels' centres."""
    if reference_volume is not None:
        if any(x is not None for x in (dimensions, spacing, rounding_func)) or estimate:
            raise TypeError("give reference_volume, or what it is made from, not both")
        return reference_volume
    pyvista = package("pyvista", "pierce.pyvista.voxelize")
    if dimensions is None and spacing is None:  # by the lengths of cells, as pyvista has it
        return pyvista.DataSetFilters.voxelize_binary_mask(mesh, rounding_func=rounding_func,
                                                           **estimate)
    if estimate or dimensions is not None and spacing is not None:
        raise TypeError("give one of dimensions, spacing and cell_length_percentile")
    bounds = np.asarray(mesh.bounds, np.float64)
    size = bounds[1::2] - bounds[::2]
    if dimensions is None:
        counts = np.maximum(size / np.broadcast_to(np.asarray(spacing, np.float64), 3), 1)
        dimensions = np.array((rounding_func or np.round)(counts), int)
    elif rounding_func is not None:
        raise TypeError("rounding_func has no effect on dimensions")
    image = pyvista.ImageData()
    image.dimensions = dimensions
    image.spacing = size / np.array(image.dimensions)
    image.origin = bounds[::2] + np.array(image.spacing) / 2
    return image


def _cells(mesh: Any, image: Any, rule: str, open_mesh: bool) -> Array:
    """Which voxels are filled, bool, x fastest."""
    scene = scene_of(mesh)
    counts = np.array(image.dimensions)
    if np.array_equal(image.direction_matrix, np.eye(3)) and (np.array(image.spacing) > 0).all():
        step = np.array(image.spacing, np.float64)
        corner = np.array(image.origin) + (np.array(image.extent[::2]) - 0.5) * step
        places = scene.voxelise(corner, step, counts.tolist(), rule=rule, open_mesh=open_mesh)
        return (places >= 0).ravel(order="F")
    points = np.asarray(image.points, np.float64)
    return scene.locate(points, rule=rule, open_mesh=open_mesh) >= 0


def voxelize_binary_mask(mesh: Any, *, background_value: float = 0, foreground_value: float = 1,
                         reference_volume: Any = None, dimensions: Any = None,
                         spacing: Any = None, rounding_func: Callable[[Any], Any] | None = None,
                         rule: str = "odd", open_mesh: bool = False, **cell_length: Any) -> Any:
    """The closed surface as a pyvista.ImageData with point data "mask".

    Args:
        mesh: a closed pyvista.PolyData.
        background_value, foreground_value: of what is outside, and inside or on the surface.
        reference_volume: a pyvista.ImageData; its points are asked about.
        dimensions: how many points along each axis, which fill the bounds of the mesh.
        spacing: about how far apart they are, a number or (3,); `rounding_func` makes whole numbers
            of points of it, numpy.round if not given.
        rule, open_mesh: what is inside, and whether the surface may be open, as in Scene.locate.
        cell_length: cell_length_percentile and cell_length_sample_size, as in pyvista, which then
            decides the spacing; as it does if nothing is given.

    Raises pierce.NotClosed.
    """
    for name in cell_length:
        if name not in _CELL_LENGTH:
            known = [*(voxelize_binary_mask.__kwdefaults__ or ()), *_CELL_LENGTH]
            raise TypeError(f"{name} is no option of voxels; there are {', '.join(known)}"
                            f"{did_you_mean(name, known)}")
    if not len(scene_of(mesh).geometries[0][1]):
        raise ValueError("Input mesh must have faces for voxelization.")
    image = _volume(mesh, reference_volume, dimensions, spacing, rounding_func, cell_length)
    filled = _cells(mesh, image, rule, open_mesh)
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
