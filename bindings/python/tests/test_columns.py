# SPDX-License-Identifier: Apache-2.0
"""Records and data frames: columns by their names, no masked number and none rounded unasked."""

import importlib.util
from types import SimpleNamespace

import numpy as np
import pytest
from meshes import SQUARE

import pierce

V, T = SQUARE
SCENE = pierce.Scene(V, T)
LARGE = 2**53 + 1  # no float64
MASKED = "points.x: 1 numbers are masked"


class Frame:
    """What a pandas.DataFrame offers."""

    def __init__(self, *columns):
        self.named = [(name, np.asarray(column)) for name, column in columns]
        self.columns = [name for name, _ in columns]

    def items(self):
        return iter(self.named)

    def to_numpy(self):
        return np.stack([column for _, column in self.named], axis=-1)

    def __array__(self, dtype=None, copy=None):
        return self.to_numpy()


def records(names, table):
    return np.array([tuple(row) for row in table], [(name, float) for name in names])


def frame(names, table):
    return Frame(*zip(names, np.asarray(table).T))


def pandas_frame(names, table):
    return pytest.importorskip("pandas").DataFrame(table, columns=list(names))


class ArrowTable:
    """What a pyarrow.Table or RecordBatch offers: its columns are a list without names."""

    def __init__(self, names, columns):
        self.schema = SimpleNamespace(names=list(names))
        self.columns = [np.asarray(column) for column in columns]
        self.num_columns = len(self.columns)

    def __array__(self, dtype=None, copy=None):
        return np.stack(self.columns, axis=-1)


def arrow_like(names, table):
    return ArrowTable(names, np.asarray(table).T)


def arrow_table(names, table):
    arrow = pytest.importorskip("pyarrow")
    return arrow.table(list(np.asarray(table, float).T), names=list(names))


def arrow_batch(names, table):
    arrow = pytest.importorskip("pyarrow")
    return arrow.RecordBatch.from_arrays(list(np.asarray(table, float).T), names=list(names))


forms = pytest.mark.parametrize("form", [records, frame, pandas_frame, arrow_like, arrow_table,
                                         arrow_batch])
BACKWARDS = V[:, ::-1]


@forms
def test_names_wherever_points_are_given(form):
    by_name = form("zyx", BACKWARDS)
    for scene in (pierce.Scene(by_name, T), pierce.Scene((by_name, T)),
                  pierce.Scene([(by_name, T), (V, T)])):
        assert np.array_equal(scene.geometries[0][0], V)
    scene = pierce.Scene(V + 1, T)
    scene.update(by_name)
    assert np.array_equal(scene.geometries[0][0], V)
    scene.update([form("ZYX", BACKWARDS + 2)])
    assert np.array_equal(scene.geometries[0][0], V + 2)
    assert pierce.measure(by_name, T)["area"] == 1 and len(pierce.weld(by_name, T).vertices) == 4
    assert np.array_equal(SCENE.nearest(by_name).point, V)
    to = V + [0, 0, 1]
    made = pierce.rays.between(by_name, to)
    assert np.array_equal(made, pierce.rays.between(V, to))


@forms
def test_names_of_origins_and_directions(form):
    start, down = [[0.25, 0.5, 1]], [[0, 0.125, -1]]
    known = SCENE.closest_hit(start, down)
    for names, directions in ((("oz", "oy", "ox"), ("dz", "dy", "dx")), ("zyx", "zyx")):
        hits = SCENE.closest_hit(form(names, [[1, 0.5, 0.25]]),
                                 form(directions, [[-1, 0.125, 0]]))
        assert hits.t == known.t and hits.triangle == known.triangle and hits.u == known.u
    both = form(["dz", "dy", "dx", "oz", "oy", "ox"], [[-1, 0.125, 0, 1, 0.5, 0.25]])
    assert SCENE.closest_hit(both).u == SCENE.closest_hit(both, both).u == known.u
    unnamed = form("abc", [[0.25, 0.5, 1]])  # in their order, where an array can be made of them
    if form is not records:
        assert SCENE.closest_hit(unnamed, down).u == known.u


@forms
def test_points_are_written_by_name(form, tmp_path):
    pierce.io.write_points(tmp_path / "p.npz", form("zyx", BACKWARDS))
    assert np.array_equal(pierce.io.read_points(tmp_path / "p.npz"), V)


def test_names_that_are_there_twice():
    twice = Frame(("x", [1.0]), ("y", [2.0]), ("z", [3.0]), ("X", [4.0]))
    with pytest.raises(ValueError, match="points: 2 columns are named 'x'; give one"):
        SCENE.nearest(twice)
    other = Frame(("x", [1.0]), ("y", [2.0]), ("z", [3.0]), ("a", [4.0]), ("a", [5.0]))
    assert np.array_equal(SCENE.nearest(other).point, SCENE.nearest([[1, 2, 3.0]]).point)


