# SPDX-License-Identifier: Apache-2.0
"""Numbers in: arrays of the right type as they lie, everything else converted only if exact."""

from __future__ import annotations

import difflib
import math
import sys
from collections.abc import Mapping
from itertools import chain
from typing import Any

import numpy as np
import numpy.typing as npt

from . import _core

Array = npt.NDArray[Any]

FLOAT32 = np.dtype(np.float32)
FLOAT64 = np.dtype(np.float64)

POINT_COLUMNS = {"x": None, "y": None, "z": None}
LARGE = 1 << 22  # bytes from which NumPy asks for huge pages


def new_array(shape: int | tuple[int, ...], dtype: npt.DTypeLike) -> Array:
    """As np.empty, for answers: without huge pages, which cost more than they are worth here."""
    kind = np.dtype(dtype)
    bytes_ = math.prod(shape if isinstance(shape, tuple) else (shape,)) * kind.itemsize
    if bytes_ < LARGE:
        return np.empty(shape, kind)
    return _core.room(bytes_).view(kind).reshape(shape)


def as_array(value: Any, name: str) -> tuple[Array, bool]:
    """The numbers of anything that holds some, and whether they came with a type of their own.

    Python's numbers and lists have none, and neither has a single NumPy scalar.
    """
    masked = _masked_in(value)
    if masked:
        raise ValueError(f"{name}: {masked} numbers are masked; fill them "
                         "in (.filled) or leave their rows out (np.ma.compress_rows)")
    typed = not isinstance(value, (list, tuple, float, int))
    if isinstance(value, np.ndarray):
        array = np.asarray(value)
    elif hasattr(value, "numpy") and callable(value.numpy):  # torch, Open3D, TensorFlow
        array = np.asarray(value.numpy())
    elif hasattr(value, "__dlpack__") and not hasattr(value, "__array__"):
        array = np.from_dlpack(value)
    elif (named := _frame(value)) and len({np.asarray(column).dtype for _, column in named}) > 1:
        return joined([as_array(column, f"{name}.{one}")[0] for one, column in named], name), True
    else:
        try:
            array = np.asarray(value)
        except ValueError as error:
            raise ValueError(f"{name}: rows of different lengths, no array ({error})") from None
    if array.dtype.kind not in "fiu":
        if array.size == 0 and not typed:
            return array.astype(np.float64), False
        kinds = {"b": "truth values", "c": "complex numbers", "V": "records"}
        cures = {"O": ", of at most 64 bits each",
                 "V": ": numpy.lib.recfunctions.structured_to_unstructured"}
        kind = array.dtype.kind
        raise TypeError(f"{name} holds {kinds.get(kind, 'no numbers')} ({_short(array.dtype)}); "
                        f"give an array of float32, float64 or integers{cures.get(kind, '')}")
    if not typed and array.dtype.kind == "f" and not (np.abs(array) < 2**53).all():
        for number in np.asarray(value, object).flat:  # beside floats NumPy has rounded integers
            if isinstance(number, int) and int(float(number)) != number:
                raise ValueError(_no_number(name, number, FLOAT64))
    return array, typed and array.ndim > 0


_PLAIN = {float, int, bool, str, np.float32, np.float64, np.int64, np.ndarray}
_LISTS = {list, tuple}


def _masked_in(value: Any) -> int:
    """How many numbers are masked, in lists of masked arrays, too."""
    if "numpy.ma" not in sys.modules:  # then there are none
        return 0
    if isinstance(value, np.ma.MaskedArray):
        return int(np.count_nonzero(np.ma.getmaskarray(value)))
    if not isinstance(value, (list, tuple)):
        return 0
    kinds = set(map(type, value))
    for _ in range(8):  # all of a level at once, as there may be many
        if kinds and kinds <= _LISTS:
            value = list(chain.from_iterable(value))
            kinds = set(map(type, value))
    return 0 if kinds <= _PLAIN else sum(_masked_in(one) for one in value)


