# SPDX-License-Identifier: Apache-2.0
"""The meshes of these examples: (vertices (n, 3), triangles (m, 3)), fronts outward, z is up."""

import numpy as np


def surface(points, closed=(True, True)):
    """Triangles over a grid of points (rows, columns, 3), closed on itself along either side."""
    rows, columns = points.shape[:2]
    i, j = np.meshgrid(np.arange(rows - (not closed[0])), np.arange(columns - (not closed[1])),
                       indexing="ij")
    i, j, down, right = i.ravel(), j.ravel(), (i.ravel() + 1) % rows, (j.ravel() + 1) % columns
    a, b, c, d = (p * columns + q for p, q in ((i, j), (down, j), (down, right), (i, right)))
    triangles = np.concatenate([np.stack([a, b, c], axis=1), np.stack([a, c, d], axis=1)])
    return points.reshape(-1, 3), triangles


def join(*meshes):
    """Several meshes as one."""
    starts = np.cumsum([0] + [len(vertices) for vertices, _ in meshes])
    return (np.concatenate([vertices for vertices, _ in meshes]),
            np.concatenate([triangles + start for (_, triangles), start in zip(meshes, starts)]))


def box(lower, upper):
    """A box, twelve triangles."""
    corners = np.array([[x, y, z] for x in (0, 1) for y in (0, 1) for z in (0, 1)])
    quads = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
    triangles = [t for a, b, c, d in quads for t in ((a, b, c), (a, c, d))]
    return np.where(corners, upper, np.array(lower, float)), np.array(triangles)


def ball(center, radius, around=24):
    """A sphere of 2 around^2 triangles, without its degenerate ones at the poles' rows."""
    turn = 2 * np.pi * np.arange(around) / around
    height = np.pi * (np.arange(around) + 0.5) / around
    ring = np.stack([np.outer(np.sin(height), np.cos(turn)), np.outer(np.sin(height), np.sin(turn)),
                     np.outer(np.cos(height), np.ones(around))], axis=-1)
    vertices, triangles = surface(ring, closed=(False, True))
    poles = np.array([[0, 0, 1], [0, 0, -1]])
    j = np.arange(around)
    k, last, top = (j + 1) % around, (around - 1) * around, around * around
    caps = np.concatenate([np.stack([np.full(around, top), j, k], axis=1),
                           np.stack([np.full(around, top + 1), last + k, last + j], axis=1)])
    vertices = np.concatenate([vertices, poles])
    return center + radius * vertices, np.concatenate([triangles, caps])


def knot(along=600, around=48, thickness=0.4):
    """A tube about a trefoil knot: closed, of genus one."""
    t = 2 * np.pi * np.arange(along) / along
    line = np.stack([np.sin(t) + 2 * np.sin(2 * t), np.cos(t) - 2 * np.cos(2 * t),
                     -np.sin(3 * t)], axis=1)
    ahead = np.roll(line, -1, axis=0) - np.roll(line, 1, axis=0)
    ahead /= np.linalg.norm(ahead, axis=1, keepdims=True)
    side = np.cross(ahead, [0, 0, 1])
    side /= np.linalg.norm(side, axis=1, keepdims=True)
    up = np.cross(side, ahead)
    s = 2 * np.pi * np.arange(around) / around
    ring = np.cos(s)[:, None] * side[:, None] + np.sin(s)[:, None] * up[:, None]
    return surface(line[:, None] + thickness * ring)


def terrain(size=257, extent=10.0):
    """Mountains, a height field over a square: noise whose waves are the higher the longer."""
    waves = np.hypot(*np.meshgrid(np.fft.fftfreq(size), np.fft.fftfreq(size), indexing="ij"))
    waves[0, 0] = np.inf
    noise = np.fft.fft2(np.random.default_rng(8).standard_normal((size, size)))
    z = np.fft.ifft2(noise * waves**-2.4).real
    z = 3.4 * (z - z.min()) / (z.max() - z.min())
    x, y = np.meshgrid(np.linspace(0, extent, size), np.linspace(0, extent, size), indexing="ij")
    return surface(np.stack([x, y, z], axis=-1), closed=(False, False))


def street(length=120.0):
    """A straight street along x: ground, houses, cars, trees."""
    random = np.random.default_rng(7)
    parts = [box((-length, -40, -0.5), (length, 40, 0))]
    for side in (-1, 1):
        x = -length
        while x < length:
            width, depth, height = random.uniform((8, 8, 5), (20, 16, 18))
            near, far = sorted((side * 11, side * (11 + depth)))
            parts.append(box((x, near, 0), (x + width, far, height)))
            x += width + random.choice([0, 0, 3, 6])
        for x in np.arange(-length, length, 14) + random.uniform(0, 8):
            parts.append(box((x - 0.15, side * 8 - 0.15, 0), (x + 0.15, side * 8 + 0.15, 3)))
            parts.append(ball((x, side * 8, 4.2), 1.8, around=10))
        for x in np.arange(-length, length, 6):
            if random.random() < 0.6:
                y = side * 5.2
                parts.append(box((x, y - 0.9, 0.3), (x + 4.2, y + 0.9, 0.95)))
                parts.append(box((x + 0.9, y - 0.8, 0.95), (x + 3.3, y + 0.8, 1.5)))
    return join(*parts)


def bracket(around=160):
    """A pipe whose bore is off its axis and tapers, with flat ends: walls of every thickness."""
    s = 2 * np.pi * np.arange(around) / around
    circle = np.stack([np.cos(s), np.sin(s), np.zeros(around)], axis=1)
    rings = []
    for z in np.linspace(-1.5, 1.5, 41):  # up the outer wall,
        rings.append((1 + 0.12 * np.cos(6 * s) * (1 - (z / 1.5)**2))[:, None] * circle + (0, 0, z))
    for z in np.linspace(1.5, -1.5, 41):  # and down the bore
        rings.append((0.62 + 0.1 * z) * circle + (0.16, 0, z))
    vertices, triangles = surface(np.array(rings))
    return vertices, triangles[:, ::-1]


def volume(mesh):
    """The signed volume of a closed mesh: positive if its fronts are outward."""
    corners = mesh[0][mesh[1]]
    return np.einsum("ni,ni->", corners[:, 0], np.cross(corners[:, 1], corners[:, 2])) / 6
