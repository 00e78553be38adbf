# SPDX-License-Identifier: Apache-2.0
"""Dask, Ray and MPI, each with workers of its own, one of which is killed."""

import os
import shutil
import signal
import subprocess
import sys
import threading
import time

import numpy as np
import pytest

import pierce
import pierce.dask
import pierce.job
import pierce.ray

COLUMNS = ("t", "u", "v", "w", "geometry", "triangle", "facing")
tool = pytest.mark.skipif(not pierce.job.tool_path().exists(), reason="built without the command")


@pytest.fixture
def scene(tmp_path):
    random = np.random.default_rng(3)
    corners = random.uniform(-1, 1, (500, 1, 3)) + random.uniform(-0.2, 0.2, (500, 3, 3))
    made = pierce.Scene(corners.reshape(-1, 3), np.arange(1500).reshape(-1, 3))
    made.save(tmp_path / "a.pierce")
    return pierce.open(tmp_path / "a.pierce")


def rays(count=6000):
    return np.random.default_rng(4).uniform(-1, 1, (count, 6))


@pytest.fixture(scope="module")
def cluster():
    distributed = pytest.importorskip("distributed", reason="Dask is not installed")
    with distributed.LocalCluster(n_workers=2, threads_per_worker=1, processes=True,
                                  dashboard_address=None, silence_logs="CRITICAL") as workers, \
            distributed.Client(workers) as client:
        yield client


def slow_block(block, started):
    """What makes a block last, so that its worker can be killed meanwhile."""
    open(os.path.join(started, str(os.getpid())), "w").close()
    time.sleep(0.2)
    return block


def kill_a_worker(started, killed):
    """Kills a worker that has begun a block; its nanny makes a new one."""
    while not list(started.iterdir()):
        time.sleep(0.01)
    killed.append(int(next(started.iterdir()).name))
    os.kill(killed[0], signal.SIGKILL)


def test_dask_with_a_killed_worker(scene, tmp_path, cluster):
    array = pytest.importorskip("dask.array")
    asked, started = rays(), tmp_path / "started"
    started.mkdir()
    slow = array.map_blocks(slow_block, array.from_array(asked, chunks=(500, 6)), str(started),
                            dtype=float, meta=np.empty((0, 6)))
    killed = []
    killer = threading.Thread(target=kill_a_worker, args=(started, killed))
    killer.start()
    found = pierce.dask.cast(scene, slow).compute()
    killer.join()
    assert killed and killed[0] not in cluster.run(os.getpid).values()
    hits = scene.closest_hit(asked)
    for name in COLUMNS:
        assert np.array_equal(found[name], getattr(hits, name)), name


def test_dask_from_zarr_to_zarr(scene, tmp_path, cluster):
    zarr = pytest.importorskip("zarr")
    asked = rays()
    zarr.create_array(str(tmp_path / "rays.zarr"), data=asked, chunks=(1000, 6))
    lazy = pierce.dask.cast(scene, tmp_path / "rays.zarr")
    assert lazy.numblocks == (6,)
    pierce.dask.store(lazy, tmp_path / "hits.zarr")
    hits, stored = scene.closest_hit(asked), zarr.open_group(tmp_path / "hits.zarr", mode="r")
    assert sorted(stored.array_keys()) == sorted(COLUMNS)
    for name in COLUMNS:
        expected = getattr(hits, name)
        assert stored[name].dtype == expected.dtype and stored[name].chunks == (1000,)
        assert np.array_equal(stored[name][:], expected), name
    uneven = pierce.dask.cast(scene, asked_in(asked, (7, 993, 2000, 3000)),
                              query="any")
    pierce.dask.store(uneven, tmp_path / "any.zarr", compute=False).compute()
    assert np.array_equal(zarr.open_array(tmp_path / "any.zarr", mode="r")[:], scene.any_hit(asked))
    with pytest.raises(FileExistsError):
        pierce.dask.store(uneven, tmp_path / "any.zarr")


def asked_in(asked, sizes):
    import dask.array
    return dask.array.from_array(asked, chunks=(sizes, (6,)))


def job(folder, tmp_path):
    """A job, and the bytes that it must end in."""
    arguments = [tmp_path / "a.pierce", "--sphere", "40000", "--seed", "5"]
    pierce.job.create(folder, *arguments, "--chunk", "2000")
    subprocess.run([pierce.job.tool_path(), "cast", *arguments, "--out", tmp_path / "cast.npy"],
                   check=True, capture_output=True)
    return (tmp_path / "cast.npy").read_bytes()


def merged(folder, tmp_path):
    pierce.job.merge(folder, tmp_path / "merged.npy")
    return (tmp_path / "merged.npy").read_bytes()