def _frame(value: Any) -> list[tuple[Any, Any]] | None:
    """Names and columns of a data frame (pandas, polars, pyarrow); None of anything else."""
    if hasattr(value, "schema") and hasattr(value, "num_columns"):  # pyarrow
        return list(zip(value.schema.names, value.columns))
    if not (hasattr(value, "to_numpy") and hasattr(value, "columns")):
        return None
    return list(value.items() if hasattr(value, "items") else
                zip(value.columns, value.get_columns()))


def _entries(value: Any) -> list[tuple[Any, Any]] | None:
    """Names and numbers of a pandas.Series, as a row of a frame is one; None of anything else."""
    if (getattr(value, "ndim", 0) == 1 and hasattr(value, "index") and hasattr(value, "items")
            and hasattr(value, "to_numpy")):
        return list(zip(value.index, value.to_numpy()))  # whose items would all be float64
    return None


def joined(columns: list[Array], name: str) -> Array:
    """Columns of any types side by side. Integers beside floats become floats if they are some."""
    kinds = [column.dtype for column in columns]
    floats = [kind for kind in kinds if kind.kind == "f"]
    single = floats and max(kind.itemsize for kind in floats) > 2
    target = np.result_type(*(floats if single else kinds))
    result = []
    for column in columns:
        with np.errstate(over="ignore"):
            result.append(column.astype(target, copy=False))
        if column.dtype.kind in "iu" and target.kind == "f":
            wrong = _changed(column, result[-1])
            if wrong is not None:
                raise ValueError(_no_number(name, wrong, target))
    return np.stack(result, axis=-1)


def did_you_mean(name: str, among: list[str]) -> str:
    near = difflib.get_close_matches(name, [one for one in among if not one.startswith("_")], 1)
    return f"; did you mean {near[0]!r}?" if near else ""


def by_name(value: Any, name: str, *tables: Mapping[str, float | None]) -> Any:
    """Records, data frames and their rows that name all columns without a default of one of the
    tables, as rows of its columns in their order; all else as it is. Most of them are not enough:
    one of the names is wrong."""
    if isinstance(value, (list, tuple)):
        return value
    fields = getattr(getattr(value, "dtype", None), "names", None)
    if fields is None and isinstance(value, np.ndarray):
        return value
    named = ([(one, value[one]) for one in fields] if fields else
             _frame(value) or _entries(value) or [])
    there: dict[str, list[Any]] = {}
    for one, column in named:
        there.setdefault(str(one).lower(), []).append(column)
    for columns in tables:
        needed = [one for one, default in columns.items() if default is None]
        if there and all(one in there for one in needed):
            return _picked(there, columns, needed, name)
    for columns in tables:
        needed = [one for one, default in columns.items() if default is None]
        missing = [one for one in needed if one not in there]
        if 2 * len(missing) < len(needed):
            others = [one for one in there if one not in columns]
            words = ", ".join(map(repr, missing))
            raise ValueError(f"{name}: there is no column {words} beside "
                             f"{', '.join(one for one in needed if one in there)}; rename one"
                             f"{did_you_mean(missing[0], others)}")
    return value


def _picked(there: dict[str, list[Any]], columns: Mapping[str, float | None], needed: list[str],
            name: str) -> Array:
    wanted = columns if any(one in there for one in columns if one not in needed) else needed
    found: list[Array] = []
    for one in wanted:
        given = there.get(one, [])
        if len(given) > 1:
            raise ValueError(f"{name}: {len(given)} columns are named {one!r}; give one")
        found.append(as_array(given[0], f"{name}.{one}")[0] if given else
                     np.full(found[0].shape, columns[one], np.float16))  # as any float has it
    return joined(found, name)


def _no_number(name: str, number: Any, dtype: np.dtype[Any]) -> str:
    other = "" if dtype == FLOAT64 else ", or use float64 throughout"
    return (f"{name}: {number} is no {dtype.name}; round it yourself, "
            f"np.{dtype.name}({number}){other}")


def _short(dtype: np.dtype[Any]) -> str:
    return ", ".join(dtype.names) if dtype.names else str(dtype)


