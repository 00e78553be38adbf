# SPDX-License-Identifier: Apache-2.0
"""Rays that people need: cameras, lidars, bundles from points and between them.

Each function returns an array (..., 6), `ox oy oz dx dy dz`, or (..., 8), with `t_min t_max`, as
the queries of a Scene take it, and answers come in its shape: pictures as pictures. Everything is
computed in float64 and rounded once to `dtype`; give the scene's, `dtype=scene.dtype`. Angles are
in degrees, lengths in the scene's unit.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from ._arrays import Array
from ._sensors import SENSORS, Sensor
from ._vectors import count as whole
from ._vectors import float_type, number, real, unit, vector

__all__ = ["SENSORS", "Sensor", "between", "grid", "hemisphere", "lidar", "orthographic", "pinhole",
           "sphere"]

_GOLDEN = (np.sqrt(5.0) - 1) / 2  # the fraction whose multiples spread most evenly


def _rays(origins: Array, directions: Array, dtype: np.dtype[Any], *ends: Any) -> Array:
    shape = np.broadcast_shapes(origins.shape[:-1], directions.shape[:-1])
    result = np.empty((*shape, 6 + len(ends)), dtype)
    result[..., 0:3] = origins
    result[..., 3:6] = directions
    for column, end in enumerate(ends, 6):
        result[..., column] = end
    return result


def _view(center: Any, eye: Any, up: Any) -> tuple[Array, Array]:
    """The camera's rotation, rows x, y along `up`, z from eye to center; and the eye."""
    at, target = vector(eye, "eye"), vector(center, "center")
    z = unit(target - at, "center - eye")
    x = np.cross(unit(vector(up, "up"), "up"), z)
    if np.abs(x).max() < 1e-12:
        raise ValueError("up is along the line of sight; give another one")
    x = unit(x, "up")
    return np.stack([x, np.cross(z, x), z]), at


def _pixels(width: Any, height: Any) -> tuple[Array, Array]:
    """Centres of pixels, (height, width) each."""
    x, y = whole(width, "width"), whole(height, "height")
    columns, rows = np.meshgrid(np.arange(x) + 0.5, np.arange(y) + 0.5)
    return columns, rows


def matrix(value: Any, size: int, name: str) -> Array:
    """Finite numbers, (size, size)."""
    numbers = real(value, name)
    if numbers.shape != (size, size):
        raise ValueError(f"{name} has the shape {numbers.shape}, not ({size}, {size})")
    return numbers


def pinhole(width: int, height: int, *, fov: float | None = None, center: Any = None,
            eye: Any = None, up: Any = None, intrinsic: Any = None, extrinsic: Any = None,
            dtype: Any = np.float64) -> Array:
    """The rays of a camera: (height, width, 6).

    Give `fov`, `center`, `eye` and `up`, or `intrinsic` and `extrinsic`. Both mean what Open3D's
    create_rays_pinhole means by them:

    Args:
        width, height: of the picture in pixels. Rays go through the pixels' centres.
        fov: degrees from the left edge to the right one, less than 180.
        center: a point that the camera looks at.
        eye: where it is.
        up: rows of the picture follow one another along this direction. So the picture is upright
            with the direction that is *down* in the world, (0, 0, -1) if z is up; or turn it,
            `rays[::-1, ::-1]`.
        intrinsic: (3, 3), the upper triangular matrix of the camera.
        extrinsic: (4, 4), from the world to the camera: x right, y down, z ahead.
        dtype: float32 or float64.

    Directions are 1 long along the line of sight, so t is the depth that depth cameras report.

    >>> rays = pinhole(4, 2, fov=90, center=(0, 0, 0), eye=(0, 0, -5), up=(0, 1, 0))
    >>> rays.shape, rays[0, 0].round(6).tolist()
    ((2, 4, 6), [0.0, 0.0, -5.0, -0.75, -0.25, 1.0])
    """
    kind = float_type(dtype)
    by_view, by_matrix = (fov, center, eye, up), (intrinsic, extrinsic)
    if all(x is not None for x in by_view) and all(x is None for x in by_matrix):
        angle = number(fov, "fov")
        if not 0 < angle < 180:
            raise ValueError(f"fov is {angle}; give degrees between 0 and 180")
        columns, rows = _pixels(width, height)
        rotation, at = _view(center, eye, up)
        focal = 0.5 * width / np.tan(np.radians(angle) / 2)
        camera = np.stack([(columns - 0.5 * width) / focal, (rows - 0.5 * height) / focal,
                           np.ones_like(columns)], axis=-1)
    elif all(x is not None for x in by_matrix) and all(x is None for x in by_view):
        return rays_of_matrices(width, height, *_camera(intrinsic, extrinsic), kind)
    else:
        raise TypeError("give fov, center, eye and up, or intrinsic and extrinsic")
    return _rays(at, camera @ rotation, kind)


