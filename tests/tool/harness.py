# SPDX-License-Identifier: Apache-2.0
"""What the tests of the command share: running it, small meshes, and the definition of a hit."""

import os
import shutil
import signal
import subprocess
import tempfile
import time
import unittest
from fractions import Fraction
from pathlib import Path

import numpy as np
from numpy.lib import recfunctions

TOOL = os.environ["PIERCE_TOOL"]
NONE = 4294967295
# Until a test gives up on a program: it must end on a machine that does ten other things, too.
PATIENCE = 600

# Shells start background jobs with SIGINT ignored, nohup those with SIGHUP ignored; a program keeps
# to that. Not here.
for _signal in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP):
    if signal.getsignal(_signal) == signal.SIG_IGN:
        signal.signal(_signal, signal.SIG_DFL)



def closest_fields(number):
    return [("t", number), ("u", number), ("v", number), ("w", number), ("geometry", "<u4"),
            ("triangle", "<u4"), ("facing", "|u1")]


# Records lie in the file as the structs of the library lie in memory.
CLOSEST_F4 = np.dtype(closest_fields("<f4"), align=True)
CLOSEST_F8 = np.dtype(closest_fields("<f8"), align=True)
ALL_F4 = np.dtype([("ray", "<u8")] + closest_fields("<f4"), align=True)


def field_bytes(records):
    """Without the gaps between fields, of which NumPy's copies hold anything."""
    return recfunctions.repack_fields(records).tobytes()


# A tetrahedron: closed, four triangles.
TETRA_VERTICES = [(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1)]
TETRA_TRIANGLES = [(0, 2, 1), (0, 1, 3), (1, 2, 3), (2, 0, 3)]


class ToolTest(unittest.TestCase):
    """Each test has an empty folder, in which the tool runs."""

    def setUp(self):
        self.dir = Path(tempfile.mkdtemp(prefix="pierce-test-"))
        self.addCleanup(shutil.rmtree, self.dir, ignore_errors=True)

    def run_tool(self, *args, **options):
        return subprocess.run([TOOL, *map(str, args)], cwd=self.dir, capture_output=True,
                              text=True, timeout=PATIENCE, **options)

    def succeed(self, *args, **options):
        done = self.run_tool(*args, **options)
        self.assertEqual(done.returncode, 0, f"{args}: {done.stderr}")
        return done

    def fail_with(self, status, *args, **options):
        """The one line on stderr, without its `pierce: `."""
        done = self.run_tool(*args, **options)
        self.assertEqual(done.returncode, status, f"{args}: {done.stderr}")
        self.assertEqual(done.stdout, "")
        self.assertTrue(done.stderr.startswith("pierce: "), done.stderr)
        self.assertEqual(done.stderr.count("\n"), 1, done.stderr)
        return done.stderr[len("pierce: "):].rstrip("\n")

    def start(self, *args, **options):
        """A program that is killed at the end of the test, if it is still there."""
        options.setdefault("stdin", subprocess.DEVNULL)
        process = subprocess.Popen([TOOL, *map(str, args)], cwd=self.dir, **options)
        self.addCleanup(process.wait)
        self.addCleanup(process.kill)
        return process

    def wait_for_output(self, before):
        """Until the output is begun, under another name, in a folder that held `before`."""
        deadline = time.monotonic() + PATIENCE
        while self.files() == before and time.monotonic() < deadline:
            time.sleep(0.01)
        self.assertNotEqual(self.files(), before)

    def interrupt(self, process, sent=signal.SIGINT):
        """Sends the signal; what the program then says on stderr, and its processor seconds."""
        process.send_signal(sent)
        message = process.stderr.read()
        _, status, usage = os.wait4(process.pid, 0)
        process.returncode = os.waitstatus_to_exitcode(status)
        return message, usage.ru_utime + usage.ru_stime

    def expect_ctrl_c_leaves_no_file(self, *args):
        """Ctrl-C while the tool works on what takes too long to wait for."""
        before = self.files()
        tool = self.start(*args, stderr=subprocess.PIPE, text=True)
        self.wait_for_output(before)
        message, _ = self.interrupt(tool)
        self.assertEqual(tool.returncode, 130)
        self.assertEqual(message, "pierce: stopped\n")
        self.assertEqual(self.files(), before)

    def files(self):
        return sorted(p.name for p in self.dir.iterdir())

    def write(self, name, content):
        path = self.dir / name
        path.write_bytes(content if isinstance(content, bytes) else content.encode())
        return name

    def write_ply(self, name, vertices, triangles, number="float", extra=None):
        """Binary little-endian PLY; `extra` is {property: (type, values)} of the vertices."""
        dtype = [(axis, {"float": "<f4", "double": "<f8"}[number]) for axis in "xyz"]
        header = ["ply", "format binary_little_endian 1.0", f"element vertex {len(vertices)}"]
        header += [f"property {number} {axis}" for axis in "xyz"]
        for key, (kind, _) in (extra or {}).items():
            dtype.append((key, {"uchar": "|u1", "float": "<f4"}[kind]))
            header.append(f"property {kind} {key}")
        header += [f"element face {len(triangles)}", "property list uchar int vertex_indices",
                   "end_header", ""]
        table = np.zeros(len(vertices), dtype)
        for i, axis in enumerate("xyz"):
            table[axis] = np.asarray(vertices, "<f8").reshape(-1, 3)[:, i]
        for key, (_, values) in (extra or {}).items():
            table[key] = values
        faces = np.zeros(len(triangles), [("n", "|u1"), ("i", "<i4", 3)])
        faces["n"] = 3
        faces["i"] = np.asarray(triangles, "<i4").reshape(-1, 3)
        return self.write(name, "\n".join(header).encode() + table.tobytes() + faces.tobytes())

    def write_obj(self, name, vertices, triangles):
        text = "".join(f"v {x!r} {y!r} {z!r}\n" for x, y, z in vertices)
        text += "".join(f"f {a + 1} {b + 1} {c + 1}\n" for a, b, c in triangles)
        return self.write(name, text)

    def points(self, points, dtype="<f4", name="p.npy"):
        np.save(self.dir / name, np.asarray(points, dtype).reshape(-1, 3))
        return name

    def endless_points(self):
        """A file of holes: more points than any machine answers before a signal comes."""
        np.lib.format.open_memmap(self.dir / "p.npy", "w+", np.float32, (500_000_000, 3))
        return "p.npy"

    def write_rays(self, name, rays, dtype="<f4"):
        np.save(self.dir / name, np.asarray(rays, dtype))
        return name

    def load(self, name):
        return np.load(self.dir / name)

    def tetra(self, number="float"):
        return self.write_ply(f"tetra-{number}.ply", TETRA_VERTICES, TETRA_TRIANGLES, number)


