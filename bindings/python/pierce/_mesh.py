# SPDX-License-Identifier: Apache-2.0
"""Meshes in: arrays, files, and the meshes of other packages, known by what they offer."""

from __future__ import annotations

import errno
import os
import sys
import warnings
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from . import _core
from ._arrays import FLOAT32, FLOAT64, POINT_COLUMNS, Array, as_array, by_name, real_type, to_real
from ._errors import BadFile, IndexOutOfRange, MeshWarning

KNOWN = ("give (vertices, triangles), a file's path, a mesh of trimesh, pyvista, Open3D or "
         "manifold3d, or a list of these")


@dataclass
class Mesh:
    """One geometry of a scene: arrays as they were given, until `finish` has made them fit."""

    vertices: Array
    triangles: Array
    transform: Array | None
    name: str
    fresh: bool = False  #: nobody else has the arrays

    def finish(self, dtype: np.dtype[Any], copy: bool) -> None:
        copy = copy and not self.fresh
        if not len(self.vertices):
            self.vertices = self.vertices.astype(dtype)
        vertices = to_real(self.vertices, dtype, f"{self.name}vertices", "the mesh")
        self.vertices = kept(vertices, dtype, copy and vertices is self.vertices)
        self.triangles = _kept_triangles(self.triangles, len(self.vertices), self.name, copy)
        self.place(dtype)

    def place(self, dtype: np.dtype[Any]) -> None:
        if self.transform is not None:
            name = f"{self.name}transform"
            try:
                self.transform = to_real(self.transform.tolist(), dtype, name)
            except ValueError as error:
                raise TypeError(f"{error} (vertices are {dtype.name})") from None


def kept(array: Array, dtype: np.dtype[Any], copy: bool) -> Array:
    """In one piece, and, if asked for, nobody else's; read-only."""
    result = (np.array(array, dtype, order="C") if copy else
              np.require(array, dtype, ["C_CONTIGUOUS", "ALIGNED"]))
    view = result.view()
    view.flags.writeable = False
    return view


def _kept_triangles(array: Array, vertices: int, name: str, copy: bool) -> Array:
    if array.dtype == np.uint32:  # the core looks at them
        return kept(array, np.dtype(np.uint32), copy)
    bad = (array < 0) | (array >= vertices)
    if bad.any():
        rows = np.flatnonzero(bad.any(axis=1))
        row = int(rows[0])
        corner = int(array[row][bad[row]][0])
        error = IndexOutOfRange(
            f"{name}triangles: triangle {row} names vertex {corner}, but there are {vertices} "
            f"vertices; {len(rows)} such triangles: drop them, or give indices from 0 on")
        error.index, error.count = row, len(rows)
        raise error
    return kept(array.astype(np.uint32), np.dtype(np.uint32), False)


def _is_transform(value: Any) -> bool:
    if not isinstance(value, np.ndarray):
        if not isinstance(value, (list, tuple)) or len(value) not in (3, 4):
            return False
        return all(isinstance(row, (np.ndarray, list, tuple)) and len(row) == 4 for row in value)
    return value.shape in ((4, 4), (3, 4))


def transform(value: Any, name: str) -> Array:
    matrix, _ = as_array(value, f"{name}transform")
    if matrix.shape not in ((4, 4), (3, 4)):
        raise ValueError(f"{name}transform has the shape {matrix.shape}, not (4, 4) or (3, 4)")
    if matrix.shape == (4, 4):
        if matrix[3].tolist() != [0, 0, 0, 1]:
            raise ValueError(f"{name}transform: the last row is {matrix[3].tolist()}, not "
                             "[0, 0, 0, 1]: no affine map")
        matrix = matrix[:3]
    return np.asarray(matrix, np.float64) if matrix.dtype.kind in "iu" else matrix


def _reshaped(array: Array, name: str) -> str:
    """What to make of an array that is no (n, 3)."""
    if array.ndim == 1 and array.size % 3 == 0:
        return f": give {name}.reshape(-1, 3)"
    if array.ndim == 2 and array.shape[0] == 3:
        return f": give {name}.T"
    return ": triangulate the mesh first" if array.ndim == 2 and name == "triangles" else ""


def _without_counts(corners: Array) -> str:
    """The same for the faces of VTK, where a 3 stands before each three corners."""
    if corners.size % 4 or (corners.reshape(-1, 4)[:, 0] != 3).any():
        return ""
    flat = ".reshape(-1, 4)" if corners.ndim == 1 else ""
    return f": the 3 before each three is no corner, give triangles{flat}[:, 1:]"