def rays_of_matrices(width: int, height: int, intrinsic: Array, extrinsic: Array,
                     kind: np.dtype[Any]) -> Array:
    """As Open3D 0.20.0 has it for any matrices: a rotation's inverse is its transpose."""
    columns, rows = _pixels(width, height)
    camera = np.stack([columns, rows, np.ones_like(columns)], axis=-1) @ np.linalg.inv(intrinsic).T
    rotation = extrinsic[:3, :3]
    return _rays(-rotation.T @ extrinsic[:3, 3], camera @ rotation, kind)


def _check_motion(matrix: Array, name: str, whence: str) -> None:
    rotation = matrix[:3, :3]
    if np.abs(rotation @ rotation.T - np.eye(3)).max() > 1e-4 or matrix[3].tolist() != [0, 0, 0, 1]:
        raise ValueError(f"{name} is no rigid motion: give [[R, t], [0, 0, 0, 1]], R a rotation, "
                         f"{whence}")


def _camera(intrinsic: Any, extrinsic: Any) -> tuple[Array, Array]:
    k, world = matrix(intrinsic, 3, "intrinsic"), matrix(extrinsic, 4, "extrinsic")
    if np.any(k[(1, 2, 2), (0, 0, 1)] != 0) or np.any(np.diag(k) == 0):
        raise ValueError("intrinsic is not upper triangular, or has a zero on its diagonal: give "
                         "[[fx, skew, cx], [0, fy, cy], [0, 0, 1]]")
    _check_motion(world, "extrinsic", "from the world to the camera")
    return k, world


def orthographic(width: int, height: int, *, size: float, center: Any, eye: Any, up: Any,
                 dtype: Any = np.float64) -> Array:
    """Parallel rays, a picture without perspective: (height, width, 6).

    Args:
        width, height: of the picture in pixels.
        size: the width of the picture in the scene's unit; pixels are squares.
        center, eye, up: as pinhole has them. Rays start in the plane of the eye.

    Directions are unit vectors: t is the depth.

    >>> rays = orthographic(2, 1, size=4, center=(0, 0, 0), eye=(0, 0, 9), up=(0, -1, 0))
    >>> rays[0].tolist()
    [[-1.0, 0.0, 9.0, 0.0, 0.0, -1.0], [1.0, 0.0, 9.0, 0.0, 0.0, -1.0]]
    """
    kind = float_type(dtype)
    columns, rows = _pixels(width, height)
    span = number(size, "size")
    if span <= 0:
        raise ValueError(f"size is {span}; give a positive width")
    rotation, at = _view(center, eye, up)
    pixel = span / width
    right = ((columns - 0.5 * width) * pixel)[..., None] * rotation[0]
    down = ((rows - 0.5 * height) * pixel)[..., None] * rotation[1]
    return _rays(at + right + down, rotation[2] + 0.0, kind)


def lidar(sensor: str | None = "VLP-16", pose: Any = (0, 0, 0), *, columns: int | None = None,
          elevations: Any = None, offsets: Any = None, start: float = 180, sweep: float = 360,
          t_min: float | None = None, t_max: float | None = None,
          dtype: Any = np.float64) -> Array:
    """One revolution of a spinning lidar: (beams, columns, 6), a range picture; the top beam first.

    Args:
        sensor: "VLP-16", "HDL-32E", "HDL-64E", "OS1-64" or "OS1-128", see `SENSORS`; None: yours,
            by `columns` and `elevations`.
        pose: where the sensor is, (3,), or also how it is turned, (4, 4), from the sensor to the
            world. In the sensor x is ahead, y left, z up.
        columns: firings a revolution; None: the sensor's at ten revolutions a second.
        elevations: degrees above the horizon of each beam, instead of the sensor's.
        offsets: degrees by which each beam is ahead of its column, clockwise.
        start: the azimuth of the first column, degrees from x towards y. Columns go clockwise from
            it, seen from above; with 180 the middle of the picture is ahead.
        sweep: degrees from the first column to where the one after the last would be.
        t_min, t_max: the sensor's range; given one of them, the result is (beams, columns, 8).

    Directions are unit vectors: t is the range. All beams start in one point.

    >>> rays = lidar("OS1-64", (0, 0, 1.8), columns=512, t_max=120)
    >>> rays.shape, float(rays[0, 0, 2]), rays[0, 0, 6:].tolist()
    ((64, 512, 8), 1.8, [0.0, 120.0])
    """
    kind = float_type(dtype)
    if sensor is not None:
        if sensor not in SENSORS:
            raise ValueError(f"sensor is {sensor!r}; give one of {', '.join(SENSORS)}, or None")
        known = SENSORS[sensor]
        columns = known.columns if columns is None else columns
        if elevations is None:
            elevations, offsets = known.elevations, known.offsets if offsets is None else offsets
    if columns is None or elevations is None:
        raise TypeError("without a sensor give columns and elevations")
    up = np.radians(real(elevations, "elevations"))
    ahead = np.radians(np.zeros(up.shape) if offsets is None else real(offsets, "offsets"))
    if up.ndim != 1 or ahead.shape not in (up.shape, ()):
        raise ValueError(f"elevations and offsets have the shapes {up.shape} and {ahead.shape}; "
                         "give one number for each beam")
    turn = np.arange(whole(columns, "columns")) / columns
    azimuth = np.radians(number(start, "start") - number(sweep, "sweep") * turn)
    azimuth = azimuth[None, :] - np.broadcast_to(ahead, up.shape)[:, None]
    flat, high = np.cos(up)[:, None], np.sin(up)[:, None]
    beams = np.stack([flat * np.cos(azimuth), flat * np.sin(azimuth),
                      np.broadcast_to(high, azimuth.shape)], axis=-1)
    place = real(pose, "pose")
    if place.shape == (4, 4):
        _check_motion(place, "pose", "from the sensor to the world")
        beams, place = beams @ place[:3, :3].T, place[:3, 3]
    elif place.shape != (3,):
        raise ValueError(f"pose has the shape {place.shape}; give a point (3,) or a matrix (4, 4)")
    if t_min is None and t_max is None:
        return _rays(place, beams, kind)
    return _rays(place, beams, kind, 0 if t_min is None else t_min,
                 np.inf if t_max is None else t_max)


