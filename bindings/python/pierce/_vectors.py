# SPDX-License-Identifier: Apache-2.0
"""Finite numbers and vectors from whatever a caller gives, for code that computes in float64."""

from __future__ import annotations

from typing import Any

import numpy as np

from ._arrays import FLOAT32, FLOAT64, POINT_COLUMNS, Array, as_array, by_name


def real(value: Any, name: str, columns: int = 0) -> Array:
    """Finite numbers as float64, in rows of `columns` if that is not 0."""
    array, _ = as_array(by_name(value, name, POINT_COLUMNS) if columns == 3 else value, name)
    result = array.astype(np.float64)
    if columns and (result.ndim == 0 or result.shape[-1] != columns):
        raise ValueError(f"{name} has the shape {result.shape}, not (..., {columns})")
    bad = ~np.isfinite(result)
    if bad.any():
        where = tuple(int(i) for i in np.argwhere(bad)[0])
        raise ValueError(f"{name}: {result[where]} at {where}; give finite numbers")
    return result


def vector(value: Any, name: str) -> Array:
    array = real(value, name)
    if array.shape != (3,):
        raise ValueError(f"{name} has the shape {array.shape}; give three numbers")
    return array


def number(value: Any, name: str) -> float:
    array = real(value, name)
    if array.shape != ():
        raise ValueError(f"{name} has the shape {array.shape}; give one number")
    return float(array)


def count(value: Any, name: str) -> int:
    if isinstance(value, (bool, float)) or not hasattr(value, "__index__"):
        raise TypeError(f"{name} is {value!r}; give a whole number")
    result = int(value.__index__())
    if result < 1:
        raise ValueError(f"{name} is {result}; give at least 1")
    return result


def float_type(dtype: Any, *arrays: Any) -> np.dtype[Any]:
    """The type asked for; None: float32 if all arrays are, else float64."""
    if dtype is None:
        single = bool(arrays) and all(getattr(a, "dtype", None) == FLOAT32 for a in arrays)
        return FLOAT32 if single else FLOAT64
    result: np.dtype[Any] = np.dtype(dtype)
    if result not in (FLOAT32, FLOAT64):
        raise TypeError(f"dtype is {result}; give np.float32 or np.float64")
    return result


def unit(vectors: Array, name: str) -> Array:
    """Directions of length 1; of any scale, without overflow on the way."""
    largest = np.abs(vectors).max(axis=-1, keepdims=True)
    zero = largest == 0
    if zero.any():
        where = tuple(int(i) for i in np.argwhere(zero)[0][:-1])
        at = f" at {where}" if where else ""
        raise ValueError(f"{name}{at} is zero and points nowhere")
    scaled = vectors / largest
    result: Array = scaled / np.sqrt((scaled * scaled).sum(axis=-1, keepdims=True))
    return result
