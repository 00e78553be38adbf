# SPDX-License-Identifier: Apache-2.0
"""pierce cast: formats byte by byte, every answer against fractions, and every way to go wrong."""

import unittest

import numpy as np

from harness import (ALL_F4, CLOSEST_F4, CLOSEST_F8, NONE, TETRA_TRIANGLES, TETRA_VERTICES,
                     ToolTest, exact_hits, expected_closest, field_bytes, record)

# Through faces, edges and vertices of the tetrahedron, past it, along it and from inside it.
RAYS = [
    (0.25, 0.25, -1, 0, 0, 1), (0.1, 0.2, 5, 0, 0, -0.5), (0, 0, -1, 0, 0, 1),
    (0.5, 0.5, 2, 0, 0, -1), (2, 2, 2, 1, 0, 0), (0.25, 0.25, 0.25, -1, -2, -3),
    (-1, 0.25, 0.25, 3, 0, 0), (0.2, 0, -3, 0, 0, 7), (0.25, 0.25, 0, 1, 1, 0),
    (0.3, 0.3, 0.3, 0.1, 0.7, 0.2),
]


class Formats(ToolTest):
    def test_closest_in_float_is_exact_and_has_the_documented_bytes(self):
        mesh, rays = self.tetra(), self.write_rays("r.npy", RAYS)
        self.succeed("cast", mesh, "--rays", rays, "--out", "h.npy")
        hits = self.load("h.npy")
        self.assertEqual(hits.dtype, CLOSEST_F4)
        self.assertEqual(hits.shape, (len(RAYS),))
        expected = expected_closest(TETRA_VERTICES, TETRA_TRIANGLES, np.float32(RAYS), CLOSEST_F4)
        self.assertEqual(field_bytes(hits), field_bytes(expected))
        self.assertGreater(sum(hits["triangle"] == NONE), 0)

        data = (self.dir / "h.npy").read_bytes()
        self.assertEqual(data[:8], b"\x93NUMPY\x01\x00")
        self.assertEqual(len(data) % 64, len(RAYS) * 28 % 64)
        self.assertIn(b"'descr': [('t', '<f4'), ('u', '<f4'), ('v', '<f4'), ('w', '<f4'), "
                      b"('geometry', '<u4'), ('triangle', '<u4'), ('facing', '|u1'), ('', '|V3')]",
                      data)
        gaps = np.frombuffer(data[-28 * len(RAYS):], "|u1").reshape(-1, 28)[:, 25:]
        self.assertFalse(gaps.any())

    def test_closest_in_double_is_exact_and_has_the_documented_bytes(self):
        mesh, rays = self.tetra("double"), self.write_rays("r.npy", RAYS, "<f8")
        self.succeed("cast", mesh, "--rays", rays, "--out", "h.npy")
        expected = expected_closest(TETRA_VERTICES, TETRA_TRIANGLES, RAYS, CLOSEST_F8)
        self.assertEqual(self.load("h.npy").dtype, CLOSEST_F8)
        self.assertEqual(field_bytes(self.load("h.npy")), field_bytes(expected))

    def test_any_is_a_plain_bool_array(self):
        self.succeed("cast", self.tetra(), "--rays", self.write_rays("r.npy", RAYS), "--out",
                     "h.npy", "--query", "any")
        expected = [bool(exact_hits(TETRA_VERTICES, TETRA_TRIANGLES, ray))
                    for ray in np.float32(RAYS)]
        self.assertEqual(self.load("h.npy").dtype, np.dtype("|b1"))
        self.assertEqual(self.load("h.npy").tolist(), expected)

    def test_all_hits_are_grouped_by_ray_and_ordered(self):
        self.succeed("cast", self.tetra(), "--rays", self.write_rays("r.npy", RAYS), "--out",
                     "h.npy", "--query", "all")
        expected = []
        for i, ray in enumerate(np.float32(RAYS)):
            for hit in exact_hits(TETRA_VERTICES, TETRA_TRIANGLES, ray):
                expected.append((i, *record(hit, CLOSEST_F4).item()))
        hits = self.load("h.npy")
        self.assertEqual(hits.dtype, ALL_F4)
        self.assertEqual(field_bytes(hits), field_bytes(np.array(expected, ALL_F4)))
        self.assertGreater(len(hits), len(RAYS))

    def asked(self, query, *more):
        self.succeed("cast", self.tetra(), "--rays", self.write_rays("r.npy", RAYS), "--out",
                     "h.npy", "--query", query, *more)
        return self.load("h.npy")

    def test_count_is_one_u4_a_ray(self):
        counts = self.asked("count")
        self.assertEqual(counts.dtype, np.dtype("<u4"))
        expected = [len(exact_hits(TETRA_VERTICES, TETRA_TRIANGLES, ray))
                    for ray in np.float32(RAYS)]
        self.assertEqual(counts.tolist(), expected)

    def test_sides_keep_the_hits_of_one_facing(self):
        every = self.asked("all")
        for sides, facing in (("front", 0), ("back", 1)):
            kept = every[every["facing"] == facing]
            self.assertGreater(len(kept), 0)
            self.assertEqual(field_bytes(self.asked("all", "--sides", sides)), field_bytes(kept))
            counts = np.bincount(kept["ray"].astype(int), minlength=len(RAYS))
            self.assertEqual(self.asked("count", "--sides", sides).tolist(), counts.tolist())
            self.assertEqual(self.asked("any", "--sides", sides).tolist(), (counts > 0).tolist())
            first = self.asked("closest", "--sides", sides)
            _, rows = np.unique(kept["ray"], return_index=True)
            names = kept[rows][["geometry", "triangle"]].tolist()
            self.assertEqual(first[counts > 0][["geometry", "triangle"]].tolist(), names)
            crossings = self.asked("crossings", "--sides", sides)
            sign = 1 if facing else -1
            self.assertEqual(crossings["signed_count"].tolist(),
                             (sign * crossings["count"].astype(int)).tolist())
        self.assertEqual(field_bytes(self.asked("all", "--sides", "both")), field_bytes(every))

    def test_max_hits_cuts_every_list_short(self):
        every = self.asked("all")
        for most in (1, 2, 100):
            kept = [hit for i in range(len(RAYS)) for hit in every[every["ray"] == i][:most]]
            self.assertEqual(self.asked("all", "--max-hits", most).tolist(),
                             [hit.tolist() for hit in kept])

    def test_open_start_leaves_out_hits_at_t_min(self):
        rays = self.write_rays("r.npy", [(0.25, 0.25, -1, 0, 0, 1, 1, 9)])
        for name, first in (("closed", 0), ("open-start", 2)):
            self.succeed("cast", self.tetra(), "--rays", rays, "--out", "h.npy", "--range", name)
            self.assertEqual(self.load("h.npy")["triangle"].tolist(), [first])

    def test_max_hits_is_for_lists_only(self):
        rays = self.write_rays("r.npy", RAYS)
        line = self.fail_with(2, "cast", self.tetra(), "--rays", rays, "--out", "h.npy",
                              "--max-hits", "3")
        self.assertEqual(line, "cast: --max-hits: only the lists of --query all can be cut short")
        self.fail_with(2, "cast", self.tetra(), "--rays", rays, "--out", "h.npy", "--query", "all",
                       "--max-hits", "0")

    def test_crossings_have_the_documented_fields_and_are_odd_from_inside(self):
        inside, outside = (0.125, 0.125, 0.125), (-1, -1, -1)
        rays = [(*inside, 1, 0, 0), (*inside, -1, -1, -1), (*inside, 1, -1, 0),
                (*outside, 1, 1, 1), (*outside, 1, 2, 3), (0, 0, 0, 1, 1, 1), (2, 2, 2, 1, 0, 0)]
        self.succeed("cast", self.tetra(), "--rays", self.write_rays("r.npy", rays), "--out",
                     "h.npy", "--query", "crossings")
        crossings = self.load("h.npy")
        self.assertEqual(crossings.dtype, np.dtype([("count", "<u4"), ("signed_count", "<i4"),
                                                    ("origin_on_surface", "|b1")], align=True))
        self.assertEqual(crossings["count"][:3].tolist(), [1, 1, 1])
        self.assertEqual(crossings["signed_count"].tolist(), [1, 1, 1, 0, 0, 1, 0])
        self.assertEqual((crossings["count"][3:5] % 2).tolist(), [0, 0])
        self.assertEqual(crossings["origin_on_surface"].tolist(), [False] * 5 + [True, False])

    def test_csv_in_and_out_has_the_same_columns_and_numbers(self):
        text = "ox,oy,oz,dx,dy,dz\n" + "\n".join(",".join(map(repr, ray)) for ray in RAYS) + "\n"
        rays = self.write("r.csv", text)
        self.succeed("cast", self.tetra(), "--rays", rays, "--out", "h.csv")
        self.succeed("cast", self.tetra(), "--rays", rays, "--out", "h.npy")
        lines = (self.dir / "h.csv").read_text().splitlines()
        self.assertEqual(lines[0], "t,u,v,w,geometry,triangle,facing")
        hits = self.load("h.npy")
        self.assertEqual(hits.dtype, CLOSEST_F8)  # text is read to doubles
        for line, hit in zip(lines[1:], hits, strict=True):
            self.assertEqual([float(x) for x in line.split(",")], [float(x) for x in hit])
        self.assertIn("inf,0,0,0,4294967295,4294967295,0", lines)

    def test_csv_of_any_and_all_has_the_documented_columns(self):
        rays = self.write_rays("r.npy", RAYS)
        self.succeed("cast", self.tetra(), "--rays", rays, "--out", "h.csv", "--query", "all")
        self.assertEqual((self.dir / "h.csv").read_text().splitlines()[0],
                         "ray,t,u,v,w,geometry,triangle,facing")
        self.succeed("cast", self.tetra(), "--rays", rays, "--out", "h.csv", "--query", "any")
        self.assertEqual(len((self.dir / "h.csv").read_text().splitlines()), len(RAYS) + 1)

    def test_eight_columns_are_rays_with_a_closed_range(self):
        ray = (0.25, 0.25, -1, 0, 0, 1)
        rays = [(*ray, 0, 1), (*ray, 0, 0.999), (*ray, 1, 1), (*ray, 1.001, 9), (*ray, 1, 0),
                (*ray, -np.inf, np.inf)]
        self.succeed("cast", self.tetra(), "--rays", self.write_rays("r.npy", rays), "--out",
                     "h.npy")
        self.assertEqual(self.load("h.npy")["triangle"].tolist(), [0, NONE, 0, 2, NONE, 0])

    def test_no_rays_give_an_empty_file(self):
        rays = self.write_rays("r.npy", np.zeros((0, 6)))
        for query, dtype in (("closest", CLOSEST_F4), ("any", np.dtype("|b1")),
                             ("all", ALL_F4)):
            self.succeed("cast", self.tetra(), "--rays", rays, "--out", "h.npy", "--query", query)
            self.assertEqual(self.load("h.npy").shape, (0,))
            self.assertEqual(self.load("h.npy").dtype, dtype)

    def test_threads_and_chunks_do_not_change_a_byte(self):
        rng = np.random.default_rng(5)
        rays = self.write_rays("r.npy", rng.uniform(-1, 1, (20000, 6)))
        for query in ("closest", "any", "all", "count"):
            for threads in (1, 2, 7):
                self.succeed("cast", self.tetra(), "--rays", rays, "--query", query, "--threads",
                             threads, "--out", f"{query}{threads}.npy")
            first = (self.dir / f"{query}1.npy").read_bytes()
            self.assertEqual((self.dir / f"{query}2.npy").read_bytes(), first)
            self.assertEqual((self.dir / f"{query}7.npy").read_bytes(), first)


