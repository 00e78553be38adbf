# SPDX-License-Identifier: Apache-2.0
"""What the stand-ins for other packages share."""

from __future__ import annotations

import functools
import importlib
import threading
from typing import Any

import numpy as np

from . import _mesh
from ._arrays import FLOAT32, Array
from ._scene import Scene


def package(name: str, what: str) -> Any:
    """Another package, imported now; `what` needs it."""
    try:
        return importlib.import_module(name)
    except ImportError as error:
        top = name.partition(".")[0]
        raise ImportError(f"{what} needs {top}: pip install {top} ({error})") from error


@functools.lru_cache(None)
def installed(name: str) -> Any:
    """Another package, imported now, or None where there is none."""
    try:
        return importlib.import_module(name)
    except ImportError:
        return None


class GrowingScene:
    """float32 meshes that are added one after another; the scene is built when it is asked."""

    def __init__(self, threads: int = 0) -> None:
        self._meshes: list[_mesh.Mesh] = []
        self._threads = threads
        self._scene: Scene | None = None
        self._lock = threading.Lock()

    def __len__(self) -> int:
        return len(self._meshes)

    def __getstate__(self) -> Any:
        return [(mesh.vertices, mesh.triangles) for mesh in self._meshes], self._threads

    def __setstate__(self, state: Any) -> None:
        meshes, threads = state
        GrowingScene.__init__(self, threads)
        for vertices, triangles in meshes:
            self.add(vertices, triangles)

    def add(self, vertices: Array, triangles: Array) -> int:
        """Copies a mesh and checks its indices; returns its number."""
        corners = triangles.astype(np.int64, copy=False)
        mesh = _mesh.read((vertices, corners), f"mesh {len(self._meshes)}: ")
        _mesh.finish([mesh], True, FLOAT32)
        with self._lock:
            self._meshes.append(mesh)
            self._scene = None
            return len(self._meshes) - 1

    def built(self) -> Scene:
        """The scene of all meshes so far."""
        with self._lock:
            if self._scene is None:
                meshes: list[Any] = [(mesh.vertices, mesh.triangles) for mesh in self._meshes]
                nothing = (np.zeros((0, 3), np.float32), np.zeros((0, 3), np.uint32))
                self._scene = Scene(meshes or [nothing], threads=self._threads, copy=False)
            return self._scene
