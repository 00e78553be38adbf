# SPDX-License-Identifier: Apache-2.0
"""Scene: meshes made ready to be asked which triangles rays pierce."""

from __future__ import annotations

import errno
import os
import weakref
from typing import Any

import numpy as np

from . import _core, _mesh
from ._arrays import FLOAT32, POINT_COLUMNS, Array, by_name, to_real, whole
from ._errors import BadFile
from ._list_queries import ListQueries
from ._point_queries import PointQueries
from ._question import NONE, Progress, choice, control, number
from ._ray_queries import RayQueries
from ._view import View, make_view

QUALITIES = ("fast", "balanced", "high", "compact")
FLATTEN_LIMIT = 1 << 29

# What a scene is pickled from, or made of anew; all else of it is of a subclass, or the caller's.
_OWN = ("_core", "_built", "_dtype", "_quality", "_masks", "_file", "_flatten_limit")

# Whose locks a forked child makes anew.
_alive: weakref.WeakSet[Scene] = weakref.WeakSet()


class Scene(RayQueries, PointQueries, ListQueries):
    """Meshes made ready to be asked. Every answer is exact for the numbers given.

    Args:
        mesh: vertices (n, 3) with `triangles`; or a tuple (vertices, triangles); or a mesh of
            trimesh, pyvista, Open3D or manifold3d; or the path of a PLY, STL, OBJ, OFF or glTF
            file; or the corners of each triangle (n, 3, 3); or a tuple (any of these, 4x4
            matrix), which places it; or a list of all these, geometry i being the i-th.
        triangles: (n, 3) integers, indices of vertices from 0 on.
        quality: "fast" builds quickest, "high" answers quickest, "compact" takes least memory.
        masks: None, or 32 bits for each geometry: rays with a `mask` see those that share a bit.
        threads: how many to build with; 0: as many as the machine has.
        progress: True shows a bar on stderr; or a function of the fraction done.
        flatten_limit: of placed meshes: up to so many bytes, every mesh has vertices and a tree of
            its own wherever it is placed; beyond, those placed from the same arrays share one
            tree, slower to ask. 0: always.
        copy: False looks at arrays that already lie right (float32 or float64 vertices, uint32
            triangles, both in one piece) in place; they must then not change.
        strict: of files, what is otherwise only a MeshWarning raises BadFile.

    float32 vertices make a scene whose rays and answers are float32, float64 one of float64;
    integers count as float64. A mixture raises TypeError: nothing is rounded unasked. Only files of
    float32 beside float64 become that, as with the command, since it is exact.

    `save` writes a scene to a file, `pierce.open` has it back in milliseconds.

    Raises NonFiniteVertex and IndexOutOfRange, which name the first bad triangle and how many there
    are, ValueError, TypeError, BadFile and FileNotFoundError. Threads may share a scene; Ctrl-C
    ends whatever it is doing. A million triangles take about 0.3 s on one core, and 60 MB beside
    the arrays. Scenes can be pickled and copied: their arrays are, and the tree is built anew; of
    those from a file the path is, so that all processes share the file's pages.

    >>> scene = Scene([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2]])
    >>> scene
    Scene(float64, 1 triangles)
    >>> scene.closest_hit([0.25, 0.25, 1, 0, 0, -2])
    Hits(t=0.5, u=0.25, v=0.25, w=0.5, geometry=0, triangle=0, facing=0)
    """

    def __init__(self, mesh: Any, triangles: Any = None, *, quality: str = "balanced",
                 masks: Any = None, threads: int = 0, progress: Progress = None,
                 flatten_limit: int = FLATTEN_LIMIT, copy: bool = True, strict: bool = False):
        meshes = _mesh.read_all(mesh, triangles, strict)
        self._build(meshes, _mesh.finish(meshes, copy), quality, masks, flatten_limit, threads,
                    progress)

    def _build(self, meshes: list[_mesh.Mesh], dtype: np.dtype[Any], quality: str, masks: Any,
               flatten_limit: int, threads: int, progress: Progress) -> None:
        level = choice(quality, QUALITIES, "quality")
        self._flatten_limit = number(flatten_limit, "flatten_limit", 2**64 - 1)
        if masks is not None:
            masks = whole(masks, "masks", 0, NONE, ValueError).astype(np.uint32).reshape(-1)
            if len(masks) != len(meshes):
                raise ValueError(f"{len(masks)} masks for {len(meshes)} geometries; give one each")
        core: type[Any] = _core.SceneF if dtype == FLOAT32 else _core.SceneD
        self._dtype, self._quality, self._masks = np.dtype(dtype), quality, masks
        self._file: tuple[str, int] | None = None
        self._take(core(_core_meshes(meshes), level, masks, self._flatten_limit,
                        control(threads, progress)), meshes)

    def _take(self, core: Any, meshes: list[_mesh.Mesh]) -> None:
        core.known = meshes
        self._core = core
        self._built: int = core.version
        _alive.add(self)

    @property
    def _meshes(self) -> list[_mesh.Mesh]:
        meshes: list[_mesh.Mesh] = self._core.known  # which updates change with all else
        return meshes

    def _is_changed(self) -> bool:
        return bool(self._core.version != self._built)

    @property
    def dtype(self) -> np.dtype[Any]:
        """float32 or float64: the type of its vertices, rays and answers."""
        return self._dtype

    @property
    def geometries(self) -> list[tuple[Array, Array]]:
        """(vertices, triangles) of each geometry, not to be written to; before its matrix."""
        return [(mesh.vertices, mesh.triangles) for mesh in self._meshes]

    def info(self) -> dict[str, Any]:
        """Figures: triangles, vertices, degenerate triangles, nodes, leaves, sah_cost, bytes.

        `sah_cost` is the expected cost of a random ray, in nodes of the tree; `bytes` the memory
        beside the arrays. 0.3 s a million triangles, since it tests each for having no area.
        """
        return dict(self._core.info())

    def __repr__(self) -> str:
        count = sum(len(mesh.triangles) for mesh in self._meshes)
        geometries = f"{len(self._meshes)} geometries, " if len(self._meshes) != 1 else ""
        return f"Scene({self._dtype.name}, {geometries}{count} triangles)"

    def _repr_html_(self) -> str:
        rows = "".join(f"<tr><th>{key}</th><td>{value:,}</td></tr>"
                       for key, value in self.info().items())
        return f"<table><tr><th>type</th><td>{self._dtype.name}</td></tr>{rows}</table>"

    def view(self, rays: Any = None, hits: Any = None, *, up: str = "y", height: int = 480) -> View:
        """The scene, rays and hits as a page: shown in notebooks, or written by its `save`.

        Args:
            rays: (..., 6) or (..., 8) as for closest_hit; None: those that `hits` came of, if any.
            hits: Hits or HitLists of this scene; None: the first hit of each ray.
            up: "y" or "z", the axis that points upward at first.
            height: of the frame in a notebook, in pixels.

        One HTML file with all numbers in it, that needs no network: one turns the mesh, and a click
        tells triangle and coordinates. Some 24 bytes a triangle and 43 a ray (doubles: 32 and 85).

        Raises what closest_hit raises; ValueError; IndexOutOfRange for hits of another scene;
        RuntimeError for hits from before an update.

        >>> scene = Scene([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2]])
        >>> scene.view([0.25, 0.25, 1, 0, 0, -2])
        View(1 triangles, 1 rays, 1 hits)
        """
        with self._core.hold():
            return make_view(self, _core_meshes(self._meshes),
                             [mesh.name for mesh in self._meshes], rays, hits, up, height)

    def save(self, path: str | os.PathLike[str], *, threads: int = 0,
             progress: Progress = None) -> None:
        """Writes the scene to a file, which appears when it is complete; see `pierce.open`.

        Args:
            path: the file, .pierce by custom.
            threads, progress: as in Scene.

        About a second a GB, and the disk's time. Placed meshes are written as they are placed.
        Raises BadFile if it cannot be written, ValueError if placed meshes share a tree.

        >>> import tempfile, os
        >>> scene = Scene([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2]])
        >>> with tempfile.TemporaryDirectory() as folder:
        ...     scene.save(os.path.join(folder, "one.pierce"))
        ...     open(os.path.join(folder, "one.pierce"))
        Scene(float64, 1 triangles)
        """
        names = [mesh.name for mesh in self._meshes]
        self._core.save(os.fsencode(path), names, control(threads, progress))

    def __reduce__(self) -> Any:
        more = {name: value for name, value in self.__dict__.items() if name not in _OWN} or None
        if self._file is not None and not self._is_changed():
            return _reopen, (*self._file, type(self)), more
        meshes = [(mesh.vertices, mesh.triangles, mesh.transform) for mesh in self._meshes]
        return _rebuild, (type(self), self._dtype, meshes, self._quality, self._masks,
                          self._flatten_limit), more

    def update(self, vertices: Any = None, *, transforms: Any = None, threads: int = 0,
               progress: Progress = None, copy: bool = True) -> None:
        """Moves the vertices, or the placed meshes; triangles stay.

        A third of the time of building anew, or less; answers are those of a new scene.
        Queries get slower as neighbours part; when info()["sah_cost"] has doubled, it builds anew.

        Args:
            vertices: (n, 3), or a list of these, one for each geometry.
            transforms: a list of 4x4 matrices, one for each geometry.
            threads, progress, copy: as in Scene.

        If it raises, the scene is as it was, also if Ctrl-C or `progress` ends it, which is told 1
        before anything changes. (A signal that comes later is Python's to raise, once all is
        changed.) Waits for other threads' queries to end. Raises what Scene raises, and
        RuntimeError in a callback of a call on the same scene.

        >>> scene = Scene([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2]])
        >>> scene.update([[0, 0, 3], [1, 0, 3], [0, 1, 3]])
        >>> scene.closest_hit([0, 0, 5, 0, 0, -1]).t
        array(2.)
        """
        meshes = [_mesh.Mesh(m.vertices, m.triangles, m.transform, m.name) for m in self._meshes]
        if vertices is not None:
            several = vertices if len(meshes) != 1 or _is_list_of_one(vertices) else [vertices]
            if not isinstance(several, (list, tuple)) or len(several) != len(meshes):
                raise ValueError(f"give a list of {len(meshes)} arrays of vertices, one for each "
                                 "geometry")
            for mesh, new in zip(meshes, several):
                name = mesh.name + "vertices"
                array = to_real(by_name(new, name, POINT_COLUMNS), self._dtype, name)
                if array.shape != mesh.vertices.shape:
                    raise ValueError(f"{name} have the shape {array.shape}, but there were "
                                     f"{mesh.vertices.shape}; build a new scene")
                mesh.vertices = _mesh.kept(array, self._dtype, copy and array is new)
        if transforms is not None:
            if not isinstance(transforms, (list, tuple, np.ndarray)):
                raise TypeError(f"transforms are {type(transforms).__name__}; give a list of "
                                "matrices")
            if len(transforms) != len(meshes):
                raise ValueError(f"{len(transforms)} transforms for {len(meshes)} geometries; give "
                                 "one for each")
            for mesh, matrix in zip(meshes, transforms):
                mesh.transform = _mesh.transform(matrix, mesh.name)
                mesh.place(self._dtype)
        self._core.refit(_core_meshes(meshes), meshes, control(threads, progress))


