# SPDX-License-Identifier: Apache-2.0
"""pierce view: the page is taken apart, and holds exactly the numbers of the files."""

import base64
import json
import re
import unittest

import numpy as np

from harness import NONE, TETRA_TRIANGLES, TETRA_VERTICES, ToolTest

RAYS = np.float32([[0.2, 0.2, 9, 0, 0, -2], [0.25, 0.25, -1, 0, 0, 1], [5, 5, 5, 1, 0, 0]])


def numbers_of(page):
    """The facts of a page, and the arrays that they name."""
    facts = json.loads(re.search(r'<script id="facts"[^>]*>(.*?)</script>', page, re.S)[1])
    block = base64.b64decode(re.search(r'<script id="bytes"[^>]*>(.*?)</script>', page, re.S)[1],
                             validate=True)
    real = np.dtype(f"<f{facts['bits'] // 8}")

    def array(place, dtype, columns):
        return np.frombuffer(block, dtype, place[1], place[0]).reshape(-1, columns)

    meshes = [(array(m["vertices"], real, 3), array(m["triangles"], "<u4", 3))
              for m in facts["meshes"]]
    rows = {"rays": array(facts["rays"], real, 8), "hits": array(facts["hits"], real, 4),
            "names": array(facts["names"], "<u4", 3)}
    return facts, meshes, rows


class ViewTest(ToolTest):
    def view(self, *words):
        done = self.succeed("view", *words, "--out", "v.html")
        return done, (self.dir / "v.html").read_text()

    def test_the_numbers_are_those_of_the_files(self):
        np.save(self.dir / "r.npy", RAYS)
        tetra = self.tetra()
        done, page = self.view(tetra, "--rays", "r.npy")
        for text in ("triangles  4\n", "rays       3\n", "hits       2\n", "wrote      v.html, "):
            self.assertIn(text, done.stderr)
        facts, [(vertices, triangles)], rows = numbers_of(page)
        self.assertEqual(facts["bits"], 32)
        self.assertEqual(vertices.tolist(), np.float32(TETRA_VERTICES).tolist())
        self.assertEqual(triangles.tolist(), [list(t) for t in TETRA_TRIANGLES])
        self.assertEqual(rows["rays"].tolist(), [[*ray, 0, np.inf] for ray in RAYS.tolist()])
        self.succeed("cast", tetra, "--rays", "r.npy", "--out", "h.npy")
        hits = np.load(self.dir / "h.npy")
        for k, name in enumerate("tuvw"):
            self.assertEqual(rows["hits"][:, k].tobytes(), hits[name].tobytes())
        self.assertEqual(rows["names"].tolist(),
                         [[i, h["geometry"], h["triangle"]] for i, h in enumerate(hits)])
        self.assertIsNone(re.search(r"https?://", page), "the page names a place in the network")

    def test_hits_of_a_file_all_of_them_in_several_meshes(self):
        np.save(self.dir / "r.npy", RAYS)
        far = [(x + 0.125, y, z - 3) for x, y, z in TETRA_VERTICES]
        other = self.write_ply("b<c.ply", far, TETRA_TRIANGLES)
        tetra = self.tetra()
        self.succeed("cast", tetra, other, "--rays", "r.npy", "--query", "all", "--out",
                     "h.csv")
        _, page = self.view(tetra, other, "--rays", "r.npy", "--hits", "h.csv")
        facts, meshes, rows = numbers_of(page)
        self.assertEqual([m["name"] for m in facts["meshes"]], [tetra, "b<c.ply"])
        self.assertNotIn("b<c", page)
        self.assertEqual(len(meshes), 2)
        self.assertEqual(rows["names"][:, 0].tolist(), [0, 0, 0, 0, 1, 1])
        self.assertEqual(sorted(set(rows["names"][:, 1].tolist())), [0, 1])

    def test_without_rays_and_hits(self):
        facts, _, rows = numbers_of(self.view(self.tetra(), "--precision", "double")[1])
        self.assertEqual(facts["bits"], 64)
        self.assertEqual([len(r) for r in rows.values()], [0, 0, 0])

    def test_what_is_wrong_is_said(self):
        tetra = self.tetra()
        np.save(self.dir / "r.npy", RAYS)
        (self.dir / "h.csv").write_text("t,u,v,w,geometry,triangle\n1,0,0,1,0,4\n")
        (self.dir / "half.csv").write_text("t,u,v,w,geometry,triangle\n1,0,0,1,0,1.5\n")
        for words, status, text in (
                ((tetra, "--hits", "h.csv", "--out", "v.html"), 1,
                 "h.csv: hit 0 is on triangle 4 of geometry 0, which is not there"),
                ((tetra, "--hits", "half.csv", "--out", "v.html"), 1, "half.csv, row 0: 1.5 is no"),
                ((tetra, "--rays", "h.csv", "--out", "v.html"), 1, "h.csv:1: the titles"),
                ((tetra, "--out", "v.png"), 2, "must end in .html"),
                ((tetra, "--rays", "r.npy", "--out", "r.npy"), 2, "must end in .html")):
            done = self.run_tool("view", *words)
            self.assertEqual(done.returncode, status, done.stderr)
            self.assertIn(text, done.stderr)
            self.assertEqual(done.stderr.count("\n"), 1)
            self.assertFalse((self.dir / "v.html").exists())

    def test_a_miss_is_no_hit(self):
        np.save(self.dir / "r.npy", RAYS[2:])
        done, page = self.view(self.tetra(), "--rays", "r.npy")
        self.assertIn("hits       0\n", done.stderr)
        self.assertEqual(numbers_of(page)[2]["names"].tolist(), [[0, NONE, NONE]])


if __name__ == "__main__":
    unittest.main()
