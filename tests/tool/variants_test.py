# SPDX-License-Identifier: Apache-2.0
"""One mesh in every format, written in all the ways that are allowed or common: the same triangles,
bit by bit. PIERCE_VARIANTS is how many of each format (1000 for a long run)."""

import gzip
import os
import random
import struct
import unittest

import numpy as np

from harness import ToolTest

COUNT = int(os.environ.get("PIERCE_VARIANTS", "30"))
RNG = random.Random(20)
# Numbers whose digits are hard, and no zeros, whose sign a text may lose.
VERTICES = np.array([[0.1, -2.5e-7, 1 / 3], [1e5, 0.7, -1e-5], [-3.25, 12345.678, 0.1],
                     [5e-3, -1 / 7, 99.9], [2.0, 3.0, -4.0], [1e-3, 1e-3, 16777217.0]])
TRIANGLES = [(0, 1, 2), (2, 1, 3), (0, 2, 4), (4, 3, 5), (5, 3, 1)]
NORMAL_WORDS = ["0 0 0", "nan nan nan", "0 0 1", "-1.#IND 0 1e999"]
WORDS = ["made by hand", "caf\u00e9", "1 2 3", "f 1 2 3", "vertex", "x,y;z", "'quoted' \"text\""]
# What some programs end lines, begin files and encode them with.
LINE_ENDS = ["\n", "\r\n", "\r"]
ENCODINGS = ["utf-8", "utf-8-sig", "utf-16", "utf-16-be"]


def chance(p):
    return RNG.random() < p


def number(x):
    """Digits that are nearest to this double."""
    form = RNG.choice([repr, "{:.17g}".format, "{:.20e}".format, "{:+.17g}".format,
                       "{:.17G}".format, "{:.30f}".format])
    text = form(float(x))
    if float(text) != float(x):
        text = repr(float(x))
    if chance(0.1) and "e" not in text.lower() and "." in text:
        text += "000"
    if chance(0.05) and text.startswith("0."):
        text = text[1:]
    return text


def blank():
    return RNG.choice([" ", " ", "  ", "\t", " \t "])


def join(words):
    line = ""
    for i, word in enumerate(words):
        line += (blank() if i else "") + word
    return (blank() if chance(0.1) else "") + line + (blank() if chance(0.1) else "")


def cased(word):
    return RNG.choice([word, word.upper(), word.capitalize()])


def encode(lines, encodings, last_end=True):
    end = RNG.choice(LINE_ENDS)
    text = end.join(lines) + (end if last_end or chance(0.5) else "")
    encoding = RNG.choice(encodings)
    if encoding == "utf-16-be":
        return b"\xfe\xff" + text.encode(encoding)
    return text.encode(encoding)


def with_junk(lines, comment, share=0.15):
    """Comment and empty lines in between."""
    out = []
    for line in lines:
        while chance(share):
            out.append(RNG.choice(["", blank(), comment() if comment else ""]))
        out.append(line)
    return out


def obj():
    def comment():
        return "#" + RNG.choice(["", " "]) + RNG.choice(WORDS)

    lines = []
    for v in VERTICES:
        more = RNG.choice([[], [], ["1.0"], ["0.1", "0.2", "0.3"], ["255", "0", "1", "1"]])
        lines.append(join(["v", *map(number, v), *more]))
    lines += RNG.choice([[], ["vt 0 0", "vn 0 0 1"], ["vn nan nan nan", "vt -1.#IND00 0"]])
    lines += RNG.choice([[], ["o " + RNG.choice(WORDS)], ["mtllib a b.mtl", "usemtl x", "s off"],
                         ["mtllib C:\\models\\a.mtl", "usemtl C:\\models\\", "g D:\\"]])
    relative = chance(0.3)
    for t in TRIANGLES:
        form = RNG.choice(["{}", "{}", "{}/1", "{}//1", "{}/1/1", "{}/9/9", "{}/", "{}//"])
        corners = [form.format(v - len(VERTICES) if relative else v + 1) for v in t]
        lines.append(join([RNG.choice(["f", "f", "f", "fo"]), *corners]))
        if chance(0.2):
            lines.append(RNG.choice(["g " + RNG.choice(WORDS), "s 1", "l 1 2", "p 3", "usemtl y"]))
    if not relative and chance(0.3):  # faces may come before vertices
        lines.sort(key=lambda line: line.split()[0] in ("v",))
    if chance(0.3):  # continued lines
        lines = [x.replace(" ", " \\\n", 1) if x.strip()[:1] in "vf" and chance(0.3) else x
                 for x in lines]
    lines = [x if chance(0.9) or x.strip()[:1] not in "vf" or "\\" in x else x + " " + comment()
             for x in lines]
    lines = "\n".join(with_junk(lines, comment)).split("\n")
    return encode(lines, ENCODINGS, last_end=False)


