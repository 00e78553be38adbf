# SPDX-License-Identifier: Apache-2.0
"""Scenes in files: saved, opened, pickled by path; jobs on executors; Dask arrays."""

import pickle
import subprocess
import sys
from concurrent.futures import ProcessPoolExecutor, ThreadPoolExecutor

import numpy as np
import pytest

import pierce
import pierce.dask
import pierce.job
import pierce.ray


def cloud(dtype, count=500):
    random = np.random.default_rng(3)
    vertices = random.uniform(-1, 1, (3 * count, 3)).astype(dtype)
    return vertices, np.arange(3 * count, dtype=np.uint32).reshape(-1, 3)


def rays(dtype, count=2000):
    return np.random.default_rng(4).uniform(-2, 2, (count, 6)).astype(dtype)


def same(one, other, asked):
    a, b = one.closest_hit(asked), other.closest_hit(asked)
    return all(np.array_equal(getattr(a, name), getattr(b, name))
               for name in ("t", "u", "v", "w", "geometry", "triangle", "facing"))


@pytest.mark.parametrize("dtype", [np.float32, np.float64])
def test_answers_are_those_of_the_scene(tmp_path, dtype):
    mesh, asked, path = cloud(dtype), rays(dtype), tmp_path / "a.pierce"
    scene = pierce.Scene([mesh, (mesh[0] + dtype(0.5), mesh[1])], masks=[1, 2], quality="high")
    scene.save(path)
    for verify in (False, True):
        opened = pierce.open(path, verify=verify)
        assert repr(opened) == repr(scene)
        assert same(opened, scene, asked)
        assert np.array_equal(opened.count_hits(asked, mask=2), scene.count_hits(asked, mask=2))
        assert np.array_equal(opened.geometries[1][0], scene.geometries[1][0])
    size = len(pickle.dumps(opened))
    assert size < 1000
    assert same(pickle.loads(pickle.dumps(opened)), scene, asked)
    moved = [v * dtype(2) for v, _ in scene.geometries]
    opened.update(moved)
    scene.update(moved)
    assert same(opened, scene, asked)
    assert same(pickle.loads(pickle.dumps(opened)), scene, asked)  # no longer the file's
    assert len(pickle.dumps(opened)) > size


def test_what_is_wrong(tmp_path):
    path = tmp_path / "a.pierce"
    with pytest.raises(FileNotFoundError):
        pierce.open(path)
    path.write_bytes(b"OFF\n")
    with pytest.raises(pierce.BadFile, match="is no scene file"):
        pierce.open(path)
    scene = pierce.Scene(*cloud(np.float32, 9))
    scene.save(path)
    pickled = pickle.dumps(pierce.open(path))
    pierce.Scene(*cloud(np.float32, 8)).save(path)
    with pytest.raises(pierce.BadFile, match="is not the scene that was pickled"):
        pickle.loads(pickled)
    with pytest.raises(pierce.BadFile, match="make its folder first"):
        scene.save(tmp_path / "no" / "a.pierce")


@pytest.mark.parametrize("dtype", [np.float32, np.float64])
def test_placed_meshes_share_a_tree_beyond_the_limit(tmp_path, dtype):
    mesh, asked = cloud(dtype), rays(dtype)
    moves = [np.eye(4) for _ in range(20)]
    for i, move in enumerate(moves):
        move[:3, 3] = i / 64, -i / 32, 0
    placed = [(mesh, move) for move in moves]
    flat, shared = pierce.Scene(placed), pierce.Scene(placed, flatten_limit=0)
    assert shared.info()["bytes"] < flat.info()["bytes"] / 4
    for scene in (shared, pickle.loads(pickle.dumps(shared))):
        assert same(scene, flat, asked)
        assert np.array_equal(scene.count_hits(asked), flat.count_hits(asked))
        starts, ends = asked[..., :3], asked[..., :3] + asked[..., 3:6]
        assert scene.k_nearest(starts, 5).distance.tolist() == (
            flat.k_nearest(starts, 5).distance.tolist())
        touched, expected = (s.touching_segments(starts, ends) for s in (scene, flat))
        assert touched.counts.tolist() == expected.counts.tolist()
        assert touched.geometry.tolist() == expected.geometry.tolist()
        with pytest.raises(ValueError, match="larger flatten_limit"):
            scene.save(tmp_path / "a.pierce")
    pierce.Scene(placed, flatten_limit=2**40).save(tmp_path / "a.pierce")
    assert same(pierce.open(tmp_path / "a.pierce"), flat, asked)
    for limit, error in ((-1, ValueError), (2**64, ValueError), (1.5, TypeError)):
        with pytest.raises(error, match="flatten_limit is"):
            pierce.Scene(placed, flatten_limit=limit)


