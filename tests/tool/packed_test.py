# SPDX-License-Identifier: Apache-2.0
"""Meshes and tables that gzip or zstd packed: the same answers; bombs, damage and cuts named."""

import gzip
import struct
import unittest

import numpy as np

from harness import TETRA_TRIANGLES, TETRA_VERTICES, ToolTest

BLOCK = 128 << 10  # the most that one block of zstd holds


def zstd_frame(data):
    """A frame of blocks that are stored as they are."""
    blocks = [data[i:i + BLOCK] for i in range(0, len(data), BLOCK)] or [b""]
    out = struct.pack("<IBQ", 0xFD2FB528, 0xE0, len(data))
    for i, block in enumerate(blocks):
        out += struct.pack("<I", len(block) << 3 | (i + 1 == len(blocks)))[:3] + block
    return out


def zstd_zeros(blocks):
    """A frame of many zeros, four bytes for 128 KiB of them."""
    body = b"".join(struct.pack("<I", BLOCK << 3 | 2 | (i + 1 == blocks))[:3] + b"\0"
                    for i in range(blocks))
    return struct.pack("<IBQ", 0xFD2FB528, 0xE0, blocks * BLOCK) + body


PACKERS = {".gz": gzip.compress, ".zst": zstd_frame}


class Packed(ToolTest):
    def meshes(self):
        """The tetrahedron in each of our formats: name -> bytes."""
        corners = [TETRA_VERTICES[v] for t in TETRA_TRIANGLES for v in t]
        stl = bytes(80) + struct.pack("<I", 4)
        for i in range(0, 12, 3):
            stl += struct.pack("<12fH", 0, 0, 0, *np.ravel(corners[i:i + 3]), 0)
        off = "OFF\n4 4 0\n" + "".join("%d %d %d\n" % v for v in TETRA_VERTICES)
        off += "".join("3 %d %d %d\n" % t for t in TETRA_TRIANGLES)
        obj, ply = (self.write_obj("m.obj", TETRA_VERTICES, TETRA_TRIANGLES), self.tetra())
        return {"m.ply": (self.dir / ply).read_bytes(), "m.obj": (self.dir / obj).read_bytes(),
                "m.stl": stl, "m.off": off.encode()}

    def info(self, name):
        lines = self.succeed("info", name).stdout.splitlines()
        return {line[:20].strip(): line[20:].strip() for line in lines
                if not line.startswith(("file", "build"))}

    def test_meshes_are_those_that_were_packed(self):
        for name, content in self.meshes().items():
            plain = self.info(self.write(name, content))
            self.assertEqual((plain["triangles"], plain["closed by position"]), ("4", "yes"))
            for extension, pack in PACKERS.items():
                packed = pack(content)
                half = len(content) // 2
                pieces = pack(content[:half]) + pack(content[half:])
                forms = {name + extension: packed, name + extension.upper(): pieces,
                         name: packed}
                if not name.endswith("obj"):
                    forms["nameless"] = packed
                for other, packed in forms.items():
                    got = self.info(self.write(other, packed))
                    self.assertEqual(got.pop("format"), plain["format"] + ", "
                                     + {".gz": "gzip", ".zst": "zstd"}[extension])
                    self.assertEqual(got, {k: v for k, v in plain.items() if k != "format"})
        skippable = struct.pack("<II", 0x184D2A5E, 3) + b"abc"
        self.info(self.write("m.off.zst", skippable + zstd_frame(self.meshes()["m.off"])))
        self.info(self.write("m.off.gz", gzip.compress(self.meshes()["m.off"]) + bytes(512)))

    def test_tables_are_those_that_were_packed(self):
        self.points([(0.25, 0.25, 0.25), (2, 2, 2)])
        tables = {"p.npy": (self.dir / "p.npy").read_bytes(),
                  "p.csv": b"x,y,z\n0.25,0.25,0.25\n2,2,2\n"}
        for name, content in tables.items():
            for extension, pack in PACKERS.items():
                for points in (name + extension, "-", "nameless"):
                    self.write("nameless" if points == "-" else points, pack(content))
                    stdin = self.dir / "nameless" if points == "-" else "/dev/null"
                    with open(stdin, "rb") as file:
                        self.succeed("locate", self.tetra(), "--points", points, "--out", "l.csv",
                                     "--strict", stdin=file)
                    self.assertEqual((self.dir / "l.csv").read_text(), "location\n1\n-1\n")
                twice = self.write("t.csv", pack(pack(content)))
                line = self.fail_with(1, "locate", self.tetra(), "--points", twice, "--out",
                                      "l.csv")
                self.assertEqual(line, "t.csv: is packed more than once: unpack it")

    def test_what_is_cut_off_or_damaged_is_refused(self):
        content = self.meshes()["m.off"]
        for extension, pack in PACKERS.items():
            packed = pack(content)
            name = "m.off" + extension
            by = {".gz": "gzip", ".zst": "zstd"}[extension]
            for cut in (len(packed) - 1, len(packed) // 2, 12):
                line = self.fail_with(1, "info", self.write(name, packed[:cut]))
                self.assertEqual(line, f"{name}: is packed by {by} and was cut off: get it again")
            line = self.fail_with(1, "info", self.write(name, packed + b"more"))
            self.assertRegex(line, f"is packed by {by} and (followed by 4 bytes of something else|"
                                   "damaged or of an unusual kind)")
            line = self.fail_with(1, "info", self.write(name, pack(b"")))
            self.assertEqual(line, f"{name}: is packed by {by} and empty: write it again")
            line = self.fail_with(1, "info", self.write(name, pack(pack(content))))
            self.assertEqual(line, f"{name}: is packed more than once: unpack it")
        packed = bytearray(gzip.compress(content))
        packed[-6] ^= 1  # of the checksum
        line = self.fail_with(1, "info", self.write("m.off.gz", bytes(packed)))
        self.assertEqual(line, "m.off.gz: is packed by gzip and damaged (incorrect data check): "
                               "get it again")
        line = self.fail_with(1, "info", self.write("m.3ds.gz", gzip.compress(b"MM" + bytes(99))))
        self.assertEqual(line, "m.3ds.gz: is packed, which a file of this format may not be: "
                               "unpack it")
        tar = bytes(257) + b"ustar" + bytes(500)
        line = self.fail_with(1, "info", self.write("m.ply.gz", gzip.compress(tar)))
        self.assertEqual(line, "m.ply.gz: is a TAR archive: unpack it with tar")

    def test_a_bomb_is_refused_at_its_limit(self):
        # 200 times the packed size, but 64 MiB at least.
        for name, bomb in (("b.ply.gz", gzip.compress(bytes(80 << 20))),
                           ("b.csv.zst", zstd_zeros(1000)), ("b.stl.zst", zstd_zeros(1000))):
            self.assertLess(len(bomb), 100_000)
            self.write(name, bomb)
            command = (["info", name] if "csv" not in name else
                       ["locate", self.tetra(), "--points", name, "--out", "l.csv"])
            line = self.fail_with(1, *command)
            self.assertIn(f"bytes, and holds more than {64 << 20}: if that is right, unpack", line)
        self.write("z.csv.zst", zstd_zeros(400))  # 50 MiB of nothing: read, and refused as such
        line = self.fail_with(1, "locate", self.tetra(), "--points", "z.csv.zst", "--out", "l.csv")
        self.assertTrue(line.startswith("z.csv.zst: is neither .npy nor .csv"), line)


if __name__ == "__main__":
    unittest.main()