def off():
    def comment():
        return "#" + RNG.choice(WORDS)

    word = RNG.choice(["OFF", "OFF", "off", "COFF", "NOFF", "STOFF", "4OFF", ""])
    counts = join([str(len(VERTICES)), str(len(TRIANGLES)), *RNG.choice([["0"], ["9"]])])
    lines = [word + " " + counts] if chance(0.3) else [word, counts] if word else [counts]
    more = {"COFF": ["255", "0", "0", "255"], "NOFF": ["0", "0", "1"], "STOFF": ["0", "1"],
            "4OFF": ["1"]}.get(word, [])
    colored = not more and chance(0.2)
    for v in VERTICES:
        lines.append(join([*map(number, v), *more, *(["0.1", "0.2", "0.3"] if colored else [])]))
    for t in TRIANGLES:
        tail = RNG.choice([[], [], ["255", "0", "0"], ["0.5", "0.5", "0.5", "1"]])
        lines.append(join(["3", *map(str, t), *tail]))
    if chance(0.3) and not colored and not any(len(x.split()) > 4 for x in lines[-5:]):
        words = " ".join(lines).split()  # in free form
        lines = []
        while words:
            length = RNG.randint(1, 9)
            lines.append(" ".join(words[:length]))
            words = words[length:]
    lines = [x if chance(0.9) else x + " " + comment() for x in lines]
    return encode(with_junk(lines, comment), ENCODINGS, last_end=False)


def binary_off():
    word = RNG.choice(["OFF", "off", "COFF", "NOFF", "STOFF", "4OFF", "STCN4OFF"])
    out = (word + blank() + cased("binary") + RNG.choice(["\n", "\r\n"])).encode()
    out += struct.pack(">3i", len(VERTICES), len(TRIANGLES), RNG.choice([0, 9]))
    for v in VERTICES:
        row = [*v] + [1] * ("4" in word) + [0, 0, 1] * ("N" in word)
        row += [1, 0.5, 0, 1] * ("C" in word) + [0, 1] * ("ST" in word)
        out += np.array(row, ">f4").tobytes()
    for t in TRIANGLES:
        color = RNG.choice([[], [0.1, 0.2, 0.3], [1, 0, 0, 1]])
        out += struct.pack(f">5i{len(color)}f", 3, *t, len(color), *color)
    return out + RNG.choice([b"", b"\n"])


def ascii_stl():
    def comment():
        return RNG.choice(["# ", "; ", "// "]) + RNG.choice(WORDS)

    title = RNG.choice(["", " part", " it's a \"part\" 2.0"])
    lines = [cased("solid") + title]
    for t in TRIANGLES:
        lines += [join([cased("facet"), cased("normal"), *RNG.choice(NORMAL_WORDS).split()]),
                  join([cased("outer"), cased("loop")])]
        lines += [join([cased("vertex"), *map(number, VERTICES[v])]) for v in t]
        lines += [cased(RNG.choice(["endloop", "end loop"])),
                  cased(RNG.choice(["endfacet", "end facet"]))]
        if chance(0.1):
            lines += [cased("endsolid") + title, cased("solid") + title]
        elif chance(0.1):
            lines.append("color 1 0 0")
    lines.append(cased(RNG.choice(["endsolid", "end solid"])) + title)
    return encode(with_junk(lines, comment), ENCODINGS, last_end=False)


def binary_stl():
    vendor = chance(0.2)
    header = RNG.choice([b"", b"solid part", "caf\u00e9".encode()])
    filled = vendor or chance(0.8)
    exact = filled and not vendor and chance(0.8)
    if exact:  # a title may look like anything
        header = RNG.choice([header, b"\x1f\x8b", b"ply\n", b"OFF", b"v 1 2 3", b"glTF"])
    out = header.ljust(80, RNG.choice([b"\0", b" "]))
    out += struct.pack("<I", len(TRIANGLES) if filled else RNG.choice([0, 2**32 - 1]))
    for t in TRIANGLES:
        extra = RNG.randbytes(RNG.randint(1, 9)) if vendor else b""
        attribute = len(extra) if vendor else RNG.choice([0, 0, 31, 65535])
        normal = RNG.choice([(0, 0, 0), (float("nan"),) * 3, (0, 0, 1)])
        out += struct.pack("<12fH", *normal, *VERTICES[list(t)].ravel(), attribute) + extra
    if filled and not vendor and not exact:
        out += bytes(RNG.randint(1, 99))
    return out