def _arrays(vertices: Any, triangles: Any, name: str) -> Mesh:
    points, _ = as_array(by_name(vertices, f"{name}vertices", POINT_COLUMNS), f"{name}vertices")
    corners, _ = as_array(triangles, f"{name}triangles")
    if points.size == 0:
        points = points.reshape(0, 3)
    if points.ndim != 2 or points.shape[1] != 3:
        raise ValueError(f"{name}vertices have the shape {points.shape}, not (n, 3)"
                         f"{_reshaped(points, 'vertices')}")
    if corners.size == 0:
        corners = np.zeros((0, 3), np.uint32)
    if corners.ndim != 2 or corners.shape[1] != 3:
        raise ValueError(f"{name}triangles have the shape {corners.shape}, not (n, 3)"
                         f"{_without_counts(corners) or _reshaped(corners, 'triangles')}")
    if corners.dtype.kind == "f":
        raise TypeError(f"{name}triangles are {corners.dtype.name}; give integers: "
                        "triangles.astype(np.uint32)")
    if corners.dtype.byteorder not in "=|":
        corners = corners.astype(corners.dtype.newbyteorder("="))
    return Mesh(points, corners, None, name)


def _caller() -> int:
    """How many frames up the first one is that is not of this package, as warnings count them."""
    frame, level = sys._getframe(1), 1
    while frame.f_back is not None and frame.f_globals.get("__package__") == __package__:
        frame, level = frame.f_back, level + 1
    return level


def is_scene_file(path: str | bytes) -> bool:
    if os.path.isdir(path):
        return False
    with open(path, "rb") as file:
        return file.read(8) == b"\x89PRC\r\n\x1a\n"


def _file(path: str | bytes, name: str, strict: bool) -> Mesh:
    if not os.path.exists(path):
        raise FileNotFoundError(errno.ENOENT, f"{name}no such mesh file", os.fsdecode(path))
    if is_scene_file(path):
        raise BadFile(f"{name}{os.fsdecode(path)}: is a scene, not a mesh; pierce.open has it back")
    vertices, triangles, remarks = _core.read_mesh(os.fsencode(path))
    if remarks and strict:
        more = f" (the first of {len(remarks)} warnings)" if len(remarks) > 1 else ""
        raise BadFile(f"{name}{os.fsdecode(path)}: {remarks[0]}{more}; strict=True refuses it")
    for remark in remarks:
        warnings.warn(f"{name}{os.fsdecode(path)}: {remark}", MeshWarning, _caller())
    return Mesh(vertices, triangles, None, name, fresh=True)


def _soup(corners: Array, name: str) -> Mesh:
    count = 3 * len(corners)
    index = np.arange(count, dtype=np.uint32).reshape(-1, 3)
    return _arrays(corners.reshape(count, 3), index, name)


def triangles_of_faces(faces: Array) -> Array | None:
    """The corners (n, 3) of VTK's faces, before each of which the number of its corners stands; or
    None if not all are triangles."""
    if len(faces) % 4 or (faces[::4] != 3).any():
        return None
    return faces.reshape(-1, 4)[:, 1:]


def triangles_of_strips(strips: Array) -> tuple[Array, Array]:
    """The corners (n, 3) of VTK's triangle strips, and the strip of each; every other one is turned
    round, as VTK does it."""
    found, strip, at = [np.zeros((0, 3), np.int64)], [np.zeros(0, np.int64)], 0
    while at < len(strips):
        corners = strips[at + 1:at + 1 + strips[at]]
        at += 1 + len(corners)
        some = np.stack([corners[:-2], corners[1:-1], corners[2:]], axis=1)
        some[1::2, :2] = some[1::2, 1::-1]
        found.append(some)
        strip.append(np.full(len(some), len(found) - 2))
    return np.concatenate(found), np.concatenate(strip)


def _of_pyvista(value: Any, name: str) -> Mesh:
    faces, strips = np.asarray(value.faces), np.asarray(value.strips)
    triangles = triangles_of_faces(faces)
    if triangles is None:
        raise ValueError(f"{name}the {type(value).__name__} has faces that are no triangles; give "
                         "mesh.triangulate()")
    if len(strips):
        triangles = np.concatenate([triangles, triangles_of_strips(strips)[0]])
    cells = getattr(value, "n_cells", 0)
    if cells and not len(triangles):
        raise ValueError(f"{name}the {type(value).__name__} holds no triangle: its {cells} cells "
                         "are vertices or lines; give a surface")
    return _arrays(value.points, triangles, name)


