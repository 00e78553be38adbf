# SPDX-License-Identifier: Apache-2.0
"""Answers: columns in the shape of the rays or points, and what follows from them."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any, Callable, Collection, Iterator

import numpy as np

from ._arrays import Array, new_array
from ._question import Rays, parse_triangles
from ._table import VECTORS, Table, layouts

if TYPE_CHECKING:
    from ._scene import Scene

COLUMNS = ("t", "u", "v", "w", "geometry", "triangle", "facing")
TYPES = {"geometry": np.int64, "triangle": np.int64, "facing": np.uint8}
PACKED = layouts({"geometry": np.int64, "triangle": np.int64, "t": None, "u": None, "v": None,
                  "w": None, "facing": np.uint8}, COLUMNS)
PACKED_NEAREST = layouts(
    {"geometry": np.int64, "triangle": np.int64, "point": "vector", "distance": None, "u": None,
     "v": None, "w": None, "feature": np.uint8},
    ("point", "distance", "u", "v", "w", "geometry", "triangle", "feature"))


def new_columns(count: int, dtype: np.dtype[Any], wanted: Collection[str] | None = None
                ) -> dict[str, Array]:
    """Room for `count` hits; "triangle" is always there."""
    if wanted is None:
        wanted = COLUMNS
    listed = isinstance(wanted, Collection) and not isinstance(wanted, str)
    if not listed or any(name not in COLUMNS + VECTORS for name in wanted):
        raise ValueError(f"columns are {wanted!r}; give a list of some of "
                         f"{', '.join(COLUMNS + VECTORS)}")
    columns = {name: new_array(count, TYPES.get(name, dtype)) for name in COLUMNS
               if name in wanted or name == "triangle"}
    columns.update({name: new_array((count, 3), dtype) for name in VECTORS if name in wanted})
    return columns


def columns_again(out: Hits, rays: Rays, dtype: np.dtype[Any]) -> dict[str, Array]:
    """The columns of earlier hits, to be filled again."""
    if type(out) is not Hits:
        raise TypeError(f"out is {type(out).__name__}; give the Hits of an earlier closest_hit")
    if out.shape != rays.shape:
        raise ValueError(f"out has the shape {out.shape}, the rays {rays.shape}")
    columns = {name: out._columns[name] for name in out._own}
    given = [a for a in rays.parts if a is not None]
    for name, column in columns.items():
        if column.dtype != TYPES.get(name, dtype):
            raise TypeError(f"out.{name} is {column.dtype.name}; give Hits of a scene of "
                            f"{dtype.name}")
        if not (column.flags.c_contiguous and column.flags.writeable):
            raise ValueError(f"out.{name} does not lie in one piece, or is read-only; give Hits "
                             "as closest_hit made them")
        if any(np.may_share_memory(column, a) for a in given):
            raise ValueError(f"the rays are in out.{name}, which is to be filled; copy them")
    return {name: column.reshape(-1, *column.shape[len(out.shape):])
            for name, column in columns.items()}


def no_hits(columns: dict[str, Array]) -> None:
    """Fills the columns with misses."""
    nothing = {"t": np.inf, "geometry": -1, "triangle": -1, "points": np.nan, "normals": np.nan}
    for name, column in columns.items():
        column[...] = nothing.get(name, 0)


def read_only(array: Array) -> Array:
    """The same, not to be written to."""
    view = array.view()
    view.flags.writeable = False
    return view


class Hits(Table):
    """Where rays hit: one answer for each ray, in the shape of the rays.

    Attributes:
        t, u, v, w: `origin + t direction = w a + u b + v c`, float32 or float64 as the scene; each
            is the exact value rounded once. t counts in lengths of the direction. A miss has
            t = inf and u = v = w = 0.
        geometry, triangle: int64, -1 for a miss. (The C++ library and the command have 4294967295
            there, as Embree and Open3D do.)
        facing: uint8, 0 where the ray meets the front of the triangle, from where its corners run
            counter-clockwise, 1 where its back.
    """

    t: Array
    u: Array
    v: Array
    w: Array
    geometry: Array
    triangle: Array
    facing: Array

    def __init__(self, scene: Scene | None, rays: Rays | None, columns: dict[str, Array],
                 shape: tuple[int, ...], version: int, row: Array | None = None):
        self._start(scene, rays, columns, shape, version, row)

    @classmethod
    def _of_packed(cls, scene: Scene, rays: Rays, packed: bytearray, version: int) -> Hits:
        """Of all columns, as the core packs them."""
        hits: Hits = object.__new__(cls)
        hits._scene, hits._rays, hits._row, hits._version = scene, rays, None, version
        hits._own = COLUMNS
        hits._set_packed(packed, PACKED[scene._dtype], rays.count, rays.shape)
        return hits

    def _start(self, scene: Scene | None, rays: Rays | None, columns: dict[str, Array],
               shape: tuple[int, ...], version: int, row: Array | None = None) -> None:
        self._scene, self._rays, self._row = scene, rays, row
        self._version = version  # of the scene that answered
        self._own = tuple(columns)  # what comes later is computed from these
        self._set(columns, shape)

    @property
    def hit(self) -> Array:
        """Which rays hit something: bool."""
        return np.asarray(self.triangle >= 0)

    @property
    def front(self) -> Array:
        """Which rays hit the front of a triangle: bool."""
        return np.asarray(self.hit & (self.facing == 0))

    def _refs(self) -> Array:
        one = self._scene is not None and len(self._scene.geometries) == 1
        geometry = self._columns.get("geometry", 0) if one else self.geometry
        refs = parse_triangles((geometry, self.triangle), self._shape, "hits")
        assert refs is not None
        return refs

    def _asked(self) -> Rays:
        assert self._rays is not None
        return self._rays if self._row is None else self._rays.take(self._row)

    def _alive(self, name: str) -> Scene:
        if self._scene is None:
            cure = ("; ask for it in the query: columns=(..., \"points\", \"normals\")"
                    if name in VECTORS else "; ask the scene for them here")
            raise RuntimeError(f"{name}: these hits came without their scene, through pickle{cure}")
        if self._version != self._scene._core.version:
            raise RuntimeError(f"{name}: the scene was updated since; ask it again")
        return self._scene

    @property
    def points(self) -> Array:
        """Where they hit, (..., 3): the exact points, each coordinate rounded once; misses NaN.

        Computed when first asked for, about 0.1 us a hit, from the rays as their arrays are then;
        or by the query itself, if `columns` names "points".
        """
        if "points" not in self._columns:
            scene = self._alive("points")
            points = scene._hit_points(self._asked(), self._refs(), self._version)
            self._columns["points"] = points.reshape((*self._shape, 3))
        return self._columns["points"]

    @property
    def normals(self) -> Array:
        """Unit normals of the triangles, (..., 3), each component rounded once; misses NaN.

        They point to where corners run counter-clockwise, whichever side was hit. Computed like
        `points`.
        """
        if "normals" not in self._columns:
            normals = self._alive("normals")._normals(self._refs(), self._version)
            self._columns["normals"] = normals.reshape((*self._shape, 3))
        return self._columns["normals"]

    def interpolate(self, attribute: Any) -> Array:
        """What is given for each vertex, at the hits: w x[a] + u x[b] + v x[c], misses NaN.

        `attribute` has a row for each vertex, (vertices, ...), in a scene of several geometries a
        list of such arrays. Ordinary floating point, in the attribute's type (integers: float64).
        """
        geometries = self._alive("interpolate").geometries
        several = isinstance(attribute, list) and len(geometries) > 1
        tables = [np.asarray(x) for x in (attribute if several else [attribute])]
        if len(tables) != len(geometries):
            raise ValueError(f"{len(tables)} attributes for {len(geometries)} geometries; give a "
                             "list, an array for each")
        if any(table.dtype.kind not in "fiu" or table.ndim == 0 for table in tables):
            raise TypeError("attributes are arrays of numbers, a row for each vertex")
        tail = tables[0].shape[1:]
        kind = np.result_type(np.float32, *[x.dtype for x in tables])
        result = np.full((*self._shape, *tail), np.nan, kind)
        for number, (table, (vertices, triangles)) in enumerate(zip(tables, geometries)):
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
        count = math.prod(self._shape)
        flat = (picked := np.asarray(np.arange(count).reshape(self._shape)[key])).reshape(-1)
        columns = {name: column.reshape((count, *column.shape[len(self._shape):]))[flat]
                   for name, column in self._columns.items()}
        row = flat if self._row is None else self._row[flat]
        return Hits(self._scene, self._rays, columns, picked.shape, self._version, row)

    def __iter__(self) -> Iterator[Hits]:
        return (self[i] for i in range(len(self)))

    def __bool__(self) -> bool:
        """Of a single answer: whether it hit."""
        if self._shape:
            raise ValueError(f"the truth of {self!r} is ambiguous; ask .hit.any() or .hit.all()")
        return bool(self.hit)

    def __copy__(self) -> Hits:
        return self._copied(lambda column: column)

    def __deepcopy__(self, memo: dict[int, Any]) -> Hits:
        return self._copied(np.copy)

    def _read_only(self) -> Hits:
        hits = self._copied(read_only)
        hits._row = None if self._row is None else read_only(self._row)
        return hits

    def _copied(self, copy: Callable[[Array], Array]) -> Hits:
        hits: Hits = object.__new__(type(self))  # of the same scene and rays
        hits.__dict__.update(self.__dict__)
        hits._columns = {name: copy(column) for name, column in self._columns.items()}
        hits.__dict__.update({name: column for name, column in hits._columns.items()
                              if name not in VECTORS})
        return hits

    def __reduce__(self) -> Any:
        return _unpickled, (self._columns, self._shape)

    def __repr__(self) -> str:
        name = type(self).__name__
        if not self._shape:
            if not self.hit:
                return f"{name}(miss)"
            words = [f"{name}={column[()]:.9g}" for name, column in self._frame_of_one().items()]
            return f"{name}({', '.join(words)})"
        return f"{name}(shape={self._shape}, hit={int(self.hit.sum())})"

    def _frame_of_one(self) -> dict[str, Array]:
        return {name: column for name, column in self._columns.items() if name not in VECTORS}


def _unpickled(columns: dict[str, Array], shape: tuple[int, ...]) -> Hits:
    hits = Hits(None, None, {}, shape, 0)
    hits._columns, hits._own = columns, tuple(columns)
    hits.__dict__.update({name: column for name, column in columns.items()
                          if name not in VECTORS})
    return hits


class HitLists(Hits):
    """All hits of each ray: the columns of Hits, one row a hit, ray after ray.

    The hits of ray i are the rows offsets[i] ... offsets[i + 1] - 1, in the exact order
    (t, geometry, triangle); rays count on through their leading shape in C order.
    """

    def __init__(self, scene: Scene | None, rays: Rays | None, columns: dict[str, Array],
                 offsets: Array, ray_shape: tuple[int, ...], version: int = 0):
        self._offsets, self._ray_shape = offsets, ray_shape
        super().__init__(scene, rays, columns, (int(offsets[-1]),), version)

    @classmethod
    def _of_packed_lists(cls, scene: Scene, rays: Rays, packed: bytearray, offsets: Array,
                         version: int) -> HitLists:
        lists: HitLists = object.__new__(cls)
        lists._scene, lists._rays, lists._row = scene, rays, None
        lists._version, lists._own = version, COLUMNS
        lists._offsets, lists._ray_shape = offsets, rays.shape
        count = int(offsets[-1])
        lists._set_packed(packed, PACKED[scene._dtype], count, (count,))
        return lists

    @property
    def ray(self) -> Array:
        """int64, the number of each hit's ray."""
        if self._row is None:
            self._row = np.repeat(np.arange(len(self._offsets) - 1), np.diff(self._offsets))
        return self._row

    @property
    def offsets(self) -> Array:
        """int64, one more than there are rays."""
        return self._offsets

    @property
    def counts(self) -> Array:
        """How many hits each ray has, int64 in the shape of the rays."""
        return np.diff(self._offsets).reshape(self._ray_shape)

    def of(self, ray: int) -> Hits:
        """The hits of one ray, by its number."""
        count = len(self._offsets) - 1
        if not -count <= ray < count:
            raise IndexError(f"there is no ray {ray}; there are {count}")
        ray %= count
        return self[self._offsets[ray]:self._offsets[ray + 1]]

    def __getitem__(self, key: Any) -> Hits:
        """Some of the hits, as NumPy indexes arrays."""
        self.ray  # each hit keeps its own
        return super().__getitem__(key)

    def _asked(self) -> Rays:
        assert self._rays is not None
        return self._rays.take(self.ray)

    def _read_only(self) -> Hits:
        hits = super()._read_only()
        assert isinstance(hits, HitLists)
        hits._offsets = read_only(self._offsets)
        return hits

    def _frame(self) -> dict[str, Array]:
        return {"ray": self.ray, **super()._frame()}

    def __reduce__(self) -> Any:
        return HitLists, (None, None, self._columns, self._offsets, self._ray_shape)

    def __repr__(self) -> str:
        return f"HitLists(rays={len(self._offsets) - 1}, hits={self._shape[0]})"


class Nearest(Table):
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
        self._set(columns, shape)

    @classmethod
    def _of_packed(cls, real: np.dtype[Any], packed: bytearray, shape: tuple[int, ...]) -> Nearest:
        near: Nearest = object.__new__(cls)
        near._set_packed(packed, PACKED_NEAREST[real], math.prod(shape), shape)
        return near

    @property
    def found(self) -> Array:
        """For which points something is near enough: bool."""
        return np.asarray(self.triangle >= 0)

    def __repr__(self) -> str:
        return f"Nearest(shape={self._shape}, found={int(np.sum(self.found))})"


class Crossings(Table):
    """How often rays pass through the surface, each passage once, through an edge or vertex too.

    Attributes:
        count: uint32; of a closed mesh odd iff the origin is inside.
        signed_count: int32; leaving counts +1, entering -1.
        origin_on_surface: bool; the origin lies exactly on a triangle.
    """

    count: Array
    signed_count: Array
    origin_on_surface: Array

    def __init__(self, columns: dict[str, Array], shape: tuple[int, ...]):
        self._set(columns, shape)

    def __repr__(self) -> str:
        return f"Crossings(shape={self._shape})"