TYPES = {"float": "f4", "double": "f8", "uchar": "u1", "int": "i4", "short": "i2", "uint": "u4",
         "ushort": "u2"}
ORDERS = {"ascii": "<", "binary_little_endian": "<", "binary_big_endian": ">"}
ALIASES = {"float": "float32", "double": "float64", "uchar": "uint8", "int": "int32",
           "short": "int16", "uint": "uint32", "ushort": "uint16"}


def ply():
    order = RNG.choice(list(ORDERS))
    real = RNG.choice(["float", "double"])
    properties = [("x", real), ("y", real), ("z", real)]
    for extra in ([("nx", "float"), ("ny", "float"), ("nz", "float")], [("red", "uchar")],
                  [("quality", "double"), ("flags", "short")]):
        if chance(0.3):
            properties += extra
    RNG.shuffle(properties)
    count = RNG.choice(["uchar", "ushort", "int", "uint"])
    index = RNG.choice(["int", "uint", "uchar"])
    faces = [("list", RNG.choice(["vertex_indices", "vertex_index", "corners"]))]
    if chance(0.3):
        faces.insert(RNG.randint(0, 1), ("uchar", "part"))
    elements = ["vertex", "face"]
    if chance(0.2):
        elements.insert(RNG.randint(0, 2), "camera")
    if chance(0.1):
        elements.reverse()

    def spelt(kind):
        return cased(RNG.choice([kind, ALIASES[kind]]))

    header = [cased("ply"), join([cased("format"), order, "1.0"])]
    body, text = b"", []
    ends = ORDERS[order]

    def put(words, values):
        nonlocal body
        text.append(join(words))
        for kind, value in values:
            body += np.array(value).astype(ends + TYPES[kind]).tobytes()

    for element in elements:
        if element == "vertex":
            header.append(join([cased("element"), cased("vertex"), str(len(VERTICES))]))
            header += [join([cased("property"), spelt(kind), name.upper() if chance(0.1) else name])
                       for name, kind in properties]
            for v in VERTICES:
                row = [(kind, v["xyz".index(name)] if name in "xyz" else 1)
                       for name, kind in properties]
                words = [number(np.float32(x) if k == "float" and chance(0.5) else x)
                         if k in ("float", "double") else str(x) for k, x in row]
                put(words, row)
        elif element == "face":
            header.append(join([cased("element"), cased("face"), str(len(TRIANGLES))]))
            for kind, name in faces:
                header.append(join([cased("property"), cased("list"), spelt(count), spelt(index),
                                    name] if kind == "list" else
                                   [cased("property"), spelt("uchar"), name]))
            for t in TRIANGLES:
                row = []
                for kind, _ in faces:
                    row += ([(count, 3), *((index, v) for v in t)] if kind == "list"
                            else [("uchar", 7)])
                put([str(x) for _, x in row], row)
        else:
            header += [join([cased("element"), "camera", "1"]), "property float fov",
                       "property list uchar int views"]
            put(["1.5", "2", "7", "8"], [("float", 1.5), ("uchar", 2), ("int", 7), ("int", 8)])
    header = header[:1] + with_junk(header[1:], lambda: RNG.choice(["comment ", "obj_info "])
                                    + RNG.choice(WORDS))
    header.append(cased("end_header"))
    if order == "ascii":
        text = with_junk(text, lambda: "comment " + RNG.choice(WORDS))
        return encode(header + text, ENCODINGS, last_end=False), real
    end = RNG.choice(LINE_ENDS) if body[:1] != b"\n" else "\n"
    out = (end.join(header) + end).encode() + body
    return out + RNG.choice([b"", b"", b"\n", b"\r\n", bytes(20)]), real


