# SPDX-License-Identifier: Apache-2.0
"""Threads share a scene, Ctrl-C ends any call, forked children go on."""

import multiprocessing
import os
import signal
import subprocess
import sys
import threading
import time
from concurrent.futures import ProcessPoolExecutor, ThreadPoolExecutor

import numpy as np
import pytest
from interpreter import run_python
from meshes import grid, sheets

import pierce

posix = pytest.mark.skipif(os.name == "nt", reason="signals and forks of POSIX")


def rays_over(n, count, seed=1):
    rng = np.random.default_rng(seed)
    rays = np.zeros((count, 6))
    rays[:, :2] = rng.random((count, 2)) * n
    rays[:, 2:] = [5, 0.1, 0.2, -1]
    return rays


def test_threads_share_a_scene():
    scene = pierce.Scene(*grid(40))
    batches = [rays_over(40, 3000, seed) for seed in range(8)]
    expected = [scene.closest_hit(rays, threads=1) for rays in batches]
    with ThreadPoolExecutor(8) as pool:
        for got, want in zip(pool.map(scene.closest_hit, batches), expected):
            assert np.array_equal(got.t, want.t) and np.array_equal(got.triangle, want.triangle)


def test_answers_do_not_depend_on_threads_or_batches():
    scene = pierce.Scene(*grid(30))
    rays = rays_over(30, 7000)
    whole = scene.all_hits(rays)
    for threads in (1, 2, 4):
        part = scene.all_hits(rays[1000:], threads=threads)
        first = whole.offsets[1000]
        assert np.array_equal(part.offsets, whole.offsets[1000:] - first)
        for name in ("t", "u", "v", "w", "triangle"):
            assert np.array_equal(getattr(part, name), getattr(whole, name)[first:])


def test_updates_wait_for_queries():
    """Every answer is of one state of the scene or the other, never of both."""
    vertices, triangles = grid(30)
    scene = pierce.Scene(vertices, triangles)
    rays = rays_over(20, 3000)
    low, high = pierce.Scene(vertices, triangles), pierce.Scene(vertices + [0, 0, 1], triangles)
    known = [low.closest_hit(rays).t.tobytes(), high.closest_hit(rays).t.tobytes()]
    done = threading.Event()
    failed = []

    def ask():
        while not done.is_set():
            if scene.closest_hit(rays, threads=1).t.tobytes() not in known:
                failed.append(1)

    askers = [threading.Thread(target=ask) for _ in range(2)]
    for asker in askers:
        asker.start()
    for i in range(20):
        scene.update(vertices + [0, 0, i % 2])
    done.set()
    for asker in askers:
        asker.join()
    assert not failed


def test_other_threads_run_meanwhile():
    """The GIL is free while a batch is worked at."""
    scene = pierce.Scene(*sheets(300))
    rays = np.full((30000, 6), [0.5, 0.5, 400, 0, 0, -1])
    counted = 0
    stop = threading.Event()

    def count():
        nonlocal counted
        while not stop.is_set():
            counted += 1
            time.sleep(0.001)

    thread = threading.Thread(target=count)
    started = time.perf_counter()
    thread.start()
    scene.count_hits(rays, threads=1)
    took = time.perf_counter() - started
    stop.set()
    thread.join()
    assert took > 0.05 and counted > took / 0.05


def test_callbacks_that_ask_and_change():
    scene = pierce.Scene(*grid(60))
    rays = rays_over(60, 50000)
    asked = []
    scene.closest_hit(rays, progress=lambda x: asked.append(scene.any_hit(rays[0])))
    assert asked and all(asked)
    with pytest.raises(RuntimeError, match="update.. was called by a callback"):
        scene.closest_hit(rays, progress=lambda x: scene.update())
    with pytest.raises(RuntimeError, match="is being updated; ask it afterwards"):
        scene.update(progress=lambda x: scene.any_hit(rays[0]))
    with pytest.raises(RuntimeError, match="call it afterwards"):
        scene.update(progress=lambda x: scene.update())
    with pytest.raises(ZeroDivisionError):
        scene.update(progress=lambda x: 1 / 0)
    scene.update()
    assert scene.any_hit(rays[0])


