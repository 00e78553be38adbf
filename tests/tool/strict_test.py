# SPDX-License-Identifier: Apache-2.0
"""Every warning of every reader: a line and exit status 0; with --strict an error and 1."""

import io
import json
import struct
import unittest
import zipfile

import numpy as np

from harness import ToolTest

CORNERS = [(0, 0, 0), (1, 0, 0), (0, 1, 0)]
OBJ = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"
PLY = ("ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
       "property float z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n"
       "0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n")


def stl(count, records, more=b""):
    body = b"".join(struct.pack("<12fH", 0, 0, 0, *np.ravel(CORNERS), attribute) + extra
                    for attribute, extra in records)
    return bytes(80) + struct.pack("<I", count) + body + more


def gltf(buffer=None, **changes):
    """A triangle in a node; `changes` are put over the members of the file or its parts."""
    positions = np.float32(CORNERS).tobytes()
    data = {"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}],
            "nodes": [{"mesh": 0}], "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}],
            "buffers": [{"byteLength": 36}], "bufferViews": [{"buffer": 0, "byteLength": 36}],
            "accessors": [{"bufferView": 0, "componentType": 5126, "type": "VEC3", "count": 3,
                           "min": [0, 0, 0], "max": [1, 1, 0]}]}
    data |= changes
    text = json.dumps({key: value for key, value in data.items() if value is not None}).encode()
    text += b" " * (-len(text) % 4)
    chunks = struct.pack("<I4s", len(text), b"JSON") + text
    chunks += struct.pack("<I4s", 36, b"BIN\0") + positions
    return struct.pack("<4sII", b"glTF", 2, 12 + len(chunks)) + chunks + (buffer or b"")


def threemf(build):
    vertices = "".join(f'<vertex x="{x}" y="{y}" z="{z}"/>' for x, y, z in CORNERS)
    model = ('<model xmlns="http://schemas.microsoft.com/3dmanufacturing/core/2015/02"><resources>'
             f'<object id="1"><mesh><vertices>{vertices}</vertices><triangles>'
             '<triangle v1="0" v2="1" v3="2"/></triangles></mesh></object></resources>'
             f'<build>{build}</build></model>')
    relations = ('<Relationships xmlns="http://schemas.openxmlformats.org/package/2006/'
                 'relationships"><Relationship Target="/3D/3dmodel.model" Id="r" Type="http://'
                 'schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel"/></Relationships>')
    out = io.BytesIO()
    with zipfile.ZipFile(out, "w") as archive:
        archive.writestr("_rels/.rels", relations)
        archive.writestr("3D/3dmodel.model", model)
    return out.getvalue()


PRIMITIVE = {"attributes": {"POSITION": 0}}

# (name, content, what the warning holds)
MESHES = [
    ("m.stl", stl(0, [(0, b"")]), "announces 0 triangles: read as the 1"),
    ("m.stl", stl(1, [(4, b"abcd")]), "the vendor's bytes behind each triangle"),
    ("m.stl", stl(1, [(0, b"")], b"abc"), "3 bytes behind the announced 1 triangle left out"),
    ("m.obj", OBJ.replace("f", "vt a b\nf"), "2 normals or texture coordinates"),
    ("m.obj", OBJ.replace("1 0 0", "1 0 0 red"), "1 vertex holds more than x, y, z"),
    ("m.obj", OBJ + "abc\n", "1 line that OBJ does not know, the first beginning with 'abc'"),
    ("m.obj", "v 0 0 0\nv 1 1 0\nv 1 0 0\nv 0 1 0\nf 1 2 3 4\n",
     "1 polygon with a border that crosses itself"),
    ("m.ply", PLY + "\0\0\0", "3 empty bytes behind the last element"),
    ("m.obj", OBJ + "\0\0\0", "3 empty bytes behind the end of the text"),
    ("m.ply", "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
     "property float z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n"
     "0 0 0 1 0 0\n0 1 0 3 0 1 2\n", "vertices and faces do not begin lines"),
    ("m.ply", PLY.replace("element vertex", "Created by hand\nelement vertex"),
     "the header's line that begins with 'Created' is no PLY"),
    ("m.off", "OFF\n3 1 0\n0 0 0 1 0 0\n0 1 0\n3 0 1 2\n", "do not end with their lines"),
    ("m.glb", gltf(b"abcd"), "4 bytes behind the announced"),
    ("m.glb", gltf(scene=None, scenes=[{"nodes": [0]}, {"nodes": [0]}]),
     "none of its 2 scenes is the default"),
    ("m.glb", gltf(scene=None, scenes=None, nodes=None), "has no nodes"),
    ("m.glb", gltf(nodes=[{"mesh": 0, "skin": 0}, {}], skins=[{"joints": [1]}]),
     "its skin is not applied"),
    ("m.glb", gltf(meshes=[{"primitives": [PRIMITIVE | {"targets": [{"POSITION": 0}]}],
                             "weights": [0.5]}]),
     "its morph targets are not applied"),
    ("m.glb", gltf(nodes=[{"mesh": 0, "rotation": [0, 0, 0, 2]}]),
     "its rotation is no unit quaternion"),
    ("m.glb", gltf(nodes=[{"mesh": 0, "weights": [0.5]}]), "its morph targets are not applied"),
    ("m.glb", gltf(meshes=[{"primitives": [PRIMITIVE, {"attributes": {}}]}]),
     "has no positions and is left out"),
    ("m.glb", gltf(accessors=[{"bufferView": 0, "componentType": 5126, "type": "VEC3", "count": 3},
                              {"bufferView": 0, "componentType": 5121, "type": "SCALAR",
                               "count": 4}],
                   meshes=[{"primitives": [PRIMITIVE, PRIMITIVE | {"indices": 1}]}]),
     "1 corner behind the last whole triangle left out"),
    ("m.glb", gltf(meshes=[{"primitives": [{"attributes": {"POSITION": 0, "NORMAL": 9}}]}]),
     "NORMAL is left out"),
    ("m.3mf", threemf(""), "its build is empty"),
]