def to_real(value: Any, dtype: np.dtype[Any], name: str, owner: str = "the scene") -> Array:
    """The numbers as `dtype`, never rounded. What lies right is not copied.

    Raises TypeError for an array of another float type, ValueError for a number that `dtype` does
    not have.
    """
    array, typed = as_array(value, name)
    if array.dtype == dtype:
        return array
    kind, size = array.dtype.kind, array.dtype.itemsize
    if kind == "f" and size == dtype.itemsize:  # the other byte order
        return array.astype(dtype)
    if kind == "f" and size > 8:
        raise TypeError(f"{name} is {array.dtype.name}, {owner} {dtype.name}: give "
                        f"{name}.astype(np.{dtype.name}) (rounded)")
    if kind == "f" and size > 2 and typed:
        cure = "exact" if dtype.itemsize > size else "rounded"
        raise TypeError(f"{name} is {array.dtype.name}, {owner} {dtype.name}: give "
                        f"{name}.astype(np.{dtype.name}) ({cure}), or use {array.dtype.name} "
                        "throughout")
    with np.errstate(over="ignore"):
        result = array.astype(dtype)
    wrong = _changed(array, result)
    if wrong is not None:
        raise ValueError(_no_number(name, wrong, dtype))
    return result


def _changed(before: Array, after: Array) -> Any | None:
    """The first number that is another one after the conversion, or None."""
    if before.dtype.kind == "f":
        same = before == after
        if same.all():
            return None
        same |= before != before
        return None if same.all() else before[~same].flat[0]
    limit = 2**24 if after.dtype == FLOAT32 else 2**53
    large = (before > limit) | (before < -limit)
    if not large.any():
        return None
    for x, y in zip(before[large].tolist(), after[large].tolist()):
        if int(y) != x:
            return x
    return None


def real_type(arrays: list[Array], names: list[str]) -> np.dtype[Any]:
    """The float type that all arrays with a type of their own agree on."""
    chosen: np.dtype[Any] | None = None
    chosen_name = ""
    for array, name in zip(arrays, names):
        if array.dtype.kind != "f" or array.dtype.itemsize == 2:
            continue
        dtype = array.dtype.newbyteorder("=")
        if dtype not in (FLOAT32, FLOAT64):
            raise TypeError(f"{name} is {dtype.name}; give float32 or float64")
        if chosen is not None and chosen != dtype:
            raise TypeError(f"{chosen_name} is {chosen.name} and {name} is {dtype.name}: give both "
                            "one type, with .astype(np.float64) (exact) or .astype(np.float32) "
                            "(rounded)")
        chosen, chosen_name = FLOAT32 if dtype == FLOAT32 else FLOAT64, name
    return chosen if chosen is not None else FLOAT64


def whole(value: Any, name: str, lowest: int, highest: int,
          error: type[Exception] = IndexError) -> Array:
    """Integers as int64 within bounds, else `error`; anything but integers is a TypeError."""
    array, _ = as_array(value, name)
    if array.dtype.kind == "f":
        if array.size:
            raise TypeError(f"{name} is {array.dtype.name}; give integers")
        return array.astype(np.int64)
    bad = (array < lowest) | (array > highest)
    if bad.any():
        row = int(np.flatnonzero(bad.reshape(-1))[0])
        raise error(f"{name}: {array.reshape(-1)[row]} at {row} is not in {lowest} ... {highest}; "
                    f"{int(bad.sum())} such numbers")
    return array.astype(np.int64, copy=False)


def shaped(array: Array, shape: tuple[int, ...]) -> Array:
    """One number for each, in this shape."""
    return array if len(shape) == 1 else array.reshape(shape)


def rows(array: Array, shape: tuple[int, ...], columns: tuple[int, ...]) -> Array:
    """The array as one row for each of prod(shape), or as a single row that holds for all.

    Copies only what has no regular step from row to row.
    """
    count = math.prod(shape)
    lead = array.shape[: array.ndim - len(columns)]
    if math.prod(lead) == 1:
        return array.reshape((1, *columns))
    if lead != shape:
        array = np.broadcast_to(array, shape + columns)
    return array.reshape((count, *columns))
