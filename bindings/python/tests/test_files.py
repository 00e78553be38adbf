# SPDX-License-Identifier: Apache-2.0
"""pierce.io: rays and points from files of every format, hits and points to them."""

import importlib.util
import io
import zipfile

import numpy as np
import pytest

import pierce
import pierce.io

NEEDS = {".parquet": "pyarrow", ".zarr": "zarr", ".las": "laspy", ".laz": "lazrs"}


def ending(*names):
    """Endings as parameters, those skipped whose package is missing."""
    return pytest.mark.parametrize("ending", [
        pytest.param(name, marks=pytest.mark.skipif(
            name in NEEDS and importlib.util.find_spec(NEEDS[name]) is None,
            reason=f"{NEEDS.get(name)} is not installed")) for name in names])


def scene_of(dtype=np.float64, count=300):
    random = np.random.default_rng(3)
    corners = random.uniform(-1, 1, (count, 1, 3)) + random.uniform(-0.3, 0.3, (count, 3, 3))
    return pierce.Scene(corners.reshape(-1, 3).astype(dtype),
                        np.arange(3 * count, dtype=np.uint32).reshape(-1, 3))


def rays_of(dtype=np.float64, count=1000, width=6):
    rays = np.random.default_rng(4).uniform(-1, 1, (count, width)).astype(dtype)
    if width == 8:
        rays[:, 6], rays[:, 7] = 0, np.inf
    return rays


def write_columns(path, table, one_array, name):
    """A file as other programs write it."""
    kind = path.suffix
    if kind == ".npy":
        records = np.zeros(len(one_array), [(n, c.dtype) for n, c in table.items()])
        for n, c in table.items():
            records[n] = c
        np.save(path, records if name == "columns" else one_array)
    elif kind == ".npz":
        np.savez(path, **(table if name == "columns" else {name: one_array}))
    elif kind == ".parquet":
        import pyarrow
        import pyarrow.parquet
        pyarrow.parquet.write_table(pyarrow.table(table), path, row_group_size=300)
    elif name == "columns":
        import zarr
        group = zarr.create_group(path)
        for n, c in table.items():
            group.create_array(n, data=c, chunks=(256,))
    else:
        import zarr
        zarr.create_array(path, data=one_array, chunks=(256, one_array.shape[1]))


@ending(".npy", ".npz", ".parquet", ".zarr")
@pytest.mark.parametrize("layout", ["columns", "array"])
@pytest.mark.parametrize("dtype", [np.float32, np.float64])
@pytest.mark.parametrize("width", [3, 6, 8])
def test_reading(tmp_path, ending, layout, dtype, width):
    kind = "points" if width == 3 else "rays"
    array = rays_of(dtype, 1000, width)
    names = "xyz" if width == 3 else ("ox oy oz dx dy dz t_min t_max".split())[:width]
    table = {"other": np.arange(1000), **dict(zip(names, array.T))}
    path = tmp_path / f"a{ending}"
    write_columns(path, table, array, "columns" if layout == "columns" else kind)
    read = getattr(pierce.io, f"read_{kind}")
    found = read(path)
    assert found.dtype == dtype and np.array_equal(found, array)
    assert read(path, dtype=np.float32).dtype == np.float32
    chunks = list(getattr(pierce.io, f"{kind[:-1] if kind == 'points' else 'ray'}_chunks")(
        str(path), 170))
    assert [len(chunk) for chunk in chunks] == [170] * 5 + [150]
    assert np.array_equal(np.concatenate(chunks), array)


