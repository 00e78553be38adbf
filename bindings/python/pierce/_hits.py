# SPDX-License-Identifier: Apache-2.0
"""Answers: columns in the shape of the rays or points, and what follows from them."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Iterator, NamedTuple, Sequence

import numpy as np

from ._arrays import Array
from ._question import Rays, parse_triangles

if TYPE_CHECKING:
    from ._scene import Scene

COLUMNS = ("t", "u", "v", "w", "geometry", "triangle", "facing")
FEATURES = ("vertex a", "vertex b", "vertex c", "edge ab", "edge bc", "edge ca", "face")


def new_columns(count: int, dtype: np.dtype[Any], wanted: Sequence[str] | None = None
                ) -> dict[str, Array]:
    """Room for `count` hits; "triangle" is always there."""
    if wanted is not None:
        unknown = [name for name in wanted if name not in COLUMNS]
        if unknown or isinstance(wanted, str):
            raise ValueError(f"columns are {wanted!r}; give some of {', '.join(COLUMNS)}")
    types = {"geometry": np.int64, "triangle": np.int64, "facing": np.uint8}
    return {name: np.empty(count, types.get(name, dtype)) for name in COLUMNS
            if wanted is None or name in wanted or name == "triangle"}


def no_hits(columns: dict[str, Array]) -> None:
    """Fills the columns with misses."""
    for name, column in columns.items():
        column[...] = np.inf if name == "t" else -1 if name in ("geometry", "triangle") else 0


class _Table:
    """Named columns of one shape."""

    _columns: dict[str, Array]
    _shape: tuple[int, ...]

    def __getattr__(self, name: str) -> Array:
        if name.startswith("_"):
            raise AttributeError(name)
        try:
            return self._columns[name]
        except KeyError:
            raise AttributeError(f"there is no column {name!r}; there are "
                                 f"{', '.join(self._columns)}") from None

    @property
    def shape(self) -> tuple[int, ...]:
        """The shape of each column."""
        return self._shape

    def __len__(self) -> int:
        if not self._shape:
            raise TypeError("a single answer has no length")
        return self._shape[0]

    def _frame(self) -> dict[str, Array]:
        return {name: column.reshape(-1) for name, column in self._columns.items()
                if column.shape == self._shape}

    def to_dataframe(self) -> Any:
        """A pandas.DataFrame with a row for each answer."""
        import pandas  # type: ignore[import-not-found, import-untyped, unused-ignore]

        return pandas.DataFrame(self._frame())

    def _repr_html_(self) -> str:
        frame = self._frame()
        count = len(next(iter(frame.values())))
        cells = ["".join(f"<th>{name}</th>" for name in frame)]
        for i in range(min(count, 10)):
            cells.append("".join(f"<td>{column[i]:.9g}</td>" for column in frame.values()))
        body = "".join(f"<tr>{row}</tr>" for row in cells)
        more = f"<p>... {count} in all</p>" if count > 10 else ""
        return f"<table>{body}</table>{more}"


class Hits(_Table):
    """Where rays hit: one answer for each ray, in the shape of the rays.

    Attributes:
        t, u, v, w: `origin + t direction = w a + u b + v c`; each is the exact value rounded once.
            A miss has t = inf and u = v = w = 0.
        geometry, triangle: int64, -1 for a miss.
        facing: uint8, 0 where the ray meets the front of the triangle, 1 where its back.
    """

    t: Array
    u: Array
    v: Array
    w: Array
    geometry: Array
    triangle: Array
    facing: Array

    def __init__(self, scene: Scene, rays: Rays, columns: dict[str, Array],
                 shape: tuple[int, ...], row: Array | None = None):
        self._scene, self._rays, self._row = scene, rays, row
        self._version = scene._version
        self._shape = shape
        self._columns = {name: column.reshape(shape) for name, column in columns.items()}

    @property
    def hit(self) -> Array:
        """Which rays hit something: bool."""
        return self.triangle >= 0

    @property
    def front(self) -> Array:
        """Which rays hit the front of a triangle: bool."""
        return self.hit & (self.facing == 0)

    def _refs(self) -> Array:
        refs = parse_triangles((self.geometry, self.triangle), self._shape, "hits")
        assert refs is not None
        return refs

    def _asked(self) -> Rays:
        return self._rays if self._row is None else self._rays.take(self._row)

    def _check(self, name: str) -> None:
        if self._version != self._scene._version:
            raise RuntimeError(f"{name}: the scene was updated since; ask it again")

    @property
    def points(self) -> Array:
        """Where they hit, (..., 3): the exact points, each coordinate rounded once; misses NaN.

        Computed when asked for, about 0.1 us a hit, from the rays as their arrays are then.
        """
        self._check("points")
        return self._scene._hit_points(self._asked(), self._refs(), self.hit, self._shape)

    @property
    def normals(self) -> Array:
        """Unit normals of the triangles, (..., 3), each component rounded once; misses 0.

        They point to where corners run counter-clockwise, whichever side was hit.
        """
        self._check("normals")
        return self._scene._normals(self._refs(), self._shape)

    def interpolate(self, attribute: Any) -> Array:
        """What is given for each vertex, at the hits: w x[a] + u x[b] + v x[c], misses NaN.

        `attribute` has a row for each vertex, (vertices, ...), in a scene of several geometries a
        list of such arrays. Ordinary floating point, in the attribute's type (integers: float64).
        """
        self._check("interpolate")
        several = isinstance(attribute, list) and len(self._scene.geometries) > 1
        tables = [np.asarray(x) for x in (attribute if several else [attribute])]
        if len(tables) != len(self._scene.geometries):
            raise ValueError(f"{len(tables)} attributes for {len(self._scene.geometries)} "
                             "geometries; give a list, an array for each")
        tail = tables[0].shape[1:]
        kind = np.result_type(np.float32, *[x.dtype for x in tables])
        result = np.full((*self._shape, *tail), np.nan, kind)
        for number, (table, (vertices, triangles)) in enumerate(
                zip(tables, self._scene.geometries)):
            if table.shape != (len(vertices), *tail):
                raise ValueError(f"the attribute has the shape {table.shape}, but there are "
                                 f"{len(vertices)} vertices")
            mine = self.hit & (self.geometry == number)
            corners = triangles[self.triangle[mine]]
            weights = np.stack([self.w[mine], self.u[mine], self.v[mine]], axis=-1)
            weights = weights.reshape(weights.shape + (1,) * len(tail)).astype(kind)
            result[mine] = (weights * table[corners]).sum(axis=1)
        return result

    def __getitem__(self, key: Any) -> Hits:
        """Some of them, as NumPy indexes arrays: hits[hits.hit], hits[0], hits[..., ::2]."""
        if isinstance(key, str):
            raise TypeError(f"columns are attributes: hits.{key}")
        row = np.arange(int(np.prod(self._shape, dtype=np.int64))) if self._row is None else \
            self._row
        picked = np.asarray(row.reshape(self._shape)[key])
        columns = {name: np.asarray(column[key]) for name, column in self._columns.items()}
        hits = Hits(self._scene, self._rays, columns, picked.shape, picked.reshape(-1))
        hits._version = self._version
        return hits

    def __iter__(self) -> Iterator[Hits]:
        return (self[i] for i in range(len(self)))

    def __repr__(self) -> str:
        if not self._shape:
            if not self.hit:
                return "Hits(miss)"
            words = [f"{name}={column[()]:.9g}" for name, column in self._columns.items()]
            return f"Hits({', '.join(words)})"
        return f"Hits(shape={self._shape}, hit={int(self.hit.sum())})"


class HitLists(Hits):
    """All hits of each ray: the columns of Hits, one row a hit, ray after ray.

    The hits of ray i are the rows offsets[i] ... offsets[i + 1] - 1, in the exact order
    (t, geometry, triangle); rays count on through their leading shape in C order.

    Attributes:
        offsets: int64, one more than there are rays.
        ray: int64, the ray of each hit.
    """

    def __init__(self, scene: Scene, rays: Rays, columns: dict[str, Array], offsets: Array):
        self._offsets = offsets
        ray = np.repeat(np.arange(len(offsets) - 1), np.diff(offsets))
        super().__init__(scene, rays, columns, (len(ray),), ray)

    @property
    def ray(self) -> Array:
        assert self._row is not None
        return self._row

    @property
    def offsets(self) -> Array:
        return self._offsets

    @property
    def counts(self) -> Array:
        """How many hits each ray has, in the shape of the rays."""
        return np.diff(self._offsets).reshape(self._rays.shape)

    def of(self, ray: int) -> Hits:
        """The hits of one ray."""
        count = len(self._offsets) - 1
        if not -count <= ray < count:
            raise IndexError(f"there is no ray {ray}; there are {count}")
        ray %= count
        return self[self._offsets[ray]:self._offsets[ray + 1]]

    def _frame(self) -> dict[str, Array]:
        return {"ray": self.ray, **super()._frame()}

    def __repr__(self) -> str:
        return f"HitLists(rays={len(self._offsets) - 1}, hits={self._shape[0]})"


class Nearest(_Table):
    """The nearest points of the surface: one answer for each point, in the shape of the points.

    Attributes:
        point: (..., 3). NaN if nothing is near enough.
        distance: inf if nothing is near enough.
        u, v, w: `point = w a + u b + v c`. Like those before, the exact values rounded once.
        geometry, triangle: int64, -1 if nothing is near enough.
        feature: uint8: 0 1 2 the corners a b c, 3 4 5 the edges ab bc ca, 6 the face.
    """

    point: Array
    distance: Array
    u: Array
    v: Array
    w: Array
    geometry: Array
    triangle: Array
    feature: Array

    def __init__(self, columns: dict[str, Array], shape: tuple[int, ...]):
        self._shape = shape
        self._columns = {name: column.reshape(shape + column.shape[1:])
                         for name, column in columns.items()}

    @property
    def found(self) -> Array:
        """For which points something is near enough: bool."""
        return self.triangle >= 0

    def __repr__(self) -> str:
        return f"Nearest(shape={self._shape}, found={int(np.sum(self.found))})"


class Crossings(NamedTuple):
    """How often rays pass through the surface, each passage once, through an edge or vertex too."""

    count: Array  #: uint32; of a closed mesh odd iff the origin is inside
    signed_count: Array  #: int32; leaving counts +1, entering -1
    origin_on_surface: Array  #: bool; the origin lies exactly on a triangle