class Precision(ToolTest):
    def dtype_of(self, mesh, rays_dtype, *more):
        rays = self.write_rays("r.npy", RAYS, rays_dtype)
        done = self.succeed("cast", mesh, "--rays", rays, "--out", "h.npy", "--quiet", *more)
        return self.load("h.npy").dtype["t"], done.stderr

    def test_auto_is_float_only_if_both_files_hold_32_bit_numbers(self):
        obj = self.write_obj("t.obj", TETRA_VERTICES, TETRA_TRIANGLES)
        for mesh, rays, expected in (
                (self.tetra(), "<f4", "<f4"), (self.tetra(), "<f8", "<f8"),
                (self.tetra("double"), "<f4", "<f8"), (obj, "<f4", "<f8"),
                (self.tetra(), ">f4", "<f4")):
            self.assertEqual(self.dtype_of(mesh, rays), (np.dtype(expected), ""))

    def test_double_on_float_data_is_silent(self):
        self.assertEqual(self.dtype_of(self.tetra(), "<f4", "--precision", "double"),
                         (np.dtype("<f8"), ""))

    def test_float_on_double_data_says_in_one_line_what_it_rounds(self):
        dtype, remark = self.dtype_of(self.tetra("double"), "<f8", "--precision", "float")
        self.assertEqual(dtype, np.dtype("<f4"))
        self.assertEqual(remark, "pierce: --precision float: the numbers of tetra-double.ply and "
                                 "r.npy are rounded to 32 bits\n")
        _, remark = self.dtype_of(self.tetra(), "<f8", "--precision", "float")
        self.assertIn("the numbers of r.npy are", remark)
        _, remark = self.dtype_of(self.tetra("double"), "<f4", "--precision", "float")
        self.assertIn("the numbers of tetra-double.ply are", remark)