INTERRUPTED = """
    import os, signal, sys, threading, time
    import numpy as np, pierce
    from meshes import grid, sheets

    signal.signal(signal.SIGINT, signal.default_int_handler)  # who runs the tests may ignore it
    what = sys.argv[1]
    down = np.array([0.5, 0.5, 1e7, 0, 0, -1])
    if what == "build":
        mesh = grid(1500)
        call = lambda: pierce.Scene(*mesh)
    elif what == "weld":
        corners = np.random.default_rng(1).random((1500000, 3, 3))
        index = np.arange(4500000, dtype=np.uint32).reshape(-1, 3)
        call = lambda: pierce.weld(corners.reshape(-1, 3), index, distance=1e-4)
    elif what == "few rays":
        scene = pierce.Scene(*sheets(200000))
        call = lambda: scene.count_hits(np.tile(down, (2000, 1)))
    else:
        scene = pierce.Scene(*sheets(2000))
        points = np.random.default_rng(1).random((2000000, 3)) * [1, 1, 2000]
        many = np.broadcast_to(down, (40000000, 6))
        some = np.tile(down, (20000, 1))
        if what in ("locate", "signed_distance"):
            call = lambda: getattr(scene, what)(points, open_mesh=True)
        elif what == "nearest":
            call = lambda: scene.nearest(points)
        elif what == "voxelise":
            call = lambda: scene.voxelise([0, 0, 0], [5e-4, 5e-4, 200], (2000, 2000, 8),
                                          open_mesh=True)
        elif what == "filter":
            call = lambda: scene.closest_hit(some, filter=lambda ray, hits: hits.t < 0)
        elif what == "next_origin":
            hits = scene.closest_hit(np.tile(some, (50, 1)))
            call = lambda: scene.next_origin(hits)
        elif what == "closest_hit":
            call = lambda: scene.closest_hit(many, columns=["triangle"], threads=1)
        elif what == "any_hit":
            call = lambda: scene.any_hit(many, threads=1)
        else:
            call = lambda: getattr(scene, what)(some)

    sent = []
    def interrupt():
        time.sleep(0.3)
        sent.append(time.perf_counter())
        os.kill(os.getpid(), signal.SIGINT)
    threading.Thread(target=interrupt).start()
    try:
        call()
        print("finished")
    except KeyboardInterrupt:
        print(time.perf_counter() - sent[0])
"""


@posix
@pytest.mark.parametrize("what", ["build", "closest_hit", "any_hit", "all_hits", "count_hits",
                                  "crossings", "few rays", "locate", "signed_distance", "nearest",
                                  "voxelise", "filter", "next_origin", "weld"])
def test_ctrl_c_ends_any_call(what):
    out, _ = run_python(INTERRUPTED, what)
    assert out != "finished\n", "the call was too short to be interrupted"
    # 0.2 s on a machine that does nothing else
    assert float(out) < 0.2 * max(1.0, os.getloadavg()[0] / (os.cpu_count() or 1))


def in_child(seed):
    scene = pierce.Scene(*grid(30))
    return scene.closest_hit(rays_over(30, 5000, seed)).t


SHARED = pierce.Scene(*grid(30))


def with_scene(scene):
    return scene.closest_hit(rays_over(30, 5000, 3)).t, SHARED.closest_hit(rays_over(30, 5000, 3)).t


@posix
@pytest.mark.filterwarnings("ignore:.*fork.*:DeprecationWarning")
@pytest.mark.parametrize("method", ["fork", "forkserver", "spawn"])
def test_children(method):
    expected = in_child(3)  # threads have been at work before the fork
    context = multiprocessing.get_context(method)
    with ProcessPoolExecutor(2, mp_context=context) as pool:
        jobs = [pool.submit(in_child, 3) for _ in range(4)]
        jobs += [pool.submit(with_scene, SHARED) for _ in range(2)]
        for job in jobs:
            assert np.array_equal(job.result(timeout=100), expected) or all(
                np.array_equal(t, expected) for t in job.result())


def test_nothing_leaks():
    """nanobind counts what is still there at the end of the process, and says so."""
    _, err = run_python("""
        import numpy as np, pierce
        from meshes import CUBE, SQUARE
        for mesh in (SQUARE, CUBE):
            for dtype in (np.float32, np.float64):
                scene = pierce.Scene(mesh[0].astype(dtype), mesh[1])
                rays = np.ones((5000, 6), dtype)
                hits = scene.closest_hit(rays, filter=lambda ray, hits: hits.t > 9,
                                         progress=lambda x: None)
                hits.points, hits.normals, scene.next_origin(hits), scene.all_hits(rays)
                scene.step(hits), scene.crossings(rays), scene.nearest(rays[:, :3])
                scene.update(progress=lambda x: None)
                for wrong in (rays * np.nan, rays * 0):
                    try: scene.any_hit(wrong)
                    except pierce.InvalidRay: pass
                try: scene.closest_hit(rays, filter=lambda *_: 1 / 0)
                except ZeroDivisionError: pass
    """)
    assert err == ""


def test_memory_goes_back():
    """A thousand scenes and batches leave nothing behind."""
    out, _ = run_python("""
        import resource, numpy as np, pierce
        from meshes import grid
        mesh = grid(20)
        rays = np.ones((2000, 6))
        def work(times):
            for _ in range(times):
                scene = pierce.Scene(*mesh, threads=1)
                scene.all_hits(rays, threads=1); scene.closest_hit(rays, threads=1).points
            return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
        before = work(100)
        print(work(900) - before)
    """)
    assert int(out) < 8 * 1024  # KiB; of a round's arrays, 900 times a hundredth would be as much


@posix
def test_signal_handlers_run_meanwhile():
    ran = []
    old = signal.signal(signal.SIGALRM, lambda *_: ran.append(time.perf_counter()))
    try:
        scene = pierce.Scene(*sheets(300))
        rays = np.full((60000, 6), [0.5, 0.5, 400, 0, 0, -1])
        signal.setitimer(signal.ITIMER_REAL, 0.05)
        started = time.perf_counter()
        scene.count_hits(rays, threads=1)
        ended = time.perf_counter()
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0)
        signal.signal(signal.SIGALRM, old)
    assert ended - started > 0.2 and started < ran[0] < ended
