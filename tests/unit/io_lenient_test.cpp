// SPDX-License-Identifier: Apache-2.0
//
// Files that are not as they should be although nothing is lost: read, with a warning where
// something was passed over; and files that are no meshes at all, named as what they are.
#include "io/read_mesh.h"
#include "support/io_files.h"

namespace pierce::io {
namespace {

std::string header(std::uint32_t count) { return std::string(80, 'x') + little(count); }

std::string record(std::uint16_t attribute) {
  return std::string(12, '\0') + little(0.f, 0.f, 0.f, 1.f, 0.f, 0.f, 0.f, 1.f, 0.f) +
         little(attribute);
}

TEST(IoLenient, binary_stl_of_another_size) {
  const auto warnings = [](const std::string& bytes, std::size_t triangles) {
    const Mesh mesh = read_mesh_bytes(bytes, "m.stl");
    EXPECT_EQ(mesh.triangles.size(), triangles);
    for (std::size_t i = 0; i < mesh.vertices.size(); i += 3) {
      EXPECT_EQ(mesh.vertices[i + 1], (Vec3<double>{1, 0, 0}));
    }
    return mesh.warnings.size();
  };
  const std::string two = record(0) + record(0);
  EXPECT_EQ(warnings(header(2) + two, 2), 0u);
  EXPECT_EQ(warnings(header(2) + record(7) + record(31), 2), 0u);  // colours
  for (const std::size_t more : {1u, 50u, 92u}) {
    EXPECT_EQ(warnings(header(2) + two + std::string(more, '\3'), 2), 1u);
  }
  EXPECT_EQ(warnings(header(2) + record(3) + "abc" + record(1) + "d", 2), 1u);
  for (const std::uint32_t never_filled : {0u, 0xffffffffu}) {
    EXPECT_EQ(warnings(header(never_filled) + two, 2), 1u);
  }
  EXPECT_NE(error_of([&] { (void)read_mesh_bytes(header(3) + two, "m.stl"); }), "");
  EXPECT_NE(error_of([&] { (void)read_mesh_bytes(header(0) + two + "x", "m.stl"); }), "");
}

TEST(IoLenient, ascii_stl_in_the_words_of_others) {
  const std::string text =
      "solid a b\n color 1 0 0\n facet normal 0 0 0\n  outer loop\n   vertex 0 0 0\n   vertex 1 0 "
      "0\n   vertex 0 1 0\n  end loop\n # no more\n end facet\nend solid a b\n";
  std::string upper = text;
  for (char& c : upper) c = c >= 'a' && c <= 'z' ? static_cast<char>(c - 32) : c;
  for (const std::string& words : {text, upper}) {
    for (const char* first :
         {"", "# a comment\n\n", "; a comment\n", "// a comment\n", "\xef\xbb\xbf", "  \t"}) {
      for (const char* end : {"\n", "\r\n", "\r"}) {
        const std::string bytes = replaced(first + words, '\n', end);
        std::string wide = "\xff\xfe";
        for (const char c : bytes) wide.append({c, '\0'});
        EXPECT_EQ(read_mesh_bytes(bytes, "m.stl").triangles.size(), 1u) << bytes;
        if (first[0] != '\xef') {
          EXPECT_EQ(read_mesh_bytes(wide, "m.stl").triangles.size(), 1u) << bytes;
        }
      }
    }
  }
}

TEST(IoLenient, attributes_of_an_obj_never_refuse_its_positions) {
  const std::string corners = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
  for (const char* rest :
       {"f 1/7/9 2/8/9 3/9/9\n", "vt abc x\nf 1/1 2/1 3/1\n", "vn 1\nf 1//1 2//1 3//1\n",
        "vt 0 0\nf 1/-5 2/0 3/1\n", "f 1/a/b 2/c/d 3/e/f\n"}) {
    const Mesh mesh = read_mesh_bytes(corners + rest, "m.obj");
    EXPECT_EQ(mesh.triangles, (std::vector<Triangle>{{0, 1, 2}})) << rest;
    EXPECT_EQ(mesh.warnings.size(), 1u) << rest;
  }
  for (const char* rest : {" 4 5", " 4 5 6 7 8", " red", " 1 0 x", " nan(x) 0"}) {
    const Mesh mesh =
        read_mesh_bytes("v 0 0 0\nv 1 0 0" + std::string(rest) + "\nv 0 1 0\nf 1 2 3\n", "m.obj");
    EXPECT_EQ(mesh.triangles.size(), 1u) << rest;
    EXPECT_EQ(mesh.vertices[1], (Vec3<double>{1, 0, 0})) << rest;
    EXPECT_EQ(mesh.warnings.size(), 1u) << rest;
  }
  const Mesh unknown = read_mesh_bytes("V 0 0 0\nv 1 0 0\nv 0 1 0\nF 1 2 3\nabc 1\ndef\n", "m.obj");
  EXPECT_EQ(unknown.triangles.size(), 1u);
  EXPECT_EQ(unknown.warnings,
            (std::vector<std::string>{"2 lines that OBJ does not know, the first beginning with "
                                      "'abc': passed over"}));
  const Mesh curved = read_mesh_bytes(corners + "f 1 2 3\nsurf 0 1 0 1 1 2 3 1\nend\n", "m.obj");
  EXPECT_EQ(curved.warnings, (std::vector<std::string>{"1 free-form surface is not read: convert "
                                                       "them to triangles"}));
  for (const char* end : {"\n", "\r\n", "\r"}) {
    const std::string glued =
        replaced("v 0 0\\\n 0\nv 1\\\n 0 0\nv 0 1 0\\\n\nf 1 2\\\n 3\n", '\n', end);
    EXPECT_EQ(read_mesh_bytes(glued, "m.obj").triangles.size(), 1u);
  }
}

TEST(IoLenient, ply_in_any_case_with_comments_anywhere) {
  const std::string text =
      "ply\ncomment a\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
      "comment b\nproperty float z\nelement face 1\nproperty list uchar int vertex_indices\n"
      "end_header\ncomment c\n0 0 0\n1 0 0\ncomment d\n0 1 0\n3 0 1 2\n";
  std::string upper = text;
  for (char& c : upper) c = c >= 'a' && c <= 'z' ? static_cast<char>(c - 32) : c;
  std::string odd = text;
  odd.replace(odd.find("vertex_indices"), 14, "corners");
  for (const std::string& words : {text, upper, odd}) {
    for (const char* end : {"\n", "\r\n", "\r"}) {
      const Mesh mesh = read_mesh_bytes(replaced(words, '\n', end), "m.ply");
      EXPECT_EQ(mesh.triangles, (std::vector<Triangle>{{0, 1, 2}})) << words;
    }
  }
}

TEST(IoLenient, empty_bytes_behind_a_ply) {
  const std::string start = "ply\nformat ";
  const std::string rest =
      " 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
      "element face 1\nproperty list uchar uchar vertex_indices\nend_header\n";
  const std::string binary = start + "binary_little_endian" + rest +
                             little(0.f, 0.f, 0.f, 1.f, 0.f, 0.f, 0.f, 1.f, 0.f) +
                             std::string("\3\0\1\2", 4);
  const std::string text = start + "ascii" + rest + "0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";
  for (const std::string& file : {binary, text}) {
    EXPECT_EQ(read_mesh_bytes(file, "m.ply").warnings.size(), 0u);
    EXPECT_EQ(read_mesh_bytes(file + "\n", "m.ply").warnings.size(), 0u);
    for (const std::string& more :
         {std::string(500, '\0'), std::string("\x1a"), std::string(" \n\x1a\0", 4)}) {
      EXPECT_EQ(read_mesh_bytes(file + more, "m.ply").warnings.size(), 1u);
      EXPECT_NE(error_of([&] { (void)read_mesh_bytes(file + more + "1", "m.ply"); }), "");
    }
  }
}

TEST(IoLenient, strangers_are_named) {
  const auto expect_named = [](const std::string& bytes, const char* as) {
    for (const char* name : {"m.stl", "m.obj", "m.ply", "m.off", "m.gltf", "m"}) {
      const std::string line = error_of([&] { (void)read_mesh_bytes(bytes, name); });
      EXPECT_NE(line.find(as), std::string::npos) << line;
    }
  };
  expect_named("\n <!DOCTYPE HTML>\n<html><body>404</body></html>\n", "is a web page");
  expect_named("<HTML>\n", "is a web page");
  expect_named("version https://git-lfs.github.com/spec/v1\noid sha256:0\nsize 9\n", "Git LFS");
  expect_named("PK\x03\x04" + std::string(200, 'x'), "is a ZIP archive");
  expect_named(std::string("\xfd") + "7zXZ" + std::string(200, 'x'), "is packed by xz");
  expect_named("BZh9" + std::string(200, 'x'), "is packed by bzip2");
  expect_named("%PDF-1.7\n" + std::string(200, 'x'), "is a PDF");
  expect_named("\x1f\x8b\x08" + std::string(200, 'x'), "is packed by gzip");
  EXPECT_NE(error_of([] {
              (void)read_mesh_bytes("nothing but words, " + std::string(100, 'x'), "m.stl");
            }).find("is text, but no STL"),
            std::string::npos);
}

TEST(IoLenient, attributes_of_a_ply_never_refuse_its_positions) {
  const Mesh mesh = read_mesh_bytes(
      "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
      "property float z\nproperty float nx\nproperty float ny\nproperty float nz\n"
      "element face 1\nproperty list uchar int vertex_indices\nend_header\n"
      "0 0 0 -1.#IND nan 1\n1 0 0 -nan(ind) 0 1\n0 1 0 1e999 0 1\n3 0 1 2\n",
      "m.ply");
  EXPECT_EQ(mesh.triangles.size(), 1u);
  EXPECT_EQ(mesh.normals[0], (Vec3<float>{0, 0, 1}));
  EXPECT_EQ(mesh.warnings, (std::vector<std::string>{"4 parts of normals, colours or texture "
                                                     "coordinates are no number: read as 0"}));
}

const std::string kObjText = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
const std::string kOffText = "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";
const std::string kStlText =
    "solid a\nfacet normal 0 0 0\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\n"
    "endloop\nendfacet\nendsolid a\n";

TEST(IoLenient, padding_behind_a_text) {
  const std::pair<const char*, std::string> files[] = {
      {"m.obj", kObjText}, {"m.off", kOffText}, {"m.stl", kStlText}, {"m", kStlText}};
  for (const auto& [name, text] : files) {
    for (const std::string& more :
         {std::string(500, '\0'), std::string("\x1a"), std::string(" \n\x1a\0\0", 5)}) {
      const Mesh mesh = read_mesh_bytes(text + more, name);
      EXPECT_EQ(mesh.triangles.size(), 1u) << name;
      EXPECT_EQ(mesh.warnings.size(), 1u) << name;
      if (more.find('\0') == more.npos) continue;
      EXPECT_NE(error_of([&] { (void)read_mesh_bytes(text + more + "x", name); }), "") << name;
    }
    EXPECT_EQ(read_mesh_bytes(text + " \n\n", name).warnings.size(), 0u);
  }
}

TEST(IoLenient, texts_under_each_others_names) {
  for (const char* name : {"m.obj", "m.ply", "m.off", "m.gltf", "m.txt"}) {
    EXPECT_EQ(read_mesh_bytes(kStlText, name).triangles.size(), 1u) << name;
  }
  EXPECT_EQ(read_mesh_bytes("# by hand\n" + kObjText, "m.stl").format, "OBJ");
  EXPECT_NE(error_of([] { (void)read_mesh_bytes("solid rock\nv 0 0 0\n", "m.stl"); }), "");
}

TEST(IoLenient, off_in_the_words_of_others) {
  const std::string rest =
      "0 0 0 255 0 0 255 0 0 1\n1 0 0 0 255 0 255 0 0 1\n"
      "0 1 0 0 0 255 255 0 0 1\n3 0 1 2\n";
  for (const char* start : {"NCOFF\n3 1 0\n", "ncoff\n3 1 -1\n", "NCOFF 3 1\n"}) {  // of MeshLab
    const Mesh mesh = read_mesh_bytes(start + rest, "m.off");
    EXPECT_EQ(mesh.triangles.size(), 1u) << start;
    EXPECT_EQ(mesh.normals[1], (Vec3<float>{0, 0, 1})) << start;
    EXPECT_EQ(mesh.colors[1], (Vec3<float>{0, 1, 0})) << start;
  }
  EXPECT_EQ(read_mesh_bytes("CSTOFF\n3 1 0\n0 0 0 1 0 0 1 0.5 0.5\n1 0 0 1 0 0 1 0.5 0.5\n"
                            "0 1 0 1 0 0 1 0.5 0.5\n3 0 1 2\n",
                            "m.off")
                .texcoords[2],
            (std::array<float, 2>{0.5f, 0.5f}));
  EXPECT_NE(error_of([] { (void)read_mesh_bytes("NNOFF\n1 0 0\n0 0 0\n", "m.off"); }), "");
}

TEST(IoLenient, known_mistakes_in_numbers_have_their_cure) {
  const auto cure = [](const std::string& word) {
    const std::string line =
        error_of([&] { (void)read_mesh_bytes("v " + word + " 0 0\n", "m.obj"); });
    return line.substr(line.rfind(": ") + 2);
  };
  EXPECT_EQ(cure("1,5"), "write it with a decimal point");
  EXPECT_EQ(cure("-1,5e+00"), "write it with a decimal point");
  EXPECT_EQ(cure("1.5,"), "put blanks between numbers, no commas");
  EXPECT_EQ(cure("1.5D+00"), "write its exponent with E");
  EXPECT_EQ(cure("1,5,"), "correct it");
  EXPECT_EQ(cure("x"), "correct it");
}

}  // namespace
}  // namespace pierce::io
