#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Scene files in the place of meshes: the same answers, and one line for whatever is wrong."""

import json
import unittest

from harness import ToolTest, TETRA_TRIANGLES, TETRA_VERTICES


def ply(number):
    head = (f"ply\nformat ascii 1.0\nelement vertex {len(TETRA_VERTICES)}\n"
            + "".join(f"property {number} {axis}\n" for axis in "xyz")
            + f"element face {len(TETRA_TRIANGLES)}\nproperty list uchar int vertex_indices\n"
            "end_header\n")
    rows = [" ".join(map(str, v)) for v in TETRA_VERTICES]
    rows += ["3 " + " ".join(map(str, t)) for t in TETRA_TRIANGLES]
    return head + "\n".join(rows) + "\n"


class SceneFiles(ToolTest):
    def setUp(self):
        super().setUp()
        (self.dir / "a.ply").write_text(ply("float"))
        (self.dir / "b.ply").write_text(ply("double"))
        (self.dir / "rays.csv").write_text("0.1,0.1,5,0,0,-1\n0.1,0.1,-5,0.01,0,1\n3,3,3,1,1,1\n")

    def test_answers_are_those_of_the_meshes(self):
        for meshes, precision in ((["a.ply"], "float"), (["b.ply"], "double"),
                                  (["a.ply", "b.ply"], "double"), (["a.ply", "a.ply"], "float")):
            for quality in ("fast", "compact"):
                done = self.succeed("build", *meshes, "--quality", quality, "--out", "s.pierce",
                                    "--json")
                self.assertEqual(json.loads(done.stdout)["precision"], precision)
                for query in ("closest", "any", "all", "count", "crossings"):
                    for scene, out in ((meshes, "x.csv"), (["s.pierce"], "y.csv")):
                        self.succeed("cast", *scene, "--rays", "rays.csv", "--query", query,
                                     "--precision", precision, "--out", out)
                    self.assertEqual((self.dir / "x.csv").read_bytes(),
                                     (self.dir / "y.csv").read_bytes())

    def test_every_command_takes_them(self):
        self.succeed("build", "a.ply", "--out", "s.pierce", "--quiet")
        inside = self.succeed("locate", "s.pierce", "--point", "0.1,0.1,0.1").stdout
        self.assertEqual(inside, "inside\n")
        near = [self.succeed("nearest", mesh, "--point", "2,0,0").stdout
                for mesh in ("a.ply", "s.pierce")]
        self.assertEqual(near[0], near[1])
        info = json.loads(self.succeed("info", "s.pierce", "--verify", "--json").stdout)
        self.assertEqual((info["triangles"], info["coordinate_bits"]), (4, 32))
        self.succeed("check", "s.pierce", "--rays", "100")
        self.succeed("voxelise", "s.pierce", "--size", "4x4x4", "--out", "v.npy", "--quiet")
        for mesh in ("a.ply", "s.pierce"):
            self.succeed("rays", mesh, "--size", "8x8", "--out", mesh + ".npy", "--quiet")
            self.succeed("render", mesh, "--size", "8x8", "--out", mesh + ".png", "--quiet")
        for kind in (".npy", ".png"):
            self.assertEqual((self.dir / ("a.ply" + kind)).read_bytes(),
                             (self.dir / ("s.pierce" + kind)).read_bytes())
        # In the other type, and beside other meshes, the scene is built anew.
        wide = self.succeed("cast", "s.pierce", "a.ply", "--precision", "double", "--ray",
                            "0.1,0.1,5,0,0,-1").stdout
        self.assertEqual(wide, self.succeed("cast", "a.ply", "a.ply", "--precision", "double",
                                            "--ray", "0.1,0.1,5,0,0,-1").stdout)

    def test_what_is_wrong_is_said_in_one_line(self):
        self.succeed("build", "a.ply", "--out", "s.pierce", "--quiet")
        whole = (self.dir / "s.pierce").read_bytes()

        def refusal(data, *command):
            (self.dir / "bad.pierce").write_bytes(data)
            return self.fail_with(1, *(command or ("cast", "bad.pierce", "--ray", "0,0,5,0,0,-1")))

        self.assertIn("is cut short", refusal(whole[:5000]))
        self.assertIn("version 9", refusal(whole[:8] + b"\x09" + whole[9:]))
        self.assertIn("header", refusal(whole[:70] + b"!" + whole[71:]))
        # A byte of a vertex: unseen until every byte is looked at.
        at = whole.index(b"\0\0\x80\x3f", 8192)
        flipped = whole[:at] + b"\1" + whole[at + 1:]
        self.assertIn("checksum", refusal(flipped, "info", "bad.pierce", "--verify"))
        self.assertIn("must end in .pierce",
                      self.fail_with(2, "build", "a.ply", "--out", "s.ply"))
        self.assertIn("is an input file",
                      self.fail_with(2, "build", "s.pierce", "--out", "s.pierce"))


if __name__ == "__main__":
    unittest.main()