def open(path: str | os.PathLike[str], *, verify: bool = False, threads: int = 0,
         progress: Progress = None) -> Scene:
    """A scene from the file that `Scene.save`, or the command `pierce build`, wrote.

    Args:
        path: the file. It must not be written to while scenes from it are in use.
        verify: look at every byte of it: checksums, and that nothing leads out of it.
        threads, progress: for that, as in Scene.

    A million triangles take 2 ms: the file is memory, whose pages come in as they are needed, and
    all processes that have it open share them. Answers are those of the scene that was saved.
    Pickling such a scene, until it is updated, pickles its path.

    Raises BadFile, which says what is wrong: no scene file, damaged, cut short, of a newer version;
    so does a query that meets damage for which the file was not looked through. FileNotFoundError.
    """
    return _open(Scene, path, verify, threads, progress)


def _open(kind: type[Scene], path: str | os.PathLike[str], verify: bool, threads: int,
          progress: Progress) -> Scene:
    name = os.fspath(path)
    if not os.path.exists(name):
        raise FileNotFoundError(errno.ENOENT, os.strerror(errno.ENOENT), name)
    bits, quality, fingerprint, masks, geometries = _core.scene_file(os.fsencode(name))
    scene = kind.__new__(kind)
    dtype = np.dtype(np.float32 if bits == 32 else np.float64)
    core: type[Any] = _core.SceneF if bits == 32 else _core.SceneD
    scene._take(core(os.fsencode(name), verify, control(threads, progress)), [
        _mesh.Mesh(_mapped(name, dtype, vertices_at, vertices),
                   _mapped(name, np.dtype(np.uint32), triangles_at, triangles), None, title)
        for title, vertices_at, vertices, triangles_at, triangles in geometries])
    scene._dtype, scene._quality = dtype, QUALITIES[quality]
    scene._masks = None if masks is None else np.array(masks, np.uint32)
    scene._file, scene._flatten_limit = (os.path.abspath(name), fingerprint), FLATTEN_LIMIT
    return scene


