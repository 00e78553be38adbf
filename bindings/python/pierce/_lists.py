# SPDX-License-Identifier: Apache-2.0
"""Answers of which each question has several, as many as there are."""

from __future__ import annotations

import numpy as np

from ._arrays import Array
from ._hits import Nearest
from ._table import Table


class _Lists(Table):
    """Rows of all questions, one after the other."""

    _offsets: Array
    _asked: tuple[int, ...]

    def _set_lists(self, columns: dict[str, Array], offsets: Array, asked: tuple[int, ...]) -> None:
        self._offsets, self._asked = offsets, asked
        self._set(columns, (int(offsets[-1]),))

    @property
    def offsets(self) -> Array:
        """int64: the rows of question i are offsets[i] ... offsets[i + 1] - 1."""
        return self._offsets

    @property
    def counts(self) -> Array:
        """How many rows each question has, int64 in the shape of the questions."""
        return np.diff(self._offsets).reshape(self._asked)

    @property
    def query(self) -> Array:
        """int64, the number of each row's question; they count on in C order."""
        return np.repeat(np.arange(len(self._offsets) - 1), np.diff(self._offsets))

    def _rows_of(self, question: int) -> dict[str, Array]:
        count = len(self._offsets) - 1
        if not -count <= question < count:
            raise IndexError(f"there is no question {question}; there are {count}")
        question %= count
        rows = slice(int(self._offsets[question]), int(self._offsets[question + 1]))
        return {name: column[rows] for name, column in self._columns.items()}

    def _frame(self) -> dict[str, Array]:
        return {"query": self.query, **super()._frame()}

    def __repr__(self) -> str:
        return f"{type(self).__name__}(queries={len(self._offsets) - 1}, rows={self._shape[0]})"


class NearestLists(_Lists, Nearest):
    """The triangles near each point: the columns of Nearest, a row a triangle, point after point.

    Those of point i are the rows offsets[i] ... offsets[i + 1] - 1, in the exact order (distance,
    geometry, triangle).
    """

    def __init__(self, columns: dict[str, Array], offsets: Array, asked: tuple[int, ...]):
        self._set_lists(columns, offsets, asked)

    def of(self, point: int) -> Nearest:
        """The rows of one point, by its number."""
        rows = self._rows_of(point)
        return Nearest(rows, (len(rows["triangle"]),))


class TriangleLists(_Lists):
    """The triangles that each segment or box touches, a row a triangle.

    Attributes:
        geometry, triangle: int64. Those of question i are the rows offsets[i] ... offsets[i + 1]
            - 1, in ascending order.
    """

    geometry: Array
    triangle: Array

    def __init__(self, columns: dict[str, Array], offsets: Array, asked: tuple[int, ...]):
        self._set_lists(columns, offsets, asked)

    def of(self, question: int) -> Array:
        """(geometry, triangle) of one segment or box, (n, 2), by its number."""
        rows = self._rows_of(question)
        return np.stack([rows["geometry"], rows["triangle"]], axis=-1)


def padded(lists: NearestLists, k: int) -> Nearest:
    """The same with k rows a point, what is missing as Nearest has it."""
    count = len(lists.offsets) - 1
    nothing = {"point": np.nan, "distance": np.inf, "geometry": -1, "triangle": -1, "feature": 6}
    row = lists.query
    rank = np.arange(len(row)) - lists.offsets[:-1][row]
    columns = {}
    for name, column in lists._columns.items():
        wide = np.full((count, k, *column.shape[1:]), nothing.get(name, 0), column.dtype)
        wide[row, rank] = column
        columns[name] = wide.reshape(count * k, *column.shape[1:])
    return Nearest(columns, (*lists._asked, k))
