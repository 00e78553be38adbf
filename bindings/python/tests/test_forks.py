# SPDX-License-Identifier: Apache-2.0
"""Children that were forked in the middle of something."""

import os

import pytest
from interpreter import run_python

pytestmark = pytest.mark.skipif(os.name == "nt", reason="forks of POSIX")


def test_forked_children_of_a_busy_parent():
    """A fork while another thread is in the middle of a batch."""
    out, _ = run_python("""
        import os, threading
        import numpy as np, pierce
        from meshes import grid
        scene = pierce.Scene(*grid(100))
        rays = np.zeros((200000, 6))
        rays[:, :2] = np.random.default_rng(1).random((200000, 2)) * 99
        rays[:, 2:] = [5, 0, 0, -1]
        expected = scene.closest_hit(rays).t
        stop = threading.Event()
        def ask():
            while not stop.is_set(): scene.closest_hit(rays)
        asker = threading.Thread(target=ask); asker.start()
        for i in range(10):
            child = os.fork()
            if child == 0:
                good = np.array_equal(scene.closest_hit(rays).t, expected)
                os._exit(0 if good else 1)
            print(os.waitpid(child, 0)[1], end=" ")
        stop.set(); asker.join()
    """)
    assert out == "0 " * 10


def test_forked_children_end():
    """The thread that works for calls is not in the child, and nothing waits for it there."""
    out, _ = run_python("""
        import os, sys, threading
        import numpy as np, pierce
        from meshes import grid
        scene = pierce.Scene(*grid(100))
        rays = np.tile([5.25, 5.5, 9, 0, 0, -1], (5000, 1))
        expected = scene.closest_hit(rays).t
        for calls in (0, 1, 2):
            child = os.fork()
            if child == 0:
                for _ in range(calls): assert np.array_equal(scene.closest_hit(rays).t, expected)
                sys.exit(calls)
            print(os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]), end=" ")
        threads = [threading.Thread(target=scene.closest_hit, args=(rays,)) for _ in range(9)]
        for thread in threads: thread.start()
        for thread in threads: thread.join()
        print(np.array_equal(scene.closest_hit(rays).t, expected))
    """)
    assert out == "0 1 2 True\n"


def test_forked_children_change_scenes():
    """Threads of the parent that are in the middle of something hold nothing in the child."""
    out, _ = run_python("""
        import os, threading
        import numpy as np, pierce
        from meshes import grid
        asked, changed = pierce.Scene(*grid(10)), pierce.Scene(*grid(60))
        rays = np.ones((100000, 6))
        busy, done = threading.Semaphore(0), threading.Event()
        def hold(_):
            busy.release(); done.wait()
        calls = [lambda: asked.count_hits(rays, progress=hold),
                 lambda: changed.update(progress=hold)]
        threads = [threading.Thread(target=call) for call in calls]
        for thread in threads: thread.start()
        for _ in threads: busy.acquire()
        child = os.fork()
        if child == 0:
            asked.update(grid(10)[0] + 1)
            print(asked.closest_hit([2.25, 2.5, 9, 0, 0, -1]).hit)
            for call in (lambda: changed.any_hit(rays), changed.update):
                try: call()
                except RuntimeError as error: print(error)
            print(pierce.Scene(*grid(3)).info()["triangles"], flush=True)
            os._exit(0)
        print(os.waitpid(child, 0)[1])
        done.set()
        for thread in threads: thread.join()
    """)
    forked = ("this process was forked while another thread was in update(); make the scene anew\n")
    assert out == f"True\n{forked}{forked}18\n0\n"


def test_children_forked_by_progress():
    """Nothing waits in them for threads that are not there; the parent's call goes on."""
    out, _ = run_python("""
        import os, sys
        import numpy as np, pierce
        from meshes import grid
        rays = np.random.default_rng(1).random((200000, 6)) * 50
        rays[:, 2:] = [5, 0, 0, -1]
        expected = pierce.Scene(*grid(50)).closest_hit(rays).t
        scene = pierce.Scene(*grid(50))
        ended = []
        def fork(leave):
            def progress(fraction):
                if ended: return
                child = os.fork()
                if child == 0:
                    if leave: sys.exit(3)
                    return
                ended.append(os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]))
            return progress
        for leave in (True, False):
            here = os.getpid()
            try:
                hits = scene.closest_hit(rays, progress=fork(leave))
            except RuntimeError as error:
                assert os.getpid() != here and "forked by progress" in str(error)
                same = np.array_equal(scene.closest_hit(rays).t, expected)
                moved = grid(50)[0] + [0, 0, 1]
                scene.update(moved)
                anew = pierce.Scene(moved, grid(50)[1])
                same &= np.array_equal(scene.closest_hit(rays).t, anew.closest_hit(rays).t)
                os._exit(4 if same else 5)
            assert np.array_equal(hits.t, expected)
            print(ended.pop())
        def fork_again(fraction):
            if not ended: fork(False)(fraction)
        here = os.getpid()
        try:
            scene.update(progress=fork_again)
        except RuntimeError:
            assert os.getpid() != here
            try: scene.any_hit(rays)
            except RuntimeError as error: os._exit(6 if "make the scene anew" in str(error) else 7)
        print(ended.pop())
    """)
    assert out == "3\n4\n6\n"