class Summary(ToolTest):
    def test_summary_tells_triangles_rays_and_hits_on_stderr_only(self):
        done = self.succeed("cast", self.tetra(), "--rays", self.write_rays("r.npy", RAYS),
                            "--out", "h.npy")
        self.assertEqual(done.stdout, "")
        rows = dict(line.split(maxsplit=1) for line in done.stderr.splitlines())
        self.assertEqual(rows["triangles"], "4")
        self.assertEqual(rows["rays"], "10")
        hits = int(np.sum(self.load("h.npy")["triangle"] != NONE))
        self.assertEqual(rows["hits"], f"{hits} ({10 * hits} %)")
        self.assertEqual(rows["wrote"], "h.npy")
        self.assertNotIn("\r", done.stderr)

    def test_quiet_says_nothing(self):
        done = self.succeed("cast", self.tetra(), "--rays", self.write_rays("r.npy", RAYS),
                            "--out", "h.npy", "--quiet")
        self.assertEqual(done.stdout + done.stderr, "")


class BadInput(ToolTest):
    def cast_fails(self, mesh, rays, *more, out="h.npy", status=1):
        before = self.files()
        message = self.fail_with(status, "cast", mesh, "--rays", rays, "--out", out, *more)
        self.assertEqual(self.files(), before)  # no partial output, no temporary file
        return message

    def test_missing_files_are_named(self):
        rays = self.write_rays("r.npy", RAYS)
        self.assertIn("no.ply", self.cast_fails("no.ply", rays))
        self.assertIn("no.npy", self.cast_fails(self.tetra(), "no.npy"))

    def test_empty_files_and_folders_are_named(self):
        rays = self.write_rays("r.npy", RAYS)
        for name in ("e.ply", "e.stl", "e.obj", "e.off", "e.npy", "e.csv", "e.xyz"):
            self.write(name, b"")
        (self.dir / "folder").mkdir()
        for mesh in ("e.ply", "e.stl", "e.obj", "e.off", "e.xyz", "folder"):
            self.assertTrue(self.cast_fails(mesh, rays).startswith(mesh), mesh)
        for bad in ("e.npy", "folder"):
            self.assertTrue(self.cast_fails(self.tetra(), bad).startswith(bad), bad)

    def test_mesh_without_a_triangle_is_an_error(self):
        rays = self.write_rays("r.npy", RAYS)
        points = self.write_ply("points.ply", TETRA_VERTICES, [])
        self.assertEqual(self.cast_fails(points, rays),
                         "points.ply: holds no triangle (4 vertices); give a mesh that has faces")

    def test_bad_vertex_and_bad_index_are_named_with_the_file(self):
        rays = self.write_rays("r.npy", RAYS)
        vertices = [list(v) for v in TETRA_VERTICES]
        vertices[2][1] = float("nan")
        message = self.cast_fails(self.write_ply("nan.ply", vertices, TETRA_TRIANGLES), rays)
        self.assertTrue(message.startswith("nan.ply: "), message)
        self.assertRegex(message, r"\b2\b")
        message = self.cast_fails(self.write_ply("i.ply", TETRA_VERTICES, [(0, 1, 9)]), rays)
        self.assertTrue(message.startswith("i.ply: "), message)

    def test_tables_that_are_no_rays_are_refused(self):
        for name, array in (("seven.npy", np.zeros((2, 7), "<f4")), ("flat.npy", np.zeros(6)),
                            ("complex.npy", np.zeros((2, 6), "<c8")),
                            ("bools.npy", np.zeros((2, 6), bool)),
                            ("texts.npy", np.full((2, 6), "1")),
                            ("longs.npy", np.zeros((2, 6), np.longdouble))):
            np.save(self.dir / name, array)
            self.assertTrue(self.cast_fails(self.tetra(), name).startswith(name), name)

    def test_truncated_rays_are_refused(self):
        rays = self.write_rays("r.npy", RAYS)
        data = (self.dir / rays).read_bytes()
        for length in (5, 40, len(data) - 1):
            self.write("cut.npy", data[:length])
            self.assertTrue(self.cast_fails(self.tetra(), "cut.npy").startswith("cut.npy"))

    def test_bad_rays_are_named_by_row(self):
        good = [0, 0, -1, 0, 0, 1]
        for column, value, what in ((0, np.nan, "its origin is not finite"),
                                    (4, np.inf, "its direction is not finite"),
                                    (5, 0, "its direction is zero")):
            rays = np.tile(good, (7, 1)).astype("<f4")
            rays[5, column] = value
            message = self.cast_fails(self.tetra(), self.write_rays("r.npy", rays))
            begin = f"r.npy: row 5 (counted from 0): bad ray: {what}; give "
            self.assertTrue(message.startswith(begin), message)
        rays = np.tile([*good, 0, 1], (3, 1)).astype("<f4")
        rays[2, 7] = np.nan
        self.assertIn("row 2 (counted from 0): bad ray: an end of its t range is NaN",
                      self.cast_fails(self.tetra(), self.write_rays("r.npy", rays)))

    def test_rows_are_counted_over_all_chunks(self):
        rays = np.tile(np.array([0, 0, -1, 0, 0, 1], "<f4"), (6000, 1))
        rays[5432, 0] = np.nan
        message = self.cast_fails(self.tetra(), self.write_rays("r.npy", rays), "--query", "all")
        self.assertIn("row 5432", message)

    def test_bad_csv_is_named_by_line(self):
        rays = self.write("r.csv", "ox,oy,oz,dx,dy,dz\n0,0,-1,0,0,1\n0,0,-1,0,zero,1\n")
        message = self.cast_fails(self.tetra(), rays)
        self.assertTrue(message.startswith("r.csv"), message)
        self.assertRegex(message, r"\b3\b")

    def test_output_that_cannot_be_written_is_named(self):
        rays = self.write_rays("r.npy", RAYS)
        self.assertIn("no/h.npy", self.cast_fails(self.tetra(), rays, out="no/h.npy"))
        self.assertIn("h.txt", self.cast_fails(self.tetra(), rays, out="h.txt", status=2))

    def test_failure_leaves_an_old_output_file_as_it_was(self):
        self.write("h.npy", b"old")
        rays = np.tile(np.array([0, 0, -1, 0, 0, 1], "<f4"), (9, 1))
        rays[8, 5] = 0
        self.cast_fails(self.tetra(), self.write_rays("r.npy", rays))
        self.assertEqual((self.dir / "h.npy").read_bytes(), b"old")

    def test_output_over_an_input_is_refused(self):
        rays = self.write_rays("r.npy", RAYS)
        before = (self.dir / rays).read_bytes()
        message = self.cast_fails(self.tetra(), rays, out=rays, status=2)
        self.assertEqual(message, "cast: --out: 'r.npy' is an input file; choose another name")
        self.assertEqual((self.dir / rays).read_bytes(), before)

    def test_ctrl_c_within_long_lists_leaves_no_file(self):
        # Every ray pierces every copy of one triangle: minutes of exact ties.
        mesh = self.write_ply("copies.ply", TETRA_VERTICES, [TETRA_TRIANGLES[0]] * 20000)
        rays = self.write_rays("r.npy", np.tile(np.float32((0.25, 0.25, -1, 0, 0, 1)), (1024, 1)))
        self.expect_ctrl_c_leaves_no_file("cast", mesh, "--rays", rays, "--query", "all", "--out",
                                          "h.npy")


if __name__ == "__main__":
    unittest.main()