@tool
def test_a_job_on_dask_with_a_killed_worker(scene, tmp_path, cluster):
    expected = job(tmp_path / "job", tmp_path)
    victims = list(cluster.run(os.getpid).values())

    def kill(fraction):
        if fraction >= 0.2 and victims:
            os.kill(victims.pop(), signal.SIGKILL)
            victims.clear()

    told = pierce.job.run(tmp_path / "job", cluster.get_executor(), progress=kill)
    assert not victims and told.complete
    assert merged(tmp_path / "job", tmp_path) == expected


MPI = """
import sys
import pierce.job
from mpi4py.futures import MPIPoolExecutor

if __name__ == "__main__":
    with MPIPoolExecutor() as executor:
        print(executor.num_workers, pierce.job.run(sys.argv[1], executor).complete)
"""


@tool
def test_a_job_on_mpi(scene, tmp_path):
    pytest.importorskip("mpi4py")
    if shutil.which("mpirun") is None:
        pytest.skip("there is no mpirun here: apt-get install openmpi-bin")
    expected = job(tmp_path / "job", tmp_path)
    (tmp_path / "run.py").write_text(MPI)
    done = subprocess.run(
        ["mpirun", "--allow-run-as-root", "--oversubscribe", "-n", "3", sys.executable, "-m",
         "mpi4py.futures", tmp_path / "run.py", tmp_path / "job"], cwd=tmp_path, check=False,
        capture_output=True, text=True, timeout=300)
    assert done.returncode == 0 and done.stdout.split() == ["2", "True"], done.stdout + done.stderr
    assert merged(tmp_path / "job", tmp_path) == expected


def test_batches_of_columns(scene):
    asked, far = rays(), np.full(6000, 0.5)
    hits, near = scene.closest_hit(asked), scene.closest_hit(asked, t_max=0.5)
    assert (hits.triangle != near.triangle).any()
    names = ("ox", "oy", "oz", "dx", "dy", "dz")
    batch = {"name": np.arange(6000), **dict(zip(names, asked.T))}
    caster = pierce.ray.Caster(scene)
    for given, expected in ((batch, hits), ({"rays": asked}, hits),
                            ({**batch, "t_min": far * 0, "t_max": far}, near)):
        found = caster(given)
        assert list(found) == [*given, *COLUMNS]
        for name in COLUMNS:
            assert np.array_equal(found[name], getattr(expected, name)), name
    counts = pierce.ray.Caster(str(scene._file[0]), query="count", sides="front")(batch)["hits"]
    assert np.array_equal(counts, scene.count_hits(asked, sides="front"))
    with pytest.raises(ValueError, match="no column 'dz'"):
        caster({name: batch[name] for name in names[:5]})
    with pytest.raises(ValueError, match="no column 't_min'"):
        caster({**batch, "t_max": far})
    with pytest.raises(ValueError, match="a column 't' already"):
        caster({**batch, "t": far})
    with pytest.raises(ValueError, match="arrays of 6 or 8"):
        caster({"rays": asked[:, :5]})
    with pytest.raises(ValueError, match="is not in a file"):
        pierce.ray.Caster(pierce.Scene(np.eye(3), [[0, 1, 2]]))
    with pytest.raises(ValueError, match="closest, any, count"):
        pierce.ray.Caster(scene, query="all")


def test_ray_data(scene, tmp_path):
    ray = pytest.importorskip("ray", reason="Ray is not installed")
    parquet = pytest.importorskip("pyarrow.parquet")
    import pyarrow
    asked = rays()
    names = ("ox", "oy", "oz", "dx", "dy", "dz")
    (tmp_path / "rays").mkdir()
    for part in range(3):
        some = slice(part * 2000, (part + 1) * 2000)
        parquet.write_table(pyarrow.table({"number": np.arange(6000)[some],
                                           **dict(zip(names, asked[some].T))}),
                            tmp_path / "rays" / f"{part}.parquet")
    ray.init(num_cpus=2, include_dashboard=False, log_to_driver=False, logging_level="ERROR")
    try:
        ray.data.DataContext.get_current().enable_progress_bars = False
        data = ray.data.read_parquet(str(tmp_path / "rays"))
        data.map_batches(pierce.ray.Caster(scene), batch_size=700).write_parquet(
            str(tmp_path / "hits"))
        actors = data.map_batches(pierce.ray.Caster, fn_constructor_args=(scene._file[0],),
                                  fn_constructor_kwargs={"query": "any"}, concurrency=1)
        seen = actors.to_pandas().sort_values("number")
    finally:
        ray.shutdown()
    found = parquet.read_table(tmp_path / "hits").sort_by("number")
    hits = scene.closest_hit(asked)
    for name in COLUMNS:
        assert np.array_equal(found[name].to_numpy(), getattr(hits, name)), name
    assert np.array_equal(seen["hit"].to_numpy(), hits.hit)
