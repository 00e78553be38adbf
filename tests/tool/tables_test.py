# SPDX-License-Identifier: Apache-2.0
"""Rays and points in all the forms that people have them in, and answers as columns."""

import unittest
import zipfile

import numpy as np

from harness import (CLOSEST_F4, CLOSEST_F8, TETRA_TRIANGLES, TETRA_VERTICES, ToolTest,
                     expected_closest, field_bytes)

RNG = np.random.default_rng(13)
RAYS = np.round(RNG.uniform(-1, 1, (60, 6)) * 32) / 32  # small fractions: halves hold them
NAMES = ["ox", "oy", "oz", "dx", "dy", "dz"]


class Forms(ToolTest):
    def setUp(self):
        super().setUp()
        self.mesh = self.tetra()
        self.expected = self.cast(np.float32(RAYS))
        self.assertEqual(field_bytes(self.expected), field_bytes(expected_closest(
            TETRA_VERTICES, TETRA_TRIANGLES, np.float32(RAYS), CLOSEST_F4)))

    def cast(self, array, *more):
        np.save(self.dir / "r.npy", array)
        self.done = self.succeed("cast", self.mesh, "--rays", "r.npy", "--out", "h.npy", "--quiet",
                                 *more)
        return self.load("h.npy")

    def expect_same(self, array, remark="", dtype=CLOSEST_F4):
        hits = self.cast(array)
        self.assertEqual(hits.dtype, dtype)
        for name in hits.dtype.names:
            # The rays are exact in float; so are the answers of double, once rounded.
            got = hits[name].astype(self.expected.dtype[name])
            np.testing.assert_array_equal(got, self.expected[name])
        self.assertEqual(self.done.stderr, remark)

    def test_order_of_the_memory_and_of_the_bytes_do_not_matter(self):
        self.expect_same(np.asfortranarray(np.float32(RAYS)))
        self.expect_same(np.float32(RAYS).astype(">f4"))
        self.expect_same(np.asfortranarray(RAYS.astype(">f8")), dtype=CLOSEST_F8)
        self.expect_same(np.float32(RAYS[::-1])[::-1])

    def test_halves_are_widened_exactly_and_count_as_float(self):
        self.expect_same(RAYS.astype("<f2"))
        self.expect_same(RAYS.astype(">f2"))

    def test_more_indices_are_flattened_as_numpy_does_with_a_remark(self):
        for array in (np.float32(RAYS).reshape(3, 20, 6),
                      np.asfortranarray(np.float32(RAYS).reshape(3, 20, 6)),
                      np.asfortranarray(np.float32(RAYS).reshape(3, 4, 5, 2, 3))):
            shape = ", ".join(map(str, array.shape))
            count = array.ndim - (2 if array.shape[-1] == 3 else 1)
            self.expect_same(array, f"pierce: r.npy: the rays of shape ({shape}) are read as 60 "
                                    f"rows, the last of the first {count} indices fastest\n")

    def test_pairs_of_points_and_directions(self):
        self.expect_same(np.float32(RAYS).reshape(60, 2, 3))
        self.expect_same(np.asfortranarray(np.float32(RAYS).reshape(60, 2, 3)))

    def test_records_by_name_in_any_order(self):
        for fields in ([(name, "<f4") for name in NAMES],
                       [(name.upper(), ">f4") for name in reversed(NAMES)],
                       [(name, "<f2" if name[0] == "o" else "<f4") for name in NAMES]):
            for align in (False, True):
                records = np.zeros(60, np.dtype(fields, align=align))
                for i, name in enumerate(NAMES):
                    field = next(f for f, _ in fields if f.lower() == name)
                    records[field] = RAYS[:, i]
                self.expect_same(records)
        pairs = np.zeros((6, 10), np.dtype([("id", "|u1"), ("direction", "<f4", (3,)),
                                            ("origin", "<f4", (3,))], align=True))
        pairs["origin"] = RAYS[:, :3].reshape(6, 10, 3)
        pairs["direction"] = RAYS[:, 3:].reshape(6, 10, 3)
        remark = ("pierce: r.npy: the rays of shape (6, 10) are read as 60 rows, the last of the "
                  "first 2 indices fastest\npierce: r.npy: fields that are not used: 'id'\n")
        self.expect_same(pairs, remark)
        self.expect_same(np.asfortranarray(pairs), remark)

    def test_headers_of_all_versions(self):
        for version in ((1, 0), (2, 0), (3, 0)):
            with open(self.dir / "v.npy", "wb") as file:
                np.lib.format.write_array(file, np.float32(RAYS), version=version)
            self.succeed("cast", self.mesh, "--rays", "v.npy", "--out", "h.npy")
            self.assertEqual(field_bytes(self.load("h.npy")), field_bytes(self.expected))

    def test_integers_are_exact_or_refused(self):
        rays = np.array([[0, 0, -1, 0, 0, 1], [0, 0, 5, 0, 0, -3]])
        expected = self.cast(np.float32(rays))
        for kind in ("i1", "<i2", ">i2", "<i4", "<i8", ">i8"):
            hits = self.cast(rays.astype(kind))
            self.assertEqual(hits.dtype, CLOSEST_F4 if kind in ("i1", "<i2", ">i2") else CLOSEST_F8)
            self.assertEqual(hits["triangle"].tolist(), expected["triangle"].tolist())
            self.assertEqual(hits["t"].astype("f4").tolist(), expected["t"].tolist())
            hits = self.cast(rays.astype(kind), "--precision", "float")
            self.assertEqual(self.done.stderr, "")  # nothing is rounded
            self.assertEqual(field_bytes(hits), field_bytes(expected))
        rays[1, 2] = 2**24 + 1
        self.cast(rays.astype("<i4"))
        line = self.fail_with(1, "cast", self.mesh, "--rays", "r.npy", "--out", "h.npy",
                              "--precision", "float")
        self.assertEqual(line, "r.npy: row 1: 16777217 is an integer that float cannot hold "
                               "exactly: use double precision, or round it with astype")
        rays[1, 2] = 2**53 + 1
        np.save(self.dir / "r.npy", rays)
        line = self.fail_with(1, "cast", self.mesh, "--rays", "r.npy", "--out", "h.npy")
        self.assertEqual(line, "r.npy: row 1: 9007199254740993 is an integer that double cannot "
                               "hold exactly: round it with astype('f8')")

    def csv(self, titles, columns, end="\n"):
        lines = [",".join(map(repr, map(float, row))) for row in RAYS[:, columns]]
        return self.write("r.csv", end.join([titles] * bool(titles) + lines) + end)

    def test_csv_by_its_titles_in_any_order(self):
        for titles, columns, end in (("", range(6), "\n"), ("ox,oy,oz,dx,dy,dz", range(6), "\r\n"),
                                     ("dz,DY,dx, oz ,\"oy\",ox", range(5, -1, -1), "\n")):
            self.succeed("cast", self.mesh, "--rays", self.csv(titles, list(columns), end),
                         "--out", "h.npy", "--precision", "float")
            self.assertEqual(field_bytes(self.load("h.npy")), field_bytes(self.expected))

    def test_csv_columns_that_are_not_used_are_named(self):
        text = "name,ox,oy,oz,dx,dy,dz,tmax\nfirst,0,0,-1,0,0,1,0.5\nsecond,0,0,-1,0,0,1,2\n"
        done = self.succeed("cast", self.mesh, "--rays", self.write("r.csv", text), "--out",
                            "h.npy", "--query", "any", "--quiet")
        self.assertEqual(done.stderr, "pierce: r.csv: columns that are not used: 'name'\n")
        self.assertEqual(self.load("h.npy").tolist(), [False, True])

    def test_csv_with_unknown_titles_is_refused_and_numbers_are_no_titles(self):
        rays = self.write("r.csv", "a,b,c,d,e,f\n0,0,-1,0,0,1\n")
        line = self.fail_with(1, "cast", self.mesh, "--rays", rays, "--out", "h.npy")
        self.assertEqual(line, "r.csv:1: the titles: nothing is named ox,oy,oz,dx,dy,dz: rays need "
                               "ox,oy,oz,dx,dy,dz[,t_min,t_max], by these names")
        rays = self.write("r.csv", "0,1,2,3,4,5\n0,0,-1,0,0,1\n")
        done = self.succeed("cast", self.mesh, "--rays", rays, "--out", "h.npy", "--quiet")
        self.assertIn("the first line, 0,1,...,5, is read as numbers", done.stderr)
        self.assertEqual(len(self.load("h.npy")), 2)

    def test_points_have_the_same_forms(self):
        points = np.array([(0.25, 0.25, 0.25), (1, 0, 0), (-1, 0, 0), (0.5, 0.5, 0.5)])
        expected = [1, 0, -1, -1]
        records = np.zeros(4, [("z", "<f2"), ("w", "<f4"), ("y", ">f8"), ("x", "<f4")])
        for i, axis in enumerate("xyz"):
            records[axis] = points[:, i]
        for array in (np.asfortranarray(points), points.reshape(2, 2, 3), points.astype("<f2"),
                      records):
            np.save(self.dir / "p.npy", array)
            self.succeed("locate", self.mesh, "--points", "p.npy", "--out", "l.npy")
            self.assertEqual(self.load("l.npy").tolist(), expected)
        text = "z,y,x\n" + "".join(f"{z!r},{y!r},{x!r}\n" for x, y, z in points.tolist())
        self.succeed("locate", self.mesh, "--points", self.write("p.csv", text), "--out", "l.npy")
        self.assertEqual(self.load("l.npy").tolist(), expected)