def _spiral(count: int) -> tuple[Array, Array]:
    """A lattice that is even for every count: heights in (0, 1) and turns in [0, 1)."""
    i = np.arange(count, dtype=np.float64)
    return (i + 0.5) / count, i * _GOLDEN % 1


def sphere(count: int, center: Any = (0, 0, 0), radius: float = 0, *, inward: bool = False,
           dtype: Any = np.float64) -> Array:
    """Rays in all directions, evenly (a Fibonacci lattice): (count, 6).

    They start on a sphere about the center and lead away from it, or with `inward` to it; with the
    radius 0 they start in the center. Directions are unit vectors.

    >>> rays = sphere(1000, center=(1, 2, 3), radius=10, inward=True)
    >>> bool(np.allclose(rays[:, :3] + 10 * rays[:, 3:], [1, 2, 3]))
    True
    """
    kind = float_type(dtype)
    height, turn = _spiral(whole(count, "count"))
    z = 1 - 2 * height
    r = np.sqrt((1 - z) * (1 + z))
    away = np.stack([r * np.cos(2 * np.pi * turn), r * np.sin(2 * np.pi * turn), z], axis=-1)
    origins = vector(center, "center") + number(radius, "radius") * away
    return _rays(origins, -away if inward else away, kind)


def _shifts(count: int, seed: int) -> Array:
    """Two numbers in [0, 1) for each of `count`, by SplitMix64: the same on every machine."""
    with np.errstate(over="ignore"):
        state = np.arange(1, 2 * count + 1, dtype=np.uint64) * np.uint64(0x9E3779B97F4A7C15)
        state += np.uint64(seed % 2**64) * np.uint64(0xD1342543DE82EF95)
        state = (state ^ (state >> np.uint64(30))) * np.uint64(0xBF58476D1CE4E5B9)
        state = (state ^ (state >> np.uint64(27))) * np.uint64(0x94D049BB133111EB)
        state ^= state >> np.uint64(31)
    fractions: Array = (state >> np.uint64(11)).astype(np.float64) * 2.0**-53
    return fractions.reshape(count, 2)


def _frames(normals: Array) -> tuple[Array, Array]:
    """Two unit vectors that complete each unit normal to a right-handed frame."""
    x, y, z = normals[..., 0], normals[..., 1], normals[..., 2]
    sign = np.where(z >= 0, 1.0, -1.0)
    a = -1 / (sign + z)  # Duff et al., Building an Orthonormal Basis, Revisited, JCGT 2017
    b = x * y * a
    return (np.stack([1 + sign * x * x * a, sign * b, -sign * x], axis=-1),
            np.stack([b, sign + y * y * a, -y], axis=-1))