def read(value: Any, name: str = "", known: dict[int, Mesh] | None = None,
         strict: bool = False) -> Mesh:
    """One mesh, whatever it is; `known` are those that were placed before, by their ids."""
    if isinstance(value, (str, bytes, os.PathLike)):
        return _file(os.fspath(value), name, strict)
    if isinstance(value, tuple) and len(value) == 2:
        if _is_transform(value[1]):
            known = {} if known is None else known
            mesh = known.get(id(value[0])) or read(value[0], name, None, strict)
            known[id(value[0])] = mesh
            if mesh.transform is not None:
                raise TypeError(f"{name}a placed mesh cannot be placed once more; multiply the "
                                "matrices")
            return replace(mesh, transform=transform(value[1], name), name=name)
        mesh_in_tuple = isinstance(value[0], tuple) and len(value[0]) == 2
        if mesh_in_tuple or isinstance(value[0], (str, bytes, os.PathLike)):
            if isinstance(value[1], type(value[0])):
                raise TypeError(f"{name}a tuple of meshes; give a list of them")
            transform(value[1], name)  # which says what is wrong with it
        return _arrays(value[0], value[1], name)
    if isinstance(value, np.ndarray):
        if value.ndim == 3 and value.shape[1:] == (3, 3):
            return _soup(value, name)
        raise ValueError(f"{name}one array of the shape {value.shape} is no mesh; {KNOWN}, or the "
                         "corners of each triangle as (n, 3, 3)")
    if hasattr(value, "vert_properties") and hasattr(value, "tri_verts"):  # manifold3d.Mesh
        return _arrays(np.asarray(value.vert_properties)[:, :3], value.tri_verts, name)
    if hasattr(value, "to_mesh") and hasattr(value, "status"):  # manifold3d.Manifold
        return read(value.to_mesh(), name)
    if hasattr(value, "vertices") and hasattr(value, "faces"):  # trimesh
        return _arrays(value.vertices, value.faces, name)
    if hasattr(value, "points") and hasattr(value, "faces") and hasattr(value, "strips"):  # pyvista
        return _of_pyvista(value, name)
    if hasattr(value, "points") and hasattr(value, "regular_faces"):
        return _arrays(value.points, value.regular_faces, name)
    if hasattr(value, "vertices") and hasattr(value, "triangles"):  # Open3D, legacy
        return _arrays(np.asarray(value.vertices), np.asarray(value.triangles), name)
    if hasattr(value, "vertex") and hasattr(value, "triangle"):  # Open3D, tensors
        return _arrays(value.vertex.positions, value.triangle.indices, name)
    raise TypeError(f"{name}{type(value).__name__} is no mesh; {KNOWN}")


def read_all(value: Any, triangles: Any, strict: bool = False) -> list[Mesh]:
    """The meshes of a scene, in order."""
    if triangles is not None:
        return [_arrays(value, triangles, "")]
    if isinstance(value, list):
        known: dict[int, Mesh] = {}
        return [read(mesh, f"mesh {i}: ", known, strict) for i, mesh in enumerate(value)]
    return [read(value, "", None, strict)]


def _widen_files(meshes: list[Mesh]) -> None:
    """Beside float64 what files have as float32 becomes that, too, exactly."""
    if all(mesh.vertices.dtype.kind != "f" or mesh.vertices.dtype.itemsize != 8 for mesh in meshes):
        return
    done: dict[int, tuple[Array, Array]] = {}  # what was one array stays one
    for mesh in meshes:
        if mesh.fresh and mesh.vertices.dtype == FLOAT32:
            single = mesh.vertices
            if id(single) not in done:
                done[id(single)] = single, single.astype(FLOAT64)
            mesh.vertices = done[id(single)][1]


def finish(meshes: list[Mesh], copy: bool, dtype: np.dtype[Any] | None = None) -> np.dtype[Any]:
    """Makes all meshes of one type, in arrays that are kept; each array once."""
    if dtype is None:
        _widen_files(meshes)
        some = [mesh for mesh in meshes if len(mesh.vertices)] or meshes
        arrays = [mesh.vertices for mesh in some]
        names = [f"{mesh.name}vertices" for mesh in some]
        dtype = real_type(arrays, names)
        halves = [a.dtype.itemsize == 2 and a.dtype.kind == "f" for a in arrays]
        if halves and all(halves):
            dtype = FLOAT32
    done: dict[tuple[int, int], tuple[Array, Array]] = {}
    held = [(mesh.vertices, mesh.triangles) for mesh in meshes]  # so that no id is used twice
    for mesh, (vertices, corners) in zip(meshes, held):
        key = (id(vertices), id(corners))
        if key in done:
            mesh.vertices, mesh.triangles = done[key]
            mesh.place(dtype)
            continue
        mesh.finish(dtype, copy)
        done[key] = (mesh.vertices, mesh.triangles)
    return dtype
