# SPDX-License-Identifier: Apache-2.0
"""pierce render and rays: pictures decoded pixel by pixel, cameras against their geometry."""

import struct
import unittest
import zlib

import numpy as np

from harness import ToolTest

# A triangle that fills the whole picture of the camera below, facing it.
WALL = [(-9, -9, 0), (9, -9, 0), (0, 27, 0)]
CAMERA = ("--eye", "0,0,2", "--look-at", "0,0,0", "--fov", "40", "--size", "16x16")


def decode_png(data):
    """An 8-bit RGB or RGBA picture as an array; the five filters of the format undone."""
    assert data[:8] == b"\x89PNG\r\n\x1a\n"
    at, packed = 8, b""
    while at < len(data):
        length, kind = struct.unpack(">I4s", data[at:at + 8])
        body = data[at + 8:at + 8 + length]
        assert zlib.crc32(kind + body) == struct.unpack(">I", data[at + 8 + length:][:4])[0]
        if kind == b"IHDR":
            width, height, depth, color = struct.unpack(">IIBB", body[:10])
            assert (depth, color) in ((8, 2), (8, 6))
            channels = 3 if color == 2 else 4
        if kind == b"IDAT":
            packed += body
        at += length + 12
    raw = zlib.decompress(packed)
    stride = channels * width
    rows, above = [], bytearray(stride)
    for y in range(height):
        start = y * (stride + 1)
        kind, row = raw[start], bytearray(raw[start + 1:start + 1 + stride])
        for i in range(stride):
            left = row[i - channels] if i >= channels else 0
            corner = above[i - channels] if i >= channels else 0
            if kind == 1:
                row[i] = (row[i] + left) & 255
            elif kind == 2:
                row[i] = (row[i] + above[i]) & 255
            elif kind == 3:
                row[i] = (row[i] + (left + above[i]) // 2) & 255
            elif kind == 4:
                p = left + above[i] - corner
                nearest = min((abs(p - left), 0, left), (abs(p - above[i]), 1, above[i]),
                              (abs(p - corner), 2, corner))[2]
                row[i] = (row[i] + nearest) & 255
        rows.append(row)
        above = row
    return np.frombuffer(b"".join(rows), np.uint8).reshape(height, width, channels)


class Summaries(ToolTest):
    def test_render_and_rays_say_what_they_wrote(self):
        tetra = self.tetra()
        done = self.succeed("render", tetra, "--out", "p.png", *CAMERA, "--samples", "2")
        for text in ("triangles  4\n", "picture    16x16, 2 rays a pixel\n", "\nhits       ",
                     "precision  float\n", "\nrender     ", "rays of the camera/s\n",
                     "wrote      p.png\n"):
            self.assertIn(text, done.stderr)
        done = self.succeed("render", tetra, "--out", "p.png", *CAMERA, "--samples", "1")
        self.assertIn("16x16, 1 ray a pixel\n", done.stderr)
        done = self.succeed("rays", tetra, "--out", "r.npy", *CAMERA)
        for text in ("rays       256 = 16x16\n", "eye        0,0,2\n", "wrote      r.npy\n"):
            self.assertIn(text, done.stderr)
        for command, out in (("render", "p.png"), ("rays", "r.npy")):
            done = self.succeed(command, tetra, "--out", out, *CAMERA, "--quiet")
            self.assertEqual((done.stdout, done.stderr), ("", ""))


class RenderTest(ToolTest):
    def render(self, mesh, *more):
        self.succeed("render", mesh, "--out", "p.png", *more)
        return decode_png((self.dir / "p.png").read_bytes())

    def wall(self, **extra):
        return self.write_ply("wall.ply", WALL, [(0, 1, 2)], extra=extra)


class Shades(RenderTest):
    def test_normal_of_a_wall_that_faces_the_camera(self):
        picture = self.render(self.wall(), *CAMERA)
        self.assertEqual(picture.shape, (16, 16, 3))
        self.assertEqual(np.unique(picture.reshape(-1, 3), axis=0).tolist(), [[128, 128, 255]])

    def test_normals_of_the_file_are_interpolated(self):
        normals = np.array([(1, 0, 1), (1, 0, 1), (1, 0, 1)], "<f4")
        wall = self.wall(**{f"n{axis}": ("float", normals[:, i]) for i, axis in enumerate("xyz")})
        picture = self.render(wall, *CAMERA)
        half = round(255 * (0.5 + 0.5 * 0.5 ** 0.5))
        self.assertEqual(np.unique(picture.reshape(-1, 3), axis=0).tolist(), [[half, 128, half]])

    def test_smooth_makes_normals_that_run_on_over_an_edge(self):
        corners = [(-9, -9, -3), (0, -9, 0), (0, 27, 0), (9, -9, -3)]
        roof = self.write_ply("roof.ply", corners, [(0, 1, 2), (1, 3, 2)])
        sharp = self.render(roof, *CAMERA, "--samples", "1")
        self.assertEqual(len(np.unique(sharp.reshape(-1, 3), axis=0)), 2)
        smooth = self.render(roof, *CAMERA, "--samples", "1", "--smooth")
        self.assertGreater(len(np.unique(smooth.reshape(-1, 3), axis=0)), 4)
        beside_the_edge = smooth[8, 7:9].astype(int)
        self.assertLess(abs(beside_the_edge[0] - beside_the_edge[1]).max(),
                        abs(sharp[8, 7].astype(int) - sharp[8, 8]).max())

    def test_barycentric_colours_are_w_u_v_of_the_ray_through_the_pixel(self):
        picture = self.render(self.wall(), *CAMERA, "--shade", "barycentric", "--samples", "1")
        edge = 2 * np.tan(np.radians(20))
        for row, column in ((0, 0), (3, 12), (15, 8)):
            x, y = edge * (2 * (column + 0.5) / 16 - 1), edge * (1 - 2 * (row + 0.5) / 16)
            v = (y + 9) / 36
            u = (x + 9 - 9 * v) / 18
            expected = 255 * np.array([1 - u - v, u, v])
            self.assertLessEqual(np.abs(picture[row, column] - expected).max(), 0.51)
        uv = self.render(self.wall(), *CAMERA, "--shade", "uv", "--samples", "1")
        self.assertEqual(uv[..., :2].tolist(), picture[..., 1:].tolist())

    def test_facing_tells_front_from_back(self):
        front = self.render(self.wall(), *CAMERA, "--shade", "facing")[8, 8]
        back = self.render(self.wall(), *CAMERA[2:], "--eye", "0,0,-2", "--shade", "facing")[8, 8]
        self.assertGreater(front[2], front[0])
        self.assertGreater(back[0], back[2])

    def test_vertex_colours_of_the_file_are_shown(self):
        wall = self.wall(red=("uchar", 200), green=("uchar", 100), blue=("uchar", 50))
        picture = self.render(wall, *CAMERA, "--shade", "color")
        self.assertEqual(np.unique(picture.reshape(-1, 3), axis=0).tolist(), [[200, 100, 50]])

    def test_texture_coordinates_of_the_file_are_shown(self):
        wall = self.wall(s=("float", [0.0, 1.0, 0.5]), t=("float", [0.0, 0.0, 1.0]))
        picture = self.render(wall, *CAMERA, "--shade", "texcoord")
        self.assertGreater(len(np.unique(picture.reshape(-1, 3), axis=0)), 16)

    def test_shade_that_the_file_lacks_is_an_error(self):
        for shade, what in (("color", "vertex colours"), ("texcoord", "texture coordinates")):
            message = self.fail_with(1, "render", self.wall(), "--out", "p.png", "--shade", shade)
            self.assertEqual(message,
                             f"wall.ply: has no {what}; choose another --shade than {shade}")
        self.assertEqual(self.files(), ["wall.ply"])

    def test_open_wall_has_no_occlusion(self):
        picture = self.render(self.wall(), *CAMERA, "--shade", "ao")
        self.assertEqual(np.unique(picture).tolist(), [255])

    def test_corner_is_occluded(self):
        mesh = self.write_ply("two.ply", [*WALL, (-9, -1, 0), (9, -1, 0), (0, -1, 9)],
                              [(0, 1, 2), (3, 5, 4)])
        picture = self.render(mesh, *CAMERA, "--shade", "ao", "--light-samples", "64")
        self.assertLess(picture[15, 8, 0], picture[0, 8, 0])

    def test_every_shade_draws_something_and_depends_on_nothing_but_its_options(self):
        for shade in ("normal", "depth", "barycentric", "uv", "triangle", "facing", "ao", "clay"):
            args = ("--shade", shade, "--size", "24x16", "--precision", "double")
            one = self.render(self.tetra(), *args, "--threads", "1")
            self.assertEqual(one.shape, (16, 24, 3))
            self.assertGreater(len(np.unique(one.reshape(-1, 3), axis=0)), 16)
            many = self.render(self.tetra(), *args, "--threads", "5")
            self.assertEqual(one.tobytes(), many.tobytes())

    def test_seed_changes_noise_and_only_noise(self):
        args = (self.tetra(), "--shade", "ao", "--size", "16x16", "--samples", "1")
        first = self.render(*args)
        self.assertEqual(self.render(*args, "--seed", "0").tobytes(), first.tobytes())
        clay = (self.tetra(), "--shade", "clay", "--size", "16x16", "--samples", "2")
        self.assertNotEqual(self.render(*clay).tobytes(),
                            self.render(*clay, "--seed", "1").tobytes())

    def test_picture_of_one_pixel(self):
        self.assertEqual(self.render(self.tetra(), "--size", "1x1").shape, (1, 1, 3))


class Additions(RenderTest):
    def cube(self):
        corners = [(x, y, z) for x in (0, 1) for y in (0, 1) for z in (0, 1)]
        quads = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
        return self.write_ply("cube.ply", corners, [t for a, b, c, d in quads
                                                    for t in ((a, b, c), (a, c, d))])

    def test_edges_are_dark_and_the_faces_are_not(self):
        look = ("--eye", "0.5,0.5,4", "--look-at", "0.5,0.5,0", "--size", "64x64", "--samples", "1",
                "--orthographic", "--fov", "20")
        plain, lined = self.render(self.cube(), *look), self.render(self.cube(), *look, "--edges")
        differs = (plain != lined).any(axis=2)
        self.assertTrue(0 < differs.sum() < 0.2 * differs.size)
        self.assertTrue((lined[differs].sum(axis=1) < plain[differs].sum(axis=1)).all())
        rows, columns = np.nonzero(differs & (np.indices(differs.shape) > 20).all(axis=0)
                                   & (np.indices(differs.shape) < 44).all(axis=0))
        self.assertTrue(len(rows))  # the diagonal of the front, and nothing else, within it
        self.assertTrue((np.minimum(abs(rows - columns), abs(rows + columns - 63)) <= 1).all())

    def test_orthographic_rays_are_parallel(self):
        wide = self.render(self.cube(), "--orthographic", "--eye", "0.5,0.5,4", "--look-at",
                           "0.5,0.5,0", "--size", "80x80", "--samples", "1", "--fov",
                           "53.13010235415598", "--background", "white")  # 4 high and wide
        cube = (wide != 255).any(axis=2)
        self.assertEqual(cube.sum(), 20 * 20)
        self.assertTrue(cube[30:50, 30:50].all())
        near = self.render(self.cube(), "--orthographic", "--size", "40x40")
        self.assertGreater(len(np.unique(near.reshape(-1, 3), axis=0)), 3)

    def test_backgrounds(self):
        look = ("--eye", "0.5,0.5,4", "--look-at", "0.5,0.5,0", "--size", "32x32")
        clear = self.render(self.cube(), *look, "--background", "transparent")
        self.assertEqual(clear.shape, (32, 32, 4))
        self.assertEqual((clear[0, 0, 3], clear[16, 16, 3]), (0, 255))
        solid = self.render(self.cube(), *look)
        self.assertEqual(clear[16, 16, :3].tolist(), solid[16, 16].tolist())
        self.assertEqual(self.render(self.cube(), *look, "--background", "white")[0, 0].tolist(),
                         [255] * 3)

    def test_ground_is_darker_under_the_mesh_only(self):
        look = ("--eye", "0.5,3,4", "--look-at", "0.5,0.2,0.5", "--size", "48x48", "--background",
                "transparent")
        shadow = self.render(self.cube(), *look, "--ground")[..., 3].astype(int)
        clear = self.render(self.cube(), *look)[..., 3].astype(int)
        self.assertTrue((shadow >= clear).all())
        self.assertGreater((shadow - clear)[24:].max(), 40)
        self.assertLess((shadow - clear)[0].max(), 20)

    def test_section_cuts_off_and_fills_what_is_solid(self):
        look = ("--eye", "0.5,0.5,4", "--look-at", "0.5,0.5,0", "--size", "32x32", "--samples", "1",
                "--background", "white")
        whole = self.render(self.cube(), *look)
        none = self.render(self.cube(), *look, "--section", "0,0,1,-1")
        self.assertEqual(np.unique(none).tolist(), [255])
        half = self.render(self.cube(), *look, "--section", "0,0,1,0.5")
        self.assertNotEqual(half[16, 16].tolist(), whole[16, 16].tolist())
        self.assertGreater(half[16, 16, 0], half[16, 16, 2])  # the colour of cuts
        beyond = self.render(self.cube(), *look, "--section", "0,0,1,1.5")
        self.assertEqual(beyond.tolist(), whole.tolist())
        self.assertIn("--section: the normal", self.fail_with(
            2, "render", self.cube(), "--out", "q.png", "--section", "0,0,0,1"))

    def test_rays_and_hits_are_drawn_in_and_hidden_by_what_is_before_them(self):
        look = ("--eye", "0.5,0.5,4", "--look-at", "0.5,0.5,0", "--size", "64x64", "--samples", "1")
        np.save(self.dir / "r.npy", np.float32([[0.5, 0.5, 2, 0, 0, -1], [-1, 0.5, -1, 1, 0, 0]]))
        plain = self.render(self.cube(), *look)
        drawn = self.render(self.cube(), *look, "--rays", "r.npy")
        red = drawn[32, 32].astype(int)
        self.assertTrue((plain != drawn).any())
        self.assertGreater(red[0], red[1] + 60)              # the hit's ball
        self.assertEqual(drawn[32, 26].tolist(), plain[32, 26].tolist())  # behind the cube
        self.assertNotEqual(drawn[32, 8].tolist(), plain[32, 8].tolist())  # beside it
        self.succeed("cast", "cube.ply", "--rays", "r.npy", "--out", "h.npy")
        same = self.render("cube.ply", *look, "--rays", "r.npy", "--hits", "h.npy")
        self.assertEqual(same.tolist(), drawn.tolist())


class Camera(ToolTest):
    def rays(self, mesh, *more, size="8x8"):
        self.succeed("rays", mesh, "--out", "r.npy", "--size", size, *more)
        return self.load("r.npy")

    def test_rays_are_those_of_the_picture_row_by_row_from_the_top(self):
        rays = self.rays(self.tetra("double"), "--eye", "0,0,5", "--look-at", "0,0,0", "--fov",
                         "90", size="4x2")
        self.assertEqual(rays.dtype, np.dtype("<f8"))
        self.assertEqual(rays.shape, (8, 6))
        self.assertEqual(rays[:, :3].tolist(), [[0, 0, 5]] * 8)
        expected = [(x, y, -1) for y in (0.5, -0.5) for x in (-1.5, -0.5, 0.5, 1.5)]
        self.assertLess(np.abs(rays[:, 3:] - expected).max(), 1e-15)

    def test_rays_of_a_float_mesh_are_floats(self):
        self.assertEqual(self.rays(self.tetra()).dtype, np.dtype("<f4"))
        self.assertEqual(self.rays(self.tetra(), "--precision", "double").dtype, np.dtype("<f8"))

    def test_default_camera_has_the_whole_mesh_in_its_picture_and_little_else(self):
        rng = np.random.default_rng(3)
        for trial, size in enumerate(("40x40", "60x20", "20x60")):
            vertices = rng.normal(size=(30, 3)) * [1, 2, 3] + [5, -7, 11]
            name = self.write_ply(f"m{trial}.ply", vertices, [(i, i + 1, i + 2) for i in range(28)])
            rays = self.rays(name, size=size)
            width, height = map(int, size.split("x"))
            hit = self.cast(name).reshape(height, width)
            inner = hit[1:-1, 1:-1]
            self.assertEqual(hit.sum(), inner.sum())  # nothing at the rim ...
            reach = max(np.ptp(np.nonzero(hit)[0]) / height, np.ptp(np.nonzero(hit)[1]) / width)
            self.assertGreater(reach, 0.75)           # ... and it is not small
            self.assertEqual(len(rays), width * height)

    def cast(self, mesh):
        self.succeed("cast", mesh, "--rays", "r.npy", "--query", "any", "--out", "h.npy")
        return self.load("h.npy")

    def test_look_at_is_in_the_middle_of_the_picture(self):
        rays = self.rays(self.tetra("double"), "--look-at", "1,0,0", size="3x3")
        o, d = rays[4, :3], rays[4, 3:]
        self.assertLess(np.linalg.norm(np.cross([1, 0, 0] - o, d)), 1e-12)

    def test_camera_sees_a_mesh_that_is_flat_or_a_point_or_enormous(self):
        for name, vertices in (("flat.ply", [(0, 0, 0), (1, 0, 0), (0, 1, 0)]),
                               ("point.ply", [(3, 3, 3)] * 3),
                               ("line.ply", [(0, 0, 0), (1, 1, 1), (2, 2, 2)])):
            rays = self.rays(self.write_ply(name, vertices, [(0, 1, 2)]))
            self.assertTrue(np.isfinite(rays).all())
        huge = self.write_ply("huge.ply", np.multiply(WALL, 1e300), [(0, 1, 2)], "double")
        self.rays(huge)
        self.assertTrue(self.cast(huge).any())

    def test_camera_whose_numbers_overflow_is_refused(self):
        for wrong in (("--eye", "1e300,1e300,1e300"), ("--eye", "1e-320,0,0", "--look-at", "0,0,0"),
                      ("--fov", "1e-300")):
            for command in (("rays", self.tetra(), "--out", "r.npy"),
                            ("render", self.tetra(), "--out", "p.png")):
                message = self.fail_with(2, *command, *wrong)
                self.assertIn("the numbers of the camera do not fit float", message)

    def test_output_must_be_npy(self):
        self.assertIn("--out", self.fail_with(2, "rays", self.tetra(), "--out", "rays.csv"))


if __name__ == "__main__":
    unittest.main()