def rounded(value, dtype):
    """The number of the type nearest to a fraction, ties to even."""
    if dtype.itemsize == 8:
        return dtype.type(float(value))  # Python divides integers correctly rounded
    guess = dtype.type(float(value))
    candidates = [guess, np.nextafter(guess, dtype.type(np.inf)),
                  np.nextafter(guess, dtype.type(-np.inf))]
    error = [abs(Fraction(float(c)) - value) for c in candidates]
    best = [c for c, e in zip(candidates, error) if e == min(error)]
    if len(best) > 1:
        best = [c for c in best if int(c.view("<u4")) % 2 == 0]
    return best[0] + dtype.type(0)


def exact_hits(vertices, triangles, ray):
    """Every hit as (t, triangle, u, v, w, facing), in order: the definition, over fractions."""
    o, d = [Fraction(float(x)) for x in ray[:3]], [Fraction(float(x)) for x in ray[3:6]]
    t_min, t_max = (float(ray[6]), float(ray[7])) if len(ray) == 8 else (0.0, float("inf"))

    def sub(p, q):
        return [x - y for x, y in zip(p, q)]

    def cross(p, q):
        return [p[1] * q[2] - p[2] * q[1], p[2] * q[0] - p[0] * q[2], p[0] * q[1] - p[1] * q[0]]

    def dot(p, q):
        return sum(x * y for x, y in zip(p, q))

    hits = []
    for index, corners in enumerate(triangles):
        a, b, c = ([Fraction(float(x)) for x in vertices[v]] for v in corners)
        normal = cross(sub(b, a), sub(c, a))
        den = dot(normal, d)
        if den == 0:
            continue
        t = dot(normal, sub(a, o)) / den
        p = [x + t * y for x, y in zip(o, d)]
        n2 = dot(normal, normal)
        u = dot(cross(sub(a, c), sub(p, c)), normal) / n2
        v = dot(cross(sub(b, a), sub(p, a)), normal) / n2
        w = 1 - u - v
        if min(u, v, w) < 0 or t < t_min or t > t_max:
            continue
        hits.append((t, index, u, v, w, 0 if den < 0 else 1))
    return sorted(hits)


def record(hit, dtype):
    """A hit (or None) as the tool must write it."""
    number = dtype["t"]
    if hit is None:
        return np.array((np.inf, 0, 0, 0, NONE, NONE, 0), dtype)
    t, index, u, v, w, facing = hit
    return np.array((*(rounded(x, number) for x in (t, u, v, w)), 0, index, facing), dtype)


def expected_closest(vertices, triangles, rays, dtype):
    lists = [exact_hits(vertices, triangles, ray) for ray in rays]
    return np.array([record(hits[0] if hits else None, dtype) for hits in lists], dtype)