def _mapped(path: str, dtype: np.dtype[Any], offset: int, count: int) -> Array:
    if count == 0:  # which no file can be mapped at
        return np.empty((0, 3), dtype)
    return np.memmap(path, dtype, "r", offset, (count, 3)).view(np.ndarray)


def _reopen(path: str, fingerprint: int, kind: type[Scene] = Scene) -> Scene:
    scene = _open(kind, path, False, 0, None)
    if scene._file != (path, fingerprint):
        raise BadFile(f"{path}: is not the scene that was pickled; bring that back")
    return scene


def _after_fork() -> None:
    for scene in _alive:
        scene._core.forget_threads()


if hasattr(os, "register_at_fork"):
    os.register_at_fork(after_in_child=_after_fork)


def _rebuild(kind: type[Scene], dtype: Any, meshes: list[Any], quality: str, masks: Any,
             flatten_limit: int) -> Scene:
    scene = kind.__new__(kind)
    made = [_mesh.Mesh(vertices, triangles, transform, "")
            for vertices, triangles, transform in meshes]
    scene._build(made, dtype, quality, masks, flatten_limit, 0, None)
    return scene


def _is_list_of_one(vertices: Any) -> bool:
    """Whether these are a list of one array of vertices, and no vertices."""
    if not isinstance(vertices, (list, tuple)) or len(vertices) != 1:
        return False
    names = getattr(getattr(vertices[0], "dtype", None), "names", None)
    return names is not None or np.ndim(vertices[0]) == 2


def _core_meshes(meshes: list[_mesh.Mesh]) -> list[tuple[Array, Array, Array | None]]:
    return [(mesh.vertices, mesh.triangles,
             None if mesh.transform is None else np.ascontiguousarray(mesh.transform))
            for mesh in meshes]