class Columns(ToolTest):
    def test_npz_has_the_columns_of_npy(self):
        rays = self.write_rays("r.npy", RAYS)
        for query in ("closest", "all", "any", "count", "crossings"):
            for name in ("h.npy", "h.NPZ"):
                self.succeed("cast", self.tetra(), "--rays", rays, "--query", query, "--out", name)
            records = self.load("h.npy")
            with np.load(self.dir / "h.NPZ") as columns:
                names = records.dtype.names or {"any": ("hit",), "count": ("count",)}[query]
                self.assertEqual(tuple(columns.files), names)
                for name in names:
                    column = records[name] if records.dtype.names else records
                    self.assertEqual(columns[name].dtype, column.dtype)
                    np.testing.assert_array_equal(columns[name], column)
            with zipfile.ZipFile(self.dir / "h.NPZ") as archive:
                self.assertIsNone(archive.testzip())
        self.assertEqual(self.files(), ["h.NPZ", "h.npy", "r.npy", "tetra-float.ply"])

    def test_npz_of_points_and_of_nothing(self):
        points = self.points([(0.25, 0.25, 0.25), (2, 2, 2)])
        self.succeed("locate", self.tetra(), "--points", points, "--out", "l.npz")
        self.assertEqual(self.load("l.npz")["location"].tolist(), [1, -1])
        self.succeed("nearest", self.tetra(), "--points", points, "--out", "n.npz")
        self.assertEqual(self.load("n.npz").files, ["x", "y", "z", "distance", "u", "v", "w",
                                                    "geometry", "triangle", "feature"])
        self.succeed("nearest", self.tetra(), "--points", self.points([]), "--out", "n.npz")
        self.assertEqual(self.load("n.npz")["x"].shape, (0,))

    def test_points_of_point_clouds(self):
        inside, outside = (0.125, 0.125, 0.125), (1, 1, 1)
        cloud = self.write_ply("cloud.ply", [inside, outside], [])
        lines = "".join(f"{x} {y} {z} 17 255\n" for x, y, z in (inside, outside))
        for name in (cloud, self.write("c.pts", "2\n" + lines), self.write("c.xyz", lines),
                     self.write("c.csv", "# z y x a b\n" + lines)):
            self.succeed("locate", self.tetra(), "--points", name, "--out", "l.npy", "--quiet")
            self.assertEqual(self.load("l.npy").tolist(), [1, -1])
        line = self.fail_with(1, "cast", self.tetra(), "--rays", cloud, "--out", "h.npy")
        self.assertIn("cloud.ply: is a PLY, not a table of rays", line)

    def test_arrays_of_an_npz(self):
        points, tetra = [(0.125, 0.125, 0.125), (1, 1, 1)], self.tetra()
        for save, arrays in ((np.savez, {"a": points}), (np.savez_compressed, {"points": points}),
                             (np.savez, {"colors": [1, 2], "points": points})):
            save(self.dir / "p.npz", **{k: np.float32(v) for k, v in arrays.items()})
            self.succeed("locate", tetra, "--points", "p.npz", "--out", "l.npy", "--quiet")
            self.assertEqual(self.load("l.npy").tolist(), [1, -1])
        self.succeed("rays", tetra, "--size", "4x4", "--out", "r.npy")
        np.savez(self.dir / "r.npz", self.load("r.npy"))
        hits = []
        for rays in ("r.npy", "r.npz"):
            self.succeed("cast", tetra, "--rays", rays, "--out", "h.csv", "--quiet")
            hits.append((self.dir / "h.csv").read_text())
        self.assertEqual(*hits)
        np.savez(self.dir / "s.npz", origins=points, directions=points)
        self.assertEqual(self.fail_with(1, "cast", tetra, "--rays", "s.npz", "--out", "h.csv"),
                         "s.npz: holds 2 arrays ('origins, directions'), none of them named rays: "
                         "name one so, of all columns together (ox,oy,oz,dx,dy,dz[,t_min,t_max])")
        with zipfile.ZipFile(self.dir / "x.xlsx", "w") as archive:
            archive.writestr("xl/workbook.xml", "<workbook/>")
        self.assertEqual(self.fail_with(1, "cast", tetra, "--rays", "x.xlsx", "--out", "h.csv"),
                         "x.xlsx: is an archive without arrays (.npy): save the rays with "
                         "numpy.save")

    def test_endings_count_in_any_case(self):
        rays = self.write_rays("r.npy", RAYS)
        self.succeed("cast", self.tetra(), "--rays", rays, "--out", "h.NPY")
        self.assertEqual((self.dir / "h.NPY").read_bytes()[:6], b"\x93NUMPY")
        self.succeed("cast", self.tetra(), "--rays", rays, "--out", "h.Csv")
        self.assertEqual((self.dir / "h.Csv").read_bytes()[:2], b"t,")
        self.succeed("voxelise", self.tetra(), "--size", "4", "--out", "g.NPY")
        self.assertEqual(self.load("g.NPY").shape, (4, 4, 4))
        self.succeed("rays", self.tetra(), "--size", "4x4", "--out", "R.Npy")
        self.assertEqual(self.load("R.Npy").shape, (16, 6))


if __name__ == "__main__":
    unittest.main()
