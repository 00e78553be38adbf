#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""What a chunk of a job costs on each engine beside its rays, with one worker and with two.

The chunks hold eight rays each, so that their time is the engine's. `seconds` is a job without
chunks: what it takes to start. `pierce job run` is the command by itself, the others are
pierce.job.run. What is not installed is left out.

usage: engines.py [--chunks N]
"""

import argparse
import pathlib
import shutil
import subprocess
import sys
import tempfile
import time
from concurrent.futures import ProcessPoolExecutor, ThreadPoolExecutor

import numpy as np

import pierce
import pierce.job

MPI = """
import sys, time
import pierce.job
from mpi4py.futures import MPIPoolExecutor

if __name__ == "__main__":
    with MPIPoolExecutor() as executor:
        executor.bootup()
        start = time.perf_counter()
        pierce.job.run(sys.argv[1], executor)
        print(time.perf_counter() - start)
"""


def command(folder, workers):
    """As many `pierce job run`, each with its part; or one under mpirun, see below."""
    runs = [subprocess.Popen([pierce.job.tool_path(), "job", "run", folder, "--threads", "1",
                              "--quiet", "--part", f"{i}/{workers}"]) for i in range(workers)]
    if any([run.wait() for run in runs]):
        sys.exit("pierce job run failed")


def mpirun(folder, workers):
    subprocess.run(["mpirun", "--allow-run-as-root", "--oversubscribe", "-n", str(workers),
                    pierce.job.tool_path(), "job", "run", folder, "--threads", "1", "--quiet"],
                   check=True)


def timed(work, *arguments):
    start = time.perf_counter()
    work(*arguments)
    return time.perf_counter() - start


def on_pool(pool):
    def run(folder, workers):
        with pool(workers) as executor:
            list(executor.map(abs, range(workers)))
            return timed(pierce.job.run, folder, executor)
    return run


def on_dask(folder, workers):
    from dask.distributed import Client, LocalCluster
    with LocalCluster(n_workers=workers, threads_per_worker=1, dashboard_address=None) as cluster, \
            Client(cluster) as client:
        return timed(pierce.job.run, folder, client.get_executor())


def on_mpi_pool(folder, workers):
    script = pathlib.Path(folder).parent / "run.py"
    script.write_text(MPI)
    done = subprocess.run(
        ["mpirun", "--allow-run-as-root", "--oversubscribe", "-n", str(workers + 1),
         sys.executable, "-m", "mpi4py.futures", script, folder], check=True, text=True,
        stdout=subprocess.PIPE)
    return float(done.stdout)


def installed(name):
    try:
        __import__(name)
    except ImportError:
        return False
    return True


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--chunks", type=int, default=400)
    options = parser.parse_args()
    mpi = shutil.which("mpirun") is not None
    engines = {"pierce job run": lambda *x: timed(command, *x),
               "mpirun pierce job run": mpi and (lambda *x: timed(mpirun, *x)),
               "threads": on_pool(ThreadPoolExecutor), "processes": on_pool(ProcessPoolExecutor),
               "Dask": installed("distributed") and on_dask,
               "MPIPoolExecutor": mpi and installed("mpi4py") and on_mpi_pool}
    with tempfile.TemporaryDirectory() as folder:
        scene = pathlib.Path(folder) / "one.pierce"
        pierce.Scene(np.eye(3, dtype=np.float32), [[0, 1, 2]]).save(scene)
        print(f"{'':24}{'1 worker':>10}{'2 workers':>12}   ms a chunk")
        for name, run in engines.items():
            if not run:
                continue
            costs = []
            for workers in (1, 2):
                for chunks in (2, options.chunks):
                    job = pathlib.Path(folder) / f"{name} {workers} {chunks}"
                    pierce.job.create(job, scene, "--sphere", str(8 * chunks), "--chunk", "8",
                                      "--query", "any")
                    costs.append(run(str(job), workers))
            per = [(costs[i + 1] - costs[i]) / (options.chunks - 2) * 1e3 for i in (0, 2)]
            print(f"{name:24}{per[0]:10.1f}{per[1]:12.1f}", flush=True)


if __name__ == "__main__":
    main()
