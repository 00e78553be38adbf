# SPDX-License-Identifier: Apache-2.0
"""pierce bench --unkind, on tiny scenes: a row a scene, and the same figures as JSON."""

import json
import os
import re
import subprocess
import tempfile
import unittest
from pathlib import Path

TOOL = os.environ["PIERCE_TOOL"]


def bench(*args):
    return subprocess.run([TOOL, "bench", *args], capture_output=True, text=True, timeout=600)


def listed():
    """The names that --list tells."""
    text = bench("--list").stdout.split("unkind scenes", 1)[1]
    return [line.split()[0] for line in text.splitlines()[1:] if line.strip()]


class Unkind(unittest.TestCase):
    def test_every_scene_has_its_row_and_its_figures(self):
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / "unkind.json"
            done = bench("--unkind", "--detail", "2", "--rounds", "2", "--json", str(path))
            self.assertEqual(done.returncode, 0, done.stderr)
            report = json.loads(path.read_text(encoding="utf-8"))
        names = listed()
        self.assertGreaterEqual(len(names), 20)
        self.assertEqual(len(names), len(set(names)))
        rows = re.findall(r"^(\S+) .*\|.*\|.*\|", done.stdout, re.M)
        self.assertEqual(rows, ["scene", *names])
        self.assertEqual([scene["scene"] for scene in report["scenes"]], names)
        self.assertEqual(report["detail"], 2)
        for scene in report["scenes"]:
            with self.subTest(scene=scene["scene"]):
                self.check_scene(scene)

    def check_scene(self, scene):
        median = {}
        for twin in ("unkind", "kind"):
            self.assertGreater(scene[twin]["triangles"], 0)
            self.assertGreater(scene[twin]["questions"], 0)
            for way in scene[twin]["ways"]:
                self.assertEqual(len(way["rounds"]), 2)
                self.assertTrue(all(ns > 0 for ns in way["rounds"]))
                self.assertLessEqual(way["different"], way["questions"])
                if way["way"] in ("one", "batch"):
                    self.assertEqual(way["different"], 0)
                median[twin, way["way"]] = way["ns"]
        batch = median["unkind", "batch"] / median["kind", "batch"]
        self.assertAlmostEqual(scene["ratios"]["batch_kind"] / batch, 1, 3)

    def test_only_the_named_scenes(self):
        done = bench("--unkind", "--detail", "2", "--rounds", "1", "--scenes", "tiny,sky-box")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertEqual(re.findall(r"^(\S+) .*\|.*\|.*\|", done.stdout, re.M),
                         ["scene", "sky-box", "tiny"])
        self.assertRegex(done.stdout, r"more than 2 times the better peer +\d of 2")

    def test_what_makes_no_sense_is_refused(self):
        for args, text in [(["--unkind", "--scenes", "nosuch"], "there is no 'nosuch'"),
                           (["--unkind", "--suite"], "--unkind brings its own scenes"),
                           (["--suite", "--scenes", "tiny"], "--scenes goes with --unkind")]:
            with self.subTest(args=args):
                done = bench(*args)
                self.assertEqual(done.returncode, 2)
                self.assertIn(text, done.stderr)


if __name__ == "__main__":
    unittest.main()
