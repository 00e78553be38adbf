# SPDX-License-Identifier: Apache-2.0
"""What people ask of a mesh by itself: how large, is it closed, does it meet itself."""

from __future__ import annotations

from typing import Any

import numpy as np

from . import _core, _mesh
from ._arrays import FLOAT32, Array
from ._question import Progress, choice, control
from ._scene import Scene

SAME = ("index", "position")  # in the order of SameVertex


def _one(mesh: Any, triangles: Any) -> _mesh.Mesh:
    meshes = mesh._meshes if isinstance(mesh, Scene) else _mesh.read_all(mesh, triangles)
    if len(meshes) != 1:
        raise ValueError(f"{len(meshes)} meshes; give one at a time")
    if meshes[0].transform is not None:
        raise ValueError("a placed mesh has other measures than the mesh; give it without its "
                         "matrix, or with its vertices where they are")
    if not isinstance(mesh, Scene):
        _mesh.finish(meshes, False)
    one: _mesh.Mesh = meshes[0]
    return one


def measure(mesh: Any, triangles: Any = None, *, same: str = "index", threads: int = 0
            ) -> dict[str, Any]:
    """How large a mesh is, and how its triangles hang together.

    Args:
        mesh, triangles: as in Scene, of one mesh, not placed; or a Scene of such a one.
        same: when two corners are the same vertex: "index", or "position" where their coordinates
            are equal, for meshes whose vertices are not shared (STL).
        threads: as in Scene.

    Gives, as a dict, `volume` (negative if the triangles face inward; of an open mesh: with the
    cones from the origin to its open edges) and `area`, both rounded once from exact or very long
    sums; `vertices` that triangles use, `edges`, `triangles` with three vertices, `euler` (vertices
    - edges + triangles: 2 a sphere, 0 a torus), `components` without a vertex in common;
    `consistent`: neighbours face the same way; `orientable`: they could.

    Raises IndexOutOfRange, NonFiniteVertex, and what reading a mesh raises.

    >>> import pierce
    >>> corners = [[0, 0, 0], [3, 0, 0], [0, 3, 0], [0, 0, 3]]
    >>> size = pierce.measure(corners, [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]])
    >>> size["volume"], size["euler"], size["components"], size["consistent"]
    (4.5, 2, 1, True)
    """
    one = _one(mesh, triangles)
    ask = (_core.measure_float if one.vertices.dtype == FLOAT32 else _core.measure_double)
    return ask(one.vertices, one.triangles, choice(same, SAME, "same"), control(threads, None))


def closedness(mesh: Any, triangles: Any = None, *, same: str = "index", threads: int = 0
               ) -> dict[str, Any]:
    """Is a mesh closed, and if not, what is wrong and where?

    Args:
        mesh, triangles, same, threads: as in `measure`.

    Gives, as a dict: `closed`, every edge is used exactly once each way; `balanced`, as often one
    way as the other (closed surfaces may touch along it), which is what crossings and winding
    numbers need; `even`, an even number of times, some triangles may face the wrong way;
    `watertight`, `watertight_even`: balanced, or even, once every edge is cut where others on its
    line end (T-junctions), for same="position". Then how many there are: `edges`, `open_edges` of a
    single triangle, `unbalanced_edges`, `odd_edges`, `crowded_edges` that are balanced but used
    more than once each way, `unbalanced_in_pieces` and `odd_in_pieces`, which cutting mends. And
    the first offender, None or a dict of `triangle`, `edge` (its two vertices), `other_triangle`,
    and how often it is used `forward` and `backward`: `first_unbalanced`, `first_odd`,
    `first_crowded`.

    Raises what `measure` raises. A mesh that is closed by position alone can be welded: `weld`.

    >>> import pierce
    >>> corners = [[0, 0, 0], [3, 0, 0], [0, 3, 0], [0, 0, 3]]
    >>> found = pierce.closedness(corners, [[0, 2, 1], [0, 1, 3], [0, 3, 2]])
    >>> found["closed"], found["open_edges"], found["first_unbalanced"]["edge"]
    (False, 3, (2, 1))
    """
    one = _one(mesh, triangles)
    ask = _core.closedness_float if one.vertices.dtype == FLOAT32 else _core.closedness_double
    return ask(one.vertices, one.triangles, choice(same, SAME, "same"), control(threads, None))


def self_intersections(mesh: Any, triangles: Any = None, *, threads: int = 0,
                       progress: Progress = None) -> Array:
    """The pairs of triangles that share more than they should: (n, 2) int64, ascending. Exact.

    Args:
        mesh, triangles: as in `measure`.
        threads, progress: as in Scene.

    They should share nothing, or a corner or an edge that both have, by position. So neighbours are
    no pair, unless they are folded onto each other; triangles with the same corners are one.
    Triangles without area are left out. Raises what `measure` raises.

    >>> import pierce
    >>> corners = [[0, 0, 0], [4, 0, 0], [0, 4, 0], [1, 1, -1], [1, 1, 1], [9, 9, 0]]
    >>> pierce.self_intersections(corners, [[0, 1, 2], [3, 4, 5]]).tolist()
    [[0, 1]]
    """
    one = _one(mesh, triangles)
    ask = (_core.self_intersections_float if one.vertices.dtype == FLOAT32
           else _core.self_intersections_double)
    return np.stack(ask(one.vertices, one.triangles, control(threads, progress)), axis=-1)
