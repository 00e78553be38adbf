# SPDX-License-Identifier: Apache-2.0
"""Arithmetic on arrays of floats or of exact fractions alike, one rounding an operation."""

from __future__ import annotations

from fractions import Fraction
from typing import Any

import numpy as np

from ._arrays import Array

OBJECT = np.dtype(object)


def fractions(array: Array) -> Array:
    """The same numbers as fractions.Fraction, exactly; infinities and NaN stay floats."""
    result = np.empty(array.shape, OBJECT)
    flat = result.reshape(-1)
    for i, number in enumerate(array.reshape(-1).tolist()):
        flat[i] = Fraction(number) if np.isfinite(number) else number
    return flat.reshape(array.shape)


def divide(x: Any, y: Array) -> Array:
    """x / y. Of fractions: NaN where y is 0, and whatever is computed from that is NaN."""
    if y.dtype != OBJECT:
        with np.errstate(all="ignore"):
            return np.asarray(x / y)
    zero = np.asarray(y == 0, bool)
    safe = y.copy()
    safe[zero] = Fraction(1)
    quotient = np.asarray(x / safe, OBJECT)
    quotient[zero] = np.nan
    return quotient


def dot(p: Array, q: Array) -> Array:
    return np.asarray(p[..., 0] * q[..., 0] + p[..., 1] * q[..., 1] + p[..., 2] * q[..., 2],
                      p.dtype)


def cross(p: Array, q: Array) -> Array:
    return np.stack([p[..., 1] * q[..., 2] - p[..., 2] * q[..., 1],
                     p[..., 2] * q[..., 0] - p[..., 0] * q[..., 2],
                     p[..., 0] * q[..., 1] - p[..., 1] * q[..., 0]], axis=-1)


def component(p: Array, axis: Array) -> Array:
    """Of each vector the component along its axis."""
    return np.take_along_axis(p, axis[..., None], axis=-1)[..., 0]


def longest_axis(p: Array) -> Array:
    """The axis along which each vector is longest; of equal ones, the first."""
    size = np.abs(p)
    x, y, z = size[..., 0], size[..., 1], size[..., 2]
    first = np.asarray((x >= y) & (x >= z), bool)
    return np.where(first, 0, np.where(np.asarray(y >= z, bool), 1, 2))