@ending(".npy", ".npz", ".parquet", ".zarr")
def test_hits_and_lists(tmp_path, ending):
    scene, rays = scene_of(), rays_of().reshape(20, 50, 6)
    hits, lists = scene.closest_hit(rays), scene.all_hits(rays)
    path = tmp_path / f"hits{ending}"
    pierce.io.write_hits(path, hits, points=True, number=np.arange(1000).reshape(20, 50))
    table = columns_of(path)
    for name in ("t", "u", "v", "w", "geometry", "triangle", "facing"):
        expected = getattr(hits, name).reshape(-1)
        assert table[name].dtype == expected.dtype and np.array_equal(table[name], expected)
    assert np.array_equal(np.stack([table[a] for a in "xyz"], 1), hits.points.reshape(-1, 3),
                          equal_nan=True)
    assert np.array_equal(table["number"], np.arange(1000))
    path = tmp_path / f"lists{ending}"
    pierce.io.write_hits(path, (scene.all_hits(rays[i:i + 7]) for i in range(0, 20, 7)))
    table = columns_of(path)
    assert np.array_equal(table["ray"], lists.ray) and np.array_equal(table["t"], lists.t)
    assert sorted(p.name for p in tmp_path.iterdir()) == sorted([f"hits{ending}", path.name])


def columns_of(path):
    """All columns of a file that was written, read by others."""
    if path.suffix == ".parquet":
        import pyarrow.parquet
        table = pyarrow.parquet.read_table(path)
        return {name: table[name].to_numpy() for name in table.column_names}
    if path.suffix == ".zarr":
        import zarr
        return {name: array[:] for name, array in zarr.open_group(path, mode="r").arrays()}
    file = np.load(path)
    return {name: file[name] for name in (file.files if path.suffix == ".npz" else
                                          file.dtype.names)}


@ending(".las", ".laz")
def test_scans(tmp_path, ending):
    import laspy
    scene, rays = scene_of(), rays_of()
    lists, path = scene.all_hits(rays), tmp_path / f"scan{ending}"
    pierce.io.write_hits(path, (scene.all_hits(rays[i:i + 300]) for i in range(0, 1000, 300)),
                         scale=2.0**-20)
    with laspy.open(path) as file:
        las = file.read()
        assert file.header.are_points_compressed == (ending == ".laz")
    assert np.array_equal(las["ray"], lists.ray) and np.array_equal(las["t"], lists.t)
    assert np.array_equal(las["triangle"], lists.triangle)
    counts = lists.counts[lists.ray]
    assert counts.max() > 2
    assert np.array_equal(las["number_of_returns"], np.minimum(counts, 15))
    assert np.array_equal(las["return_number"],
                          np.minimum(np.arange(len(counts)) - lists.offsets[lists.ray] + 1, 15))
    points = pierce.io.read_points(path)  # steps of 2^-20 are exact: each is the nearest
    assert points.dtype == np.float64
    assert np.array_equal(points * 2.0**20, np.rint(lists.points * 2.0**20))
    assert sum(map(len, pierce.io.point_chunks(path, 700))) == len(points)

    hits = scene.closest_hit(rays)
    pierce.io.write_hits(path, hits, gps_time=np.arange(1000) * 0.5, seen=hits.hit,
                         intensity=np.arange(1000))
    las = laspy.read(path)
    assert np.array_equal(las["ray"], np.flatnonzero(hits.hit))
    assert np.array_equal(las["gps_time"], las["ray"] * 0.5)
    assert np.array_equal(las["intensity"], las["ray"])


def test_copc_is_read_as_the_laz_that_it_is(tmp_path):
    copclib = pytest.importorskip("copclib")
    pytest.importorskip("lazrs")
    path = tmp_path / "scan.copc.laz"
    step = copclib.Vector3(*3 * [2.0**-10])
    writer = copclib.FileWriter(str(path), copclib.CopcConfigWriter(7, step,
                                                                    copclib.Vector3(0, 0, 0)))
    written = np.random.default_rng(3).integers(-2**20, 2**20, (3, 50, 3)) * 2.0**-10
    for key, node in zip(((0, 0, 0, 0), (1, 0, 0, 0), (1, 1, 1, 1)), written):
        points = copclib.Points(writer.copc_config.las_header)
        for x, y, z in node:
            point = points.CreatePoint()
            point.x, point.y, point.z = x, y, z
            points.AddPoint(point)
        writer.AddNode(copclib.VoxelKey(*key), points)
    writer.Close()
    read = np.concatenate(list(pierce.io.point_chunks(path, 40)))
    assert np.array_equal(read[np.lexsort(read.T)],
                          written.reshape(-1, 3)[np.lexsort(written.reshape(-1, 3).T)])