DAE = """<?xml version="1.0" encoding="CODE"?>
<COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1">
<asset><unit meter="1"/><up_axis>Y_UP</up_axis></asset>
<library_geometries><geometry id="g" name="W\u00fcrfel"><mesh>
<source id="p"><float_array id="a" count="18">NUMBERS</float_array><technique_common>
<accessor source="#a" count="6" stride="3"><param name="X" type="float"/>
<param name="Y" type="float"/><param name="Z" type="float"/></accessor></technique_common></source>
<vertices id="v"><input semantic="POSITION" source="#p"/></vertices>
<triangles count="5"><input semantic="VERTEX" source="#v" offset="0"/><p>INDICES</p></triangles>
</mesh></geometry></library_geometries>
<library_visual_scenes><visual_scene id="s"><node id="n"><instance_geometry url="#g"/></node>
</visual_scene></library_visual_scenes><scene><instance_visual_scene url="#s"/></scene></COLLADA>"""


class Variants(ToolTest):
    def expect(self, extension, variants, corners):
        """All of them together through `pierce weld`, which keeps triangles in order."""
        for i, content in enumerate(variants):
            if chance(0.1):
                content = gzip.compress(content)
            self.write(f"{i}{extension}", content)
        names = [f"{i}{extension}" for i in range(len(variants))]
        done = self.run_tool("weld", *names, "--out", "w.npz", "--quiet", "--precision", "double")
        if done.returncode == 0:
            with np.load(self.dir / "w.npz") as arrays:
                got = arrays["vertices"][arrays["triangles"]].reshape(len(names), -1, 3, 3)
        else:
            got = [None] * len(names)
        for name, one, expected in zip(names, got, corners):
            if one is None:  # which is it?
                single = self.run_tool("weld", name, "--out", "w.npz", "--quiet", "--precision",
                                       "double")
                self.assertEqual(single.returncode, 0, self.explain(name, single.stderr))
                with np.load(self.dir / "w.npz") as arrays:
                    one = arrays["vertices"][arrays["triangles"]]
            self.assertEqual(one.tobytes(), expected.tobytes(), self.explain(name, ""))

    def explain(self, name, message):
        return f"{message}{(self.dir / name).read_bytes()!r}"

    def test_texts_that_declare_nothing_are_doubles(self):
        doubles = VERTICES[np.array(TRIANGLES)]
        for extension, make in ((".obj", obj), (".off", off), (".stl", ascii_stl)):
            with self.subTest(extension):
                self.expect(extension, [make() for _ in range(COUNT)], [doubles] * COUNT)

    def test_binary_stl(self):
        floats = np.float32(VERTICES).astype("f8")[np.array(TRIANGLES)]
        self.expect(".stl", [binary_stl() for _ in range(COUNT)], [floats] * COUNT)

    def test_binary_off(self):
        floats = np.float32(VERTICES).astype("f8")[np.array(TRIANGLES)]
        self.expect(".off", [binary_off() for _ in range(COUNT)], [floats] * COUNT)

    def test_xml_in_every_encoding(self):
        numbers = " ".join(f"{c:.17g}" for v in VERTICES for c in v)
        indices = " ".join(str(v) for t in TRIANGLES for v in t)
        names = [f"{i}.dae" for i in range(5)]
        for name, encoding in zip(names, ("utf-8", "utf-8-sig", "iso-8859-1", "utf-16",
                                          "utf-16-le")):
            text = (DAE.replace("CODE", "utf-8" if encoding == "utf-8-sig" else encoding)
                    .replace("NUMBERS", numbers).replace("INDICES", indices))
            self.write(name, text.encode(encoding))
        self.write("be.dae", b"\xfe\xff" + text.encode("utf-16-be"))
        self.succeed("weld", *names, "be.dae", "--out", "w.npz", "--quiet")
        with np.load(self.dir / "w.npz") as arrays:
            got = arrays["vertices"][arrays["triangles"]].reshape(6, -1)
        self.assertTrue(np.allclose(got[0], VERTICES[np.array(TRIANGLES)].ravel(), rtol=1e-6))
        self.assertEqual(got.tobytes(), got[:1].repeat(6, 0).tobytes())
        self.write("wide.dae", text.encode("utf-32"))
        self.assertIn("is text in UTF-32: save it as UTF-8",
                      self.fail_with(1, "info", "wide.dae"))

    def test_ply_of_all_kinds(self):
        files = [ply() for _ in range(3 * COUNT)]
        kinds = {"float": np.float32(VERTICES).astype("f8"), "double": VERTICES}
        self.expect(".ply", [content for content, _ in files],
                    [kinds[real][np.array(TRIANGLES)] for _, real in files])


if __name__ == "__main__":
    unittest.main()
