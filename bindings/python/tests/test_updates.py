# SPDX-License-Identifier: Apache-2.0
"""Updates happen as a whole or not at all, and no answer is of two states of a scene."""

import os
import threading
import time

import numpy as np
import pytest
from interpreter import run_python
from meshes import grid
from test_threads import rays_over

import pierce

posix = pytest.mark.skipif(os.name == "nt", reason="signals of POSIX")


def test_an_update_that_raises_changes_nothing():
    """Whatever ends it, and whenever: the new vertices are gone then, and nobody looks at them."""
    mesh = grid(60)
    for make in (lambda: pierce.Scene(*mesh), lambda: pierce.Scene(*grid(3)),
                 lambda: pierce.Scene([(mesh, np.eye(4))] * 2, flatten_limit=0)):
        scene = make()
        vertices = [v for v, _ in scene.geometries]
        rays = rays_over(3, 100)
        before, version = scene.closest_hit(rays), scene._core.version
        for last in (0, 0.5, 1):
            def raises(fraction, last=last):
                if fraction >= last:
                    raise ValueError("the bar is closed")

            with pytest.raises(ValueError, match="closed"):
                scene.update([v + [0, 0, 4] for v in vertices], progress=raises)
            junk = [np.full_like(v, 7.5) for v in vertices for _ in range(20)]
            assert all(a is b for (a, _), b in zip(scene.geometries, vertices))
            assert np.array_equal(scene.closest_hit(rays).t, before.t)
            assert scene._core.version == version and np.isfinite(before.points[before.hit]).all()
            del junk
        told = []
        scene.update([v + [0, 0, 4] for v in vertices], progress=told.append)
        assert told[-1] == 1 and scene._core.version > version
        assert np.array_equal(scene.closest_hit(rays + [0, 0, 4, 0, 0, 0]).triangle,
                              before.triangle)


@posix
def test_an_update_that_is_interrupted_happened_or_did_not():
    out, _ = run_python("""
        import os, signal, threading, time
        import numpy as np, pierce
        from meshes import grid
        signal.signal(signal.SIGINT, signal.default_int_handler)
        vertices, triangles = grid(250)
        scene = pierce.Scene(vertices, triangles, threads=1)
        began = time.perf_counter()
        scene.update(vertices, threads=1)
        took = time.perf_counter() - began
        ray = [0.5, 0.25, 9, 0.01, 0, -1]
        raised = 0
        for k in range(16):
            height = float(k % 2)
            def interrupt():
                time.sleep(took * (0.3 + k * 0.06))
                os.kill(os.getpid(), signal.SIGINT)
            other = threading.Thread(target=interrupt)
            try:
                other.start()
                scene.update(vertices + [0, 0, height], threads=1)
                other.join(); time.sleep(0.05)
            except KeyboardInterrupt:
                raised += 1
            other.join()
            there = scene.geometries[0][0][0, 2] - vertices[0, 2]
            fresh = pierce.Scene(vertices + [0, 0, there], triangles)
            assert scene.closest_hit(ray).t == fresh.closest_hit(ray).t, k
        print(raised)
    """)
    assert int(out) > 0


def test_points_and_steps_are_of_the_scene_that_was_hit():
    vertices, triangles = grid(30)
    scene = pierce.Scene(vertices, triangles)
    rays = rays_over(20, 3000)
    flat = [pierce.Scene(vertices + [0, 0, z], triangles) for z in (0, 1)]
    known = [h.closest_hit(rays) for h in flat]
    wanted = {h.t.tobytes(): (h.points.tobytes(), s.step(h).t.tobytes(),
                              s.next_origin(h).tobytes()) for h, s in zip(known, flat)}
    done = threading.Event()

    def change():
        for i in range(10**6):
            if done.is_set():
                break
            scene.update(vertices + [0, 0, (i + 1) % 2])

    changing = threading.Thread(target=change)
    changing.start()
    stale = 0
    try:
        for _ in range(150):
            hits = scene.closest_hit(rays)
            for number, ask in enumerate((lambda: hits.points, lambda: scene.step(hits).t,
                                          lambda: scene.next_origin(hits))):
                try:
                    assert ask().tobytes() == wanted[hits.t.tobytes()][number]
                except RuntimeError as error:
                    assert "the scene was updated since" in str(error)
                    stale += 1
    finally:
        done.set()
        changing.join()
    assert stale > 0


def test_filters_hold_the_scene():
    """All that a filter is asked about is of one scene: an update waits, or is refused."""
    vertices, triangles = grid(10)
    two = np.concatenate([triangles, triangles + len(vertices)])

    def at(height):
        return np.concatenate([vertices + [0, 0, height], vertices + [0, 0, height - 1]])

    scene = pierce.Scene(at(0), two)
    rays = np.tile([3.25, 3.5, 9, 0, 0, -1], (50, 1)).astype(float)
    first = scene.closest_hit(rays[0]).t
    began = threading.Event()

    def change():
        began.wait()
        scene.update(at(5))

    def second(ray, hits):
        began.set()
        time.sleep(0.05)  # the update waits by now
        assert np.array_equal(hits.points[:, 2], 9 - hits.t)
        return hits.t > first

    changing = threading.Thread(target=change)
    changing.start()
    hits = scene.closest_hit(rays, filter=second)
    changing.join()
    assert (hits.t == first + 1).all() and scene.closest_hit(rays[0]).t == first - 5
    with pytest.raises(RuntimeError, match="points: the scene was updated since"):
        hits.points
    for ask in (scene.closest_hit, scene.any_hit, scene.count_hits, scene.all_hits):
        for distinct in (False, True):
            def moves(ray, hits):
                scene.update(at(0))

            with pytest.raises(RuntimeError, match="update.. was called by a callback"):
                ask(rays, filter=moves, distinct=distinct)
    scene.update(at(0))  # nobody holds it any more
    assert scene.closest_hit(rays[0]).t == first