@pytest.mark.skipif(not pierce.job.tool_path().exists(), reason="built without the command")
@pytest.mark.parametrize("pool", [ThreadPoolExecutor, ProcessPoolExecutor])
def test_jobs_run_on_executors(tmp_path, pool):
    scene, folder = tmp_path / "a.pierce", tmp_path / "job"
    pierce.Scene(*cloud(np.float32)).save(scene)
    arguments = [scene, "--sphere", "20000", "--seed", "5"]
    pierce.job.create(folder, *arguments, "--chunk", "3000")
    fractions = []
    with pool(2) as executor:
        told = pierce.job.run(folder, executor, progress=fractions.append)
    assert told.complete and (told.rays, told.chunks) == (20000, 7)
    assert fractions[-1] == 1 and len(fractions) == 7
    pierce.job.verify(folder, 2)
    pierce.job.merge(folder, tmp_path / "merged.npy")
    subprocess.run([pierce.job.tool_path(), "cast", *arguments, "--out", tmp_path / "cast.npy"],
                   check=True, capture_output=True)
    assert (tmp_path / "merged.npy").read_bytes() == (tmp_path / "cast.npy").read_bytes()
    with pytest.raises(ValueError, match="was not expected"):
        pierce.job.create(tmp_path / "other", scene, "--nonsense")
    with pytest.raises(pierce.BadFile, match="holds no job"):
        pierce.job.status(tmp_path / "other")


def test_dask_arrays(tmp_path):
    array = pytest.importorskip("dask.array")
    scene, path = pierce.Scene(*cloud(np.float32)), tmp_path / "a.pierce"
    with pytest.raises(ValueError, match="is not in a file"):
        pierce.dask.cast(scene, array.zeros((2, 6)))
    scene.save(path)
    asked = rays(np.float32)
    lazy = array.from_array(asked, chunks=(700, 3))
    hits, found = scene.closest_hit(asked), pierce.dask.cast(path, lazy).compute()
    for name in found.dtype.names:
        assert np.array_equal(found[name], getattr(hits, name)), name
    assert np.array_equal(pierce.dask.cast(path, lazy, query="any").compute(), scene.any_hit(asked))
    counts = pierce.dask.cast(str(path), lazy, query="count", sides="front").compute()
    assert np.array_equal(counts, scene.count_hits(asked, sides="front"))


def test_what_blocks_cannot_do_is_refused_at_the_call(tmp_path):
    array = pytest.importorskip("dask.array")
    scene, path = pierce.Scene(*cloud(np.float64)), tmp_path / "a.pierce"
    scene.save(path)
    asked = rays(np.float64)
    lazy = array.from_array(asked, chunks=(700, 6))
    ranges = np.linspace(0, 3, len(asked))
    for several in (ranges, ranges[:2], [1, 2], array.from_array(ranges)):
        with pytest.raises(ValueError, match="t_max is an array.* or rays .n, 8. with t_min"):
            pierce.dask.cast(path, lazy, query="any", t_max=several)
    hits = scene.closest_hit(asked)
    for name, value in (("mask", np.ones(len(asked), int)), ("skip", hits), ("after", [0, 1]),
                        ("skip", (0, hits.triangle)), ("t_min", ranges)):
        with pytest.raises(ValueError, match=f"{name} is an array.* give one for all rays"):
            pierce.dask.cast(path, lazy, **{name: value})
        with pytest.raises(ValueError, match=f"{name} is an array"):
            pierce.ray.Caster(path, **{name: value})
    for options, words in (({"side": "front"}, "side is no option here; there are t_min.*'sides'"),
                           ({"columns": ("t",)}, "columns is no option"),
                           ({"query": "any", "out": hits}, "out is no option")):
        with pytest.raises(TypeError, match=words):
            pierce.dask.cast(path, lazy, **options)
    for wrong in (asked.tolist(), hits):
        with pytest.raises(TypeError, match=f"rays are {type(wrong).__name__}; give a Dask array"):
            pierce.dask.cast(path, wrong)
    one = {"t_max": np.float64(2), "t_min": 0.5, "skip": (0, 3), "mask": 1, "sides": "front"}
    assert np.array_equal(pierce.dask.cast(path, asked, query="any", **one).compute(),
                          scene.any_hit(asked, **one))
    both = np.concatenate([asked, np.zeros((len(asked), 1)), ranges[:, None]], axis=1)
    assert np.array_equal(pierce.dask.cast(path, both, query="count").compute(),
                          scene.count_hits(asked, t_max=ranges))


def test_processes_share_the_file(tmp_path):
    path = tmp_path / "a.pierce"
    pierce.Scene(*cloud(np.float32)).save(path)
    code = ("import pierce, sys; s = pierce.open(sys.argv[1]);"
            "print(s.closest_hit([0, 0, 3, 0, 0.25, -1]).t)")
    told = {subprocess.run([sys.executable, "-c", code, path], capture_output=True, text=True,
                           check=True).stdout for _ in range(2)}
    assert len(told) == 1