@ending(".las", ".laz")
def test_rays_of_a_scan(tmp_path, ending):
    path = tmp_path / f"scan{ending}"
    measured = np.random.default_rng(1).integers(-2**20, 2**20, (500, 3)) * 2.0**-10
    pierce.io.write_points(path, measured, scale=2.0**-10, gps_time=np.arange(500.0))
    assert np.array_equal(pierce.io.read_points(path), measured)
    with pytest.raises(pierce.BadFile, match="origin="):
        pierce.io.read_rays(path)
    origins = np.stack([np.arange(500.0), np.zeros(500), np.full(500, 99.0)], 1)
    for origin in (origins, lambda times: origins[times.astype(int)]):
        rays = np.concatenate(list(pierce.io.ray_chunks(path, 130, origin=origin)))
        assert np.array_equal(rays[:, :3], origins)
        assert np.array_equal(rays[:, :3] + rays[:, 3:], measured)
    rays = pierce.io.read_rays(path, origin=(1, 2, 3), dtype=np.float32)
    assert rays.dtype == np.float32 and (rays[:, :3] == [1, 2, 3]).all()
    for origin in (origins[:499], lambda times: origins[:1], [1, 2]):
        with pytest.raises(ValueError, match="one point, or one for each"):
            pierce.io.read_rays(path, origin=origin)
    data = path.read_bytes()
    path.write_bytes(data[:len(data) * 2 // 3])
    with pytest.raises(pierce.BadFile, match="scan"):
        pierce.io.read_points(path)


@ending(".las")
def test_what_las_cannot_hold(tmp_path, ending):
    path = tmp_path / "a.las"
    for points in ([[0, 0, 0], [1e7, 0, 0]], [[0, 0, 0], [np.nan, 0, 0]], [[0, np.inf, 0]]):
        with pytest.raises(ValueError, match="is no point that LAS can hold"):
            pierce.io.write_points(path, points)
    with pytest.raises(ValueError, match="give the column another name"):
        pierce.io.write_points(path, np.zeros((2, 3)), intensity=[1, 70000])
    with pytest.raises(ValueError, match="scale is 0"):
        pierce.io.write_points(path, np.zeros((2, 3)), scale=0)
    assert not list(tmp_path.iterdir())  # nothing is left of what failed
    pierce.io.write_points(path, np.zeros((0, 3)))
    assert pierce.io.read_points(path).shape == (0, 3)
    pierce.io.write_hits(path, iter([]))
    assert pierce.io.read_points(path).shape == (0, 3)


@ending(".npy", ".npz", ".parquet", ".zarr", ".las")
def test_what_is_wrong(tmp_path, ending):
    path = tmp_path / f"a{ending}"
    with pytest.raises(FileNotFoundError):
        pierce.io.read_rays(path)
    path.write_bytes(b"these are no numbers")
    with pytest.raises(pierce.BadFile, match=f"a{ending}: "):
        pierce.io.read_points(path)
    path.unlink()
    pierce.io.write_points(path, np.zeros((2, 3)))
    with pytest.raises(pierce.BadFile, match="origin=|no column 'ox'"):
        pierce.io.read_rays(path)
    if ending == ".zarr":
        with pytest.raises(FileExistsError):
            pierce.io.write_points(path, np.zeros((2, 3)))


@ending(".npy", ".npz", ".parquet", ".zarr", ".las")
def test_hits_that_do_not_go_together(tmp_path, ending):
    double, single, rays = scene_of(), scene_of(np.float32), rays_of()
    hits, lists = double.closest_hit(rays), double.all_hits(rays)
    path = tmp_path / f"a{ending}"
    for several, words in (
            ([hits, lists], "hits 1 are HitLists, those before Hits; a file holds"),
            ([lists, lists, hits], "hits 2 are Hits, those before HitLists; a file holds"),
            ([hits, double.closest_hit(rays, columns=("t",))], "hits 1 have the columns"),
            ([double.closest_hit(rays, columns=("t",)), hits], "hits 1 have the columns"),
            ([single.closest_hit(rays.astype(np.float32)), hits], "is float64 in hits 1, and was")):
        with pytest.raises(ValueError, match=words):
            pierce.io.write_hits(path, iter(several))
        assert not list(tmp_path.iterdir())  # nothing half written is left
    for wrong in (3, [3]):
        with pytest.raises(TypeError, match="are int; give"):
            pierce.io.write_hits(path, wrong)
    if ending != ".zarr":  # which makes its folders
        with pytest.raises(FileNotFoundError, match="no folder") as caught:
            pierce.io.write_hits(tmp_path / "no" / path.name, hits)
        assert caught.value.filename == str(tmp_path / "no" / path.name)


def test_files_that_cannot_be_written_are_named(tmp_path):
    (tmp_path / "a.npy").mkdir()
    with pytest.raises(OSError) as caught:
        pierce.io.write_points(tmp_path / "a.npy", np.zeros((2, 3)))
    assert caught.value.filename == str(tmp_path / "a.npy")
    assert [p.name for p in tmp_path.iterdir()] == ["a.npy"]


def test_npz_that_hold_nothing_or_too_much(tmp_path):
    np.savez(tmp_path / "a.npz")
    with pytest.raises(pierce.BadFile, match="a.npz: holds no array; rays have the columns ox oy"):
        pierce.io.read_rays(tmp_path / "a.npz")
    with zipfile.ZipFile(tmp_path / "b.npz", "w") as file:
        head = io.BytesIO()
        np.lib.format.write_array_header_1_0(
            head, {"descr": "<f8", "fortran_order": False, "shape": (10**13, 6)})
        file.writestr("rays.npy", head.getvalue() + bytes(48))
    with pytest.raises(MemoryError, match="b.npz: .*formats but .npz are read"):
        pierce.io.read_rays(tmp_path / "b.npz")


def test_bad_arguments(tmp_path):
    hits = scene_of().closest_hit(rays_of())
    for wrong in (lambda: pierce.io.read_rays(tmp_path / "a.txt"),
                  lambda: pierce.io.write_hits(tmp_path / "a.txt", hits),
                  lambda: pierce.io.write_hits(tmp_path / "a.npz", hits, t=hits.t),
                  lambda: pierce.io.write_hits(tmp_path / "a.npz", hits, more=hits.t[:9]),
                  lambda: pierce.io.write_hits(tmp_path / "a.npz", iter([hits]), more=hits.u),
                  lambda: pierce.io.write_points(tmp_path / "a.npz", np.zeros((3, 2)))):
        with pytest.raises(ValueError):
            wrong()
    np.save(tmp_path / "a.npy", np.zeros((4, 5)))
    with pytest.raises(pierce.BadFile, match=r"of the shape \(n, 6 or 8\)"):
        pierce.io.read_rays(tmp_path / "a.npy")
    np.save(tmp_path / "a.npy", np.zeros((4, 3)))
    with pytest.raises(TypeError, match="give float32 or float64"):
        pierce.io.read_points(tmp_path / "a.npy", dtype=np.int32)
    with pytest.raises(ValueError, match="rows is 0"):
        list(pierce.io.point_chunks(tmp_path / "a.npy", 0))
    for rows in (1.5, "9", None):
        with pytest.raises(TypeError, match="rows is .*; give a whole number"):
            next(pierce.io.ray_chunks(tmp_path / "a.npy", rows))
    masked = np.ma.array(np.zeros((2, 3)), mask=[[0, 0, 1], [0, 0, 0]])
    with pytest.raises(ValueError, match="1 numbers are masked"):
        pierce.io.write_points(tmp_path / "b.npz", masked)
    assert [p.name for p in tmp_path.iterdir()] == ["a.npy"]