def hemisphere(points: Any, normals: Any, count: int, *, sampling: str = "cosine", seed: int = 0,
               dtype: Any = None) -> Array:
    """From each point, rays into the half space that its normal points to: (..., count, 6).

    Args:
        points, normals: (..., 3), broadcast. Normals need not be unit vectors.
        count: rays from each point, a lattice that is turned and shifted for each.
        sampling: "cosine": as much light falls in by each ray (ambient occlusion, irradiance);
            "uniform": as much solid angle belongs to each.
        seed: another number, another shift. The same seed gives the same rays again.
        dtype: None: float32 if points and normals are, else float64.

    Directions are unit vectors.

    >>> rays = hemisphere([[0, 0, 0]], [[0, 0, 1]], 64)
    >>> rays.shape, bool((rays[..., 5] > 0).all())
    ((1, 64, 6), True)
    """
    kind = float_type(dtype, points, normals)
    origins, up = np.broadcast_arrays(real(points, "points", 3), real(normals, "normals", 3))
    up = unit(up, "normals")
    height, turn = _spiral(whole(count, "count"))
    n = math.prod(origins.shape[:-1])
    shift = _shifts(n, seed).reshape(*origins.shape[:-1], 1, 2)
    # A random point of its cell for each height, so that 0 and 1 are never reached.
    h = height + (shift[..., 0] - 0.5) / count * (1 - 2.0**-20)
    if sampling == "cosine":
        z, r = np.sqrt(1 - h), np.sqrt(h)
    elif sampling == "uniform":
        z, r = 1 - h, np.sqrt(h * (2 - h))
    else:
        raise ValueError(f"sampling is {sampling!r}; give 'cosine' or 'uniform'")
    angle = 2 * np.pi * ((turn + shift[..., 1]) % 1)
    s, t = _frames(up)
    directions = ((r * np.cos(angle))[..., None] * s[..., None, :]
                  + (r * np.sin(angle))[..., None] * t[..., None, :]
                  + z[..., None] * up[..., None, :])
    return _rays(origins[..., None, :], directions, kind)


def grid(lower: Any, upper: Any, shape: Any, axis: int = 2, *, reverse: bool = False,
         dtype: Any = np.float64) -> Array:
    """Parallel rays through a box along an axis, a regular grid: (shape[0], shape[1], 6).

    Args:
        lower, upper: corners of the box. Rays start on its face at `lower`.
        shape: how many rays along the two other axes, in the order x y z. Each is in the middle of
            its cell.
        axis: 0, 1 or 2: x, y or z.
        reverse: True: from the face at `upper`, against the axis.

    Directions are unit vectors.

    >>> grid((0, 0, 0), (4, 2, 1), (2, 1), reverse=True).tolist()
    [[[1.0, 1.0, 1.0, 0.0, 0.0, -1.0]], [[3.0, 1.0, 1.0, 0.0, 0.0, -1.0]]]
    """
    kind = float_type(dtype)
    low, high = vector(lower, "lower"), vector(upper, "upper")
    if (low > high).any():
        raise ValueError(f"lower is {low.tolist()}, upper {high.tolist()}; give the lower corner "
                         "first")
    if axis not in (0, 1, 2):
        raise ValueError(f"axis is {axis!r}; give 0, 1 or 2")
    if np.shape(shape) != (2,):
        raise ValueError(f"shape is {shape!r}; give two numbers of rays")
    first, second = (i for i in range(3) if i != axis)
    sizes = (whole(shape[0], "shape"), whole(shape[1], "shape"))
    origins = np.empty((*sizes, 3))
    for across, size in zip((first, second), sizes):
        middle = low[across] + (high[across] - low[across]) * ((np.arange(size) + 0.5) / size)
        origins[..., across] = middle[:, None] if across == first else middle
    origins[..., axis] = high[axis] if reverse else low[axis]
    direction = np.zeros(3)
    direction[axis] = -1 if reverse else 1
    return _rays(origins, direction, kind)


def between(start: Any, end: Any, *, closed: bool = True, dtype: Any = None) -> Array:
    """Segments from points to points, say to ask any_hit what is seen from where: (..., 8).

    Args:
        start, end: (..., 3), broadcast: `between(a[:, None], b)` is all pairs.
        closed: False: a hit exactly at the end does not count (t_max is the number before 1).
        dtype: None: float32 if start and end are, else float64. Points of another type are rounded
            to it first.

    The direction is end - start and the range [0, 1]. The segment ends exactly at `end` where that
    difference is a number of `dtype`; elsewhere the difference is rounded once, and the segment
    ends half a unit in its last place from `end` at most. Points that coincide are no segment:
    ValueError.

    >>> between([[0, 0, 1]], [2, 0, 0]).tolist()
    [[0.0, 0.0, 1.0, 2.0, 0.0, -1.0, 0.0, 1.0]]
    """
    kind = float_type(dtype, start, end)
    a, b = real(start, "start", 3).astype(kind), real(end, "end", 3).astype(kind)
    directions = b - a
    zero = (directions == 0).all(axis=-1)
    if zero.any():
        where = tuple(int(i) for i in np.argwhere(zero)[0])
        raise ValueError(f"start and end are the same point at {where}, and in {int(zero.sum())} "
                         "cases in all; leave these out")
    one = kind.type(1)
    return _rays(a, directions, kind, 0, one if closed else np.nextafter(one, kind.type(0)))