class Meshes(ToolTest):
    def test_each_warning_is_an_error_with_strict(self):
        for name, content, warning in MESHES:
            self.write(name, content)
            with self.subTest(warning):
                if warning == "its build is empty":
                    self.fail_with(1, "info", name, "--strict")
                    done = self.run_tool("info", name)
                    self.assertIn(warning, done.stderr)
                    continue
                done = self.succeed("info", name)
                self.assertTrue(done.stderr.startswith(f"pierce: {name}: "), done.stderr)
                self.assertIn(warning, done.stderr)
                self.assertEqual(done.stderr.count("\n"), 1)
                line = self.fail_with(1, "info", name, "--strict")
                self.assertIn(warning, line)
                self.assertTrue(line.endswith("; --strict refuses it"), line)

    def test_several_warnings_are_counted(self):
        self.write("m.obj", OBJ.replace("1 0 0", "1 0 0 red") + "abc\n")
        self.assertEqual(self.succeed("info", "m.obj").stderr.count("\n"), 2)
        line = self.fail_with(1, "info", "m.obj", "--strict")
        self.assertTrue(line.endswith(" (the first of 2 warnings); --strict refuses it"), line)

    def test_what_is_as_it_should_be_passes(self):
        for name, content in (("m.obj", OBJ), ("m.ply", PLY), ("m.stl", stl(1, [(31, b"")])),
                              ("m.glb", gltf()), ("m.3mf", threemf('<item objectid="1"/>'))):
            self.assertEqual(self.succeed("info", self.write(name, content), "--strict").stderr, "")


# (content, what the remark holds, rows)
TABLES = [
    ("0,1,2\n1,2,3\n", "the first line, 0,1,...,2, is read as numbers", 2),
    ("0,1,2\n", "the first line, 0,1,...,2, is read as numbers", 1),
    ("x,y,z\n", "holds no points", 0),
    ("# nothing\n\n", "holds no points", 0),
    ("x;y;z\n0,5;1;2\n", "commas are read as decimal signs", 1),
    ("x,y,z,id\n1,2,3,4\n", "columns that are not used: 'id'", 1),
    (np.zeros((2, 2, 3), "f4"), "are read as 4 rows", 4),
    (np.zeros(2, [("x", "f4"), ("y", "f4"), ("z", "f4"), ("id", "i4")]),
     "fields that are not used: 'id'", 2),
]
REFUSED = [
    ("0,1,2\n0.5,0.25,1.0\n1.5,2.5,3.5\n", "p.csv:1: the first line, 0,1,...,2, looks like titles"),
    ("0;1;2\n0,5;0,25;1,0\n", "p.csv:1: the first line, 0,1,...,2, looks like titles"),
    (",0,1,2\n0,0.5,0.25,1.0\n", "p.csv:1: "),
    ("3\n1 2 3\n", "p.csv:1: "),
    ("a,b,c\n1,2,3\n", "p.csv:1: the titles: "),
    ("points\n1,2,3\n", "p.csv:1: "),
    ("1|2|3\n", "p.csv:1: "),
    ("1,2,3\n4,5\n", "p.csv:2: expected 3 fields"),
    ("1,2,3\n\"4,5,6\n", "p.csv:2: "),
    ("0.5 1 2 255 0 0\n", "p.csv:1: "),
]


class Tables(ToolTest):
    def locate(self, content, *more):
        name = "p.csv" if isinstance(content, str) else "p.npy"
        if isinstance(content, str):
            self.write(name, content)
        else:
            np.save(self.dir / name, content)
        return ("locate", self.tetra(), "--points", name, "--out", "l.npy", "--quiet", *more)

    def test_each_remark_is_an_error_with_strict(self):
        for content, remark, rows in TABLES:
            with self.subTest(remark):
                done = self.succeed(*self.locate(content))
                self.assertIn(remark, done.stderr)
                self.assertEqual(len(self.load("l.npy")), rows)
                self.assertIn(remark, self.fail_with(1, *self.locate(content, "--strict")))

    def test_what_is_no_table_is_never_an_empty_one(self):
        for content, message in REFUSED:
            for end in ("\n", "\r\n", "\r"):
                line = self.fail_with(1, *self.locate(content.replace("\n", end)))
                self.assertTrue(line.startswith(message), line)
        for content in ("1.0,1,2\n0.5,0.25,1.0\n", "0,1,2\n1,0.5,0.5\n", "0.0,1.0,2.0\n0.5,1,1\n"):
            self.succeed(*self.locate(content))
            self.assertEqual(len(self.load("l.npy")), 2)


if __name__ == "__main__":
    unittest.main()