@forms
def test_a_name_that_is_misspelt(form):
    """Most of the names are there: the others are wrong, and the position would be, too."""
    row = [[-1, 0.125, 0, 1, 0.5, 0.25]]
    with pytest.raises(ValueError, match="rays: there is no column 'ox' beside oy, oz, dx, dy, dz; "
                                         "rename one; did you mean 'o_x'?"):
        SCENE.closest_hit(form(["dz", "dy", "dx", "oz", "oy", "o_x"], row))
    with pytest.raises(ValueError, match="no column 'ox', 'dz' beside oy, oz, dx, dy; rename one$"):
        SCENE.closest_hit(form(["down", "dy", "dx", "oz", "oy", "start"], row))
    with pytest.raises(ValueError, match="points: there is no column 'x' beside y, z; rename one"):
        SCENE.nearest(form(["Z", "Y", "height"], BACKWARDS))
    with pytest.raises(ValueError, match="origins: there is no column 'oz' beside ox, oy"):
        SCENE.closest_hit(form(["ox", "oy", "o_z"], V), [0, 0, 1])
    with pytest.raises(ValueError, match="directions: there is no column 'z' beside x, y"):
        SCENE.closest_hit(V, form(["x", "y", "dz"], V))
    with pytest.raises(ValueError, match="vertices: there is no column 'y' beside x, z"):
        pierce.Scene(form(["x", "yy", "z"], V), T)


def test_columns_of_text_do_not_matter():
    rays = "dz dy dx oz oy ox name".split(), [[-1.0], [0.125], [0.0], [1.0], [0.5], [0.25], ["a"]]
    known = SCENE.closest_hit([[0.25, 0.5, 1]], [[0, 0.125, -1]])
    tables = [Frame(*zip(*rays)), ArrowTable(*rays)]
    if importlib.util.find_spec("pandas"):
        tables.append(importlib.import_module("pandas").DataFrame(dict(zip(*rays))))
    if importlib.util.find_spec("pyarrow"):
        arrow = importlib.import_module("pyarrow")
        tables += [arrow.table(dict(zip(*rays))), arrow.record_batch(dict(zip(*rays)))]
    for table in tables:
        hits = SCENE.closest_hit(table)
        assert hits.t == known.t == 1 and hits.u == known.u


def test_rows_of_a_frame():
    """`df.iloc[0]` has the names of the columns, and the type object if one of them is text."""
    pandas = pytest.importorskip("pandas")
    for dtype in (np.float32, np.float64):
        scene = pierce.Scene(V.astype(dtype), T)
        rays = pandas.DataFrame([[-1, 0.125, 0, 1, 0.5, 0.25]], dtype=dtype,
                                columns="dz dy dx oz oy ox".split())
        known = scene.closest_hit([0.25, 0.5, 1], [0, 0.125, -1])
        for frame_of in (rays, rays.assign(name="a")):
            row = frame_of.iloc[0]
            hits = scene.closest_hit(row)
            assert hits.shape == () and hits.t == known.t == 1 and hits.u == known.u
        point = pandas.Series({"z": 2, "y": 0.5, "x": 0.25}, dtype=dtype)
        assert scene.nearest(point).distance == 2
    assert SCENE.nearest(pandas.Series([0.25, 0.5, 2.0])).distance == 2  # by position
    assert SCENE.nearest(pandas.Series([0.25, 0.5, 2.0], list("abc"))).distance == 2


def test_masked_numbers():
    points = np.ma.array(np.zeros(2, [(name, int) for name in "xyz"]),
                         mask=[(True, False, False), (False, False, False)])
    with pytest.raises(ValueError, match=MASKED):
        SCENE.nearest(points)
    assert SCENE.nearest(points[1:]).distance == 0
    rays = np.ma.zeros(2, [(name, float) for name in "ox oy oz dx dy dz other".split()])
    rays["oz"], rays["dz"] = 1, -1
    rays["other"] = np.ma.masked
    assert SCENE.closest_hit(rays).t.tolist() == [1, 1]  # what is not asked for may be
    rays["ox"] = np.ma.masked
    with pytest.raises(ValueError, match="rays.ox: 2 numbers are masked"):
        SCENE.closest_hit(rays)
    row = np.ma.array([0.25, 0.5, 1], mask=[0, 0, 1])
    for several in ([row], [[0, 0, 0], row], [[row, row]], ([0, 0, np.ma.masked],)):
        with pytest.raises(ValueError, match="numbers are masked"):
            SCENE.nearest(several)
    with pytest.raises(ValueError, match="vertices: 1 numbers are masked"):
        pierce.Scene([row, [1, 0, 0], [0, 1, 0]], [[0, 1, 2]])
    assert SCENE.nearest([np.ma.array([0.25, 0.5, 1.0])]).distance == 1


def test_integers_beside_floats_are_not_rounded():
    mixed = [("x", int), ("y", float), ("z", float)]
    for form in (lambda x: np.array([(x, 0.5, 0)], mixed),
                 lambda x: Frame(("x", [x]), ("y", [0.5]), ("z", [0.0])),
                 lambda x: Frame(("a", [x]), ("b", [0.5]), ("c", [0.0])),
                 lambda x: Frame(("a", [x]), ("b", np.uint64([1])), ("c", [0]))):
        with pytest.raises(ValueError, match=f"points: {LARGE} is no float64; round it yourself"):
            SCENE.nearest(form(LARGE))
        for exact in (LARGE + 1, 3):
            assert SCENE.nearest(form(exact)).distance == exact - 1
    rays = Frame(*((name, [x]) for name, x in zip(
        ("ox", "oy", "oz", "dx", "dy", "dz", "t_max"), (0, 0, 1, 0, 0, -1, 0.5))))
    assert not SCENE.closest_hit(rays).hit.any()
    single = np.array([(1, 0.5, 0)], [("x", np.int8), ("y", np.float32), ("z", np.float32)])
    assert pierce.Scene(V.astype(np.float32), T).nearest(single).distance == 0
