# SPDX-License-Identifier: Apache-2.0
"""Named columns, and columns of few answers that are made when they are asked for."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from ._arrays import Array, FLOAT32, FLOAT64, did_you_mean

VECTORS = ("points", "normals")
FEW = 2048  # answers: to make an array for each column takes as long as so many


class _Column(NamedTuple):
    dtype: np.dtype[Any]
    offset: int  # bytes an answer of the columns before it
    tail: tuple[int, ...]  # of the shape


class Layout:
    """How the core packs columns into one piece of memory: one after the other.

    `columns`: of each its type, "vector", or None for `real`; `order`: as they are named.
    """

    def __init__(self, real: np.dtype[Any], columns: dict[str, Any], order: tuple[str, ...]):
        self.order = order
        self.at: dict[str, _Column] = {}
        bytes_ = 0
        for name, kind in columns.items():
            dtype, tail = (real, (3,)) if kind == "vector" else (np.dtype(kind or real), ())
            self.at[name] = _Column(dtype, bytes_, tail)
            bytes_ += dtype.itemsize * (3 if tail else 1)


def layouts(columns: dict[str, Any], order: tuple[str, ...]) -> dict[np.dtype[Any], Layout]:
    """By the type of the scene."""
    return {real: Layout(real, columns, order) for real in (FLOAT32, FLOAT64)}


class Table:
    """Named columns of one shape, each an attribute."""

    _columns: dict[str, Array]
    _shape: tuple[int, ...]
    _packed: tuple[bytearray, Layout, int]  # if so: what columns are made from

    def _set(self, columns: dict[str, Array], shape: tuple[int, ...]) -> None:
        self._shape = shape
        self._columns = {}
        for name, column in columns.items():
            self._columns[name] = column.reshape(shape + column.shape[1:])
        self.__dict__.update({name: column for name, column in self._columns.items()
                              if name not in VECTORS})

    def _set_packed(self, packed: bytearray, layout: Layout, count: int, shape: tuple[int, ...]
                    ) -> None:
        self._shape = shape
        self._packed = packed, layout, count

    def _unpacked(self, name: str) -> Array:
        packed, layout, count = self._packed
        column = layout.at[name]
        array: Array = np.ndarray(self._shape + column.tail, column.dtype, packed,
                                  column.offset * count)
        self.__dict__[name] = array
        return array

    if not TYPE_CHECKING:  # so that types know what there is
        def __getattr__(self, name: str) -> Array:
            packed = self.__dict__.get("_packed")
            if packed is not None:
                if name in packed[1].at:
                    return self._unpacked(name)
                if name == "_columns":
                    self._columns = {one: getattr(self, one) for one in packed[1].order}
                    return self._columns
            if name.startswith("_"):
                raise AttributeError(name)
            names = ", ".join(self._columns)
            hint = did_you_mean(name, dir(type(self)))
            raise AttributeError(f"there is no column {name!r} here; there are {names}{hint}")

    @property
    def shape(self) -> tuple[int, ...]:
        """The shape of each column: that of the rays or points."""
        return self._shape

    def __len__(self) -> int:
        if not self._shape:
            raise TypeError("a single answer has no length")
        return self._shape[0]

    def _frame(self) -> dict[str, Array]:
        return {name: column.reshape(-1) for name, column in self._columns.items()
                if column.shape == self._shape}

    def to_dataframe(self) -> Any:
        """A pandas.DataFrame with a row for each answer, in C order. Needs pandas."""
        import pandas  # type: ignore[import-not-found, import-untyped, unused-ignore]

        return pandas.DataFrame(self._frame())

    def _repr_html_(self) -> str:
        frame = self._frame()
        count = len(next(iter(frame.values())))
        lines = ["".join(f"<th>{name}</th>" for name in frame)]
        for i in range(min(count, 10)):
            cells = [column[i].item() for column in frame.values()]
            lines.append("".join(f"<td>{x:.9g}</td>" if isinstance(x, float) else f"<td>{x}</td>"
                                 for x in cells))
        body = "".join(f"<tr>{line}</tr>" for line in lines)
        more = f"<p>... {count} in all</p>" if count > 10 else ""
        return f"<table>{body}</table>{more}"
