# SPDX-License-Identifier: Apache-2.0
"""Meshes to test with, and strategies of hypothesis that make nasty ones."""

import numpy as np
from hypothesis import strategies as st

TETRAHEDRON = (np.array([[0, 0, 0], [4, 0, 0], [0, 4, 0], [0, 0, 4]], float),
               np.array([[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]], np.uint32))
SQUARE = (np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]], float),
          np.array([[0, 1, 2], [0, 2, 3]], np.uint32))
CUBE = (np.array([[x, y, z] for x in (0, 2) for y in (0, 2) for z in (0, 2)], float),
        np.array([[0, 1, 3], [0, 3, 2], [4, 6, 7], [4, 7, 5], [0, 4, 5], [0, 5, 1], [2, 3, 7],
                  [2, 7, 6], [0, 2, 6], [0, 6, 4], [1, 5, 7], [1, 7, 3]], np.uint32))


def grid(n, dtype=np.float64):
    """A square of n x n cells with bumps, two triangles each."""
    x, y = np.meshgrid(np.arange(n + 1), np.arange(n + 1), indexing="ij")
    z = ((x * 7 + y * 13) % 5) / 8
    vertices = np.stack([x, y, z], axis=-1).reshape(-1, 3).astype(dtype)
    i = (np.arange(n)[:, None] * (n + 1) + np.arange(n)).reshape(-1)
    lower = np.stack([i, i + n + 1, i + 1], axis=-1)
    upper = np.stack([i + 1, i + n + 1, i + n + 2], axis=-1)
    return vertices, np.concatenate([lower, upper]).astype(np.uint32)


def sheets(n):
    """n equal squares, one above the other: a ray through them hits 2 n triangles at an edge."""
    vertices = np.tile(SQUARE[0], (n, 1))
    vertices[:, 2] = np.repeat(np.arange(n), 4)
    first = np.repeat(4 * np.arange(n, dtype=np.uint32), 2)
    return vertices, np.tile(SQUARE[1], (n, 1)) + first[:, None]


# Few numbers, so that edges, corners and planes are met exactly; some with all bits set.
few = st.sampled_from([0.0, -0.0, 1.0, 2.0, 3.0, -1.0, 0.5, 1 + 2.0**-23])
wild = st.sampled_from([1e-30, -1e30, 2.0**-140, 3.0, 0.1, 1 / 3, -7e5, 16777217.0, 0.0])
usual = st.floats(-100, 100, width=32)


@st.composite
def scenes(draw, dtype):
    """(vertices, triangles, rays (n, 8)) in numbers that the type has."""
    number = draw(st.sampled_from([few, few, wild, usual]))

    def table(rows, columns):
        flat = draw(st.lists(number, min_size=rows * columns, max_size=rows * columns))
        return np.array(flat, np.float32).astype(dtype).reshape(rows, columns)

    count = draw(st.integers(3, 7))
    vertices = table(count, 3)
    corner = st.integers(0, count - 1)
    triangles = draw(st.lists(st.tuples(corner, corner, corner), min_size=1, max_size=8))
    rays = np.zeros((draw(st.integers(1, 4)), 8), dtype)
    rays[:, :6] = table(len(rays), 6)
    rays[np.all(rays[:, 3:6] == 0, axis=1), 5] = 1
    rays[:, 6] = draw(st.sampled_from([0, -np.inf, -1, 0.25]))
    rays[:, 7] = draw(st.sampled_from([np.inf, 1, 2]))
    return vertices, np.array(triangles, np.uint32), rays


@st.composite
def closed_meshes(draw, dtype):
    """Tetrahedra that may touch, overlap and coincide, all facing outwards or all inwards."""
    solids, number = [], 0
    for _ in range(draw(st.integers(1, 3))):
        flat = draw(st.lists(st.integers(-2, 3), min_size=12, max_size=12))
        solids.append((np.array(flat, dtype).reshape(4, 3), TETRAHEDRON[1] + np.uint32(number)))
        number += 4
    return (np.concatenate([vertices for vertices, _ in solids]),
            np.concatenate([triangles for _, triangles in solids]))
