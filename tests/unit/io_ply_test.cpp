// SPDX-License-Identifier: Apache-2.0
//
// PLY: every encoding, type and order of elements gives the numbers in the file; every way of
// being broken is told with its place.
#include <cmath>
#include <limits>

#include "io/read_mesh.h"
#include "io/write_mesh.h"
#include "support/io_files.h"

namespace pierce::io {
namespace {

Mesh read(const std::string& bytes) { return read_mesh_bytes(bytes, "m.ply"); }
std::string error(const std::string& bytes) {
  return error_of([&] { (void)read(bytes); });
}

std::string at_byte(std::size_t byte, std::string_view message) {
  std::string out = "m.ply: byte ";
  out += std::to_string(byte);
  out += ": ";
  return out += message;
}

std::string header(const std::string& format, const std::string& elements) {
  return "ply\nformat " + format + " 1.0\n" + elements + "end_header\n";
}

const std::string kXyz = "property float x\nproperty float y\nproperty float z\n";
const std::string kList = "property list uchar int vertex_indices\n";
const std::string kTriangle =
    header("ascii", "element vertex 3\n" + kXyz + "element face 1\n" + kList);

TEST(IoPly, ascii_doubles_are_the_nearest) {
  const std::string xyz = "property double x\nproperty float64 y\nproperty double z\n";
  const Mesh mesh = read(header("ascii", "element vertex 3\n" + xyz + "element face 1\n" + kList) +
                         "0.1 1e-3 9007199254740993\n1 2 3\n4 5 6\n3 0 1 2\n");
  ASSERT_EQ(mesh.vertices.size(), 3u);
  EXPECT_EQ(mesh.vertices[0], (Vec3<double>{0.1, 1e-3, 9007199254740992.0}));
  EXPECT_EQ(mesh.triangles, (std::vector<Triangle>{{0, 1, 2}}));
  EXPECT_FALSE(mesh.single_precision);
  EXPECT_EQ(mesh.format, "PLY, ascii");
}

// Declared as floats, they are what a reader with floats makes of them, rounded once: 1 + 2^-24 +
// 2^-60 lies above a tie of floats, and its nearest double on it.
TEST(IoPly, ascii_floats_are_the_nearest) {
  const Mesh mesh = read(kTriangle +
                         "0.1 1e-46 1.00000005960464477626\n-inf nan 1e-45\n"
                         "3.4028235e38 16777217 0.10000000149011612\n3 0 1 2\n");
  const auto wide = [](float x) { return static_cast<double>(x); };
  EXPECT_EQ(mesh.vertices[0], (Vec3<double>{wide(0.1f), 0, wide(0x1.000002p0f)}));
  EXPECT_EQ(mesh.vertices[1].x, -std::numeric_limits<double>::infinity());
  EXPECT_TRUE(std::isnan(mesh.vertices[1].y));
  EXPECT_EQ(mesh.vertices[1].z, 0x1p-149);
  EXPECT_EQ(mesh.vertices[2],
            (Vec3<double>{wide(std::numeric_limits<float>::max()), 16777216, wide(0.1f)}));
  EXPECT_TRUE(mesh.single_precision);
  EXPECT_EQ(error(kTriangle + "0 0 0\n1 1e39 0\n0 1 0\n3 0 1 2\n"),
            "m.ply:11: '1e39' does not fit a float, as which it is declared: declare a double");
}

TEST(IoPly, each_property_has_its_own_type) {
  const Mesh mesh = read(header("ascii",
                                "element vertex 1\nproperty float x\nproperty double y\n"
                                "property int z\n") +
                         "0.1 0.1 16777217\n");
  EXPECT_EQ(mesh.vertices[0], (Vec3<double>{static_cast<double>(0.1f), 0.1, 16777217}));
  EXPECT_FALSE(mesh.single_precision);
}

TEST(IoPly, line_ends_and_layout_of_ascii_do_not_matter) {
  for (const std::string end : {"\r\n", "\r"}) {
    const std::string text = replaced(kTriangle + "0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n", '\n', end);
    EXPECT_EQ(read(text).triangles.size(), 1u);
  }
  // A row may take several lines, as of librealsense.
  const Mesh rows = read(kTriangle + "0 0\n0\n1 0 0\n\n0\n1\n0\n3\n0 1 2");
  EXPECT_EQ(rows.triangles.size(), 1u);
  EXPECT_EQ(rows.warnings.size(), 0u);
  const Mesh free_form = read(kTriangle + "0 0 0 1 0 0\n\n0 1\n0 3 0 1 2");
  EXPECT_EQ(free_form.triangles.size(), 1u);
  EXPECT_EQ(free_form.warnings.size(), 1u);
}

TEST(IoPly, rows_do_not_go_on_in_the_next_line_that_is_another_row) {
  const std::string vertices = "0 0 0\n1 0 0\n0 1 0\n", more = " is more than the header announces";
  const std::string four =
      header("ascii", "element vertex 4\n" + kXyz + "element face 2\n" + kList);
  EXPECT_NE(error(four + vertices + "3 0 1 2\n3 0 1 2\n").find("m.ply:13: '2'" + more),
            std::string::npos);
  EXPECT_NE(error(kTriangle + "0 0 0 9 9 9\n1 0 0 9 9 9\n0 1 0 9 9 9\n3 0 1 2\n")
                .find("m.ply:10: '9'" + more),
            std::string::npos);
  EXPECT_NE(error(kTriangle + vertices + "3 0 1 2 0 0\n").find("m.ply:13: '0'" + more),
            std::string::npos);
  // Read on and on, these would be faces of two corners.
  EXPECT_NE(error(header("ascii", "element vertex 4\n" + kXyz + "element face 3\n" + kList) +
                  vertices + "2 0 1 2\n0 1 2\n0 1\n"),
            "");
}

TEST(IoPly, integers_of_64_bits) {
  using Int = std::int64_t;
  const std::string file =
      header("binary_little_endian",
             "element vertex 3\nproperty int64 x\nproperty uint64 y\nproperty int64 z\n"
             "element face 1\nproperty list uint64 int64 vertex_indices\n") +
      little(Int{-5}, Int{1}, Int{0}, Int{1}, Int{0}, Int{0}, Int{0}, Int{-1}, Int{1} << 62) +
      little(Int{3}, Int{0}, Int{1});
  const Mesh mesh = read(file + little(Int{2}));
  EXPECT_EQ(mesh.vertices[0], (Vec3<double>{-5, 1, 0}));
  EXPECT_EQ(mesh.vertices[2], (Vec3<double>{0, 0x1p64, 0x1p62}));
  EXPECT_EQ(mesh.triangles, (std::vector<Triangle>{{0, 1, 2}}));
  EXPECT_NE(error(file + little(Int{-1})), "");
  EXPECT_NE(error(file + little(std::numeric_limits<Int>::max())), "");
}

TEST(IoPly, the_header_may_end_its_lines_in_several_ways) {
  const std::string data =
      little(0.f, 0.f, 0.f, 1.f, 0.f, 0.f, 0.f, 1.f, 0.f) + "\x03" + little(0, 1, 2);
  const std::string lines =
      header("binary_little_endian", "element vertex 3\n" + kXyz + "element face 1\n" + kList);
  for (const std::string first : {"\n", "\r\n", "\r"}) {
    for (const std::string last : {"\n", "\r\n", "\r"}) {
      if (first == "\r" && last == "\r\n") continue;  // the LF would be data
      std::string text = replaced(lines, '\n', first);
      text.erase(text.size() - first.size());
      EXPECT_NE(error(text), "");  // no line end, and no data
      EXPECT_EQ(read(text + last + data).triangles, (std::vector<Triangle>{{0, 1, 2}}));
    }
  }
}

TEST(IoPly, binary_of_both_byte_orders_gives_the_same_bits) {
  const std::string elements = "element vertex 3\n" + kXyz + "element face 1\n" + kList;
  const auto body = [](auto bytes) {
    return bytes(0.1f, -2.5f, 1e-40f) + bytes(1.0f, 2.0f, 3.0f) + bytes(4.0f, 5.0f, 6.0f) +
           bytes(std::uint8_t{3}) + bytes(2, 1, 0);
  };
  const Mesh l = read(header("binary_little_endian", elements) +
                      body([](auto... values) { return little(values...); }));
  const Mesh b = read(header("binary_big_endian", elements) +
                      body([](auto... values) { return big(values...); }));
  EXPECT_EQ(l.vertices[0], (Vec3<double>{static_cast<double>(0.1f), -2.5, 0x1.16c2p-133}));
  EXPECT_EQ(l.vertices, b.vertices);
  EXPECT_EQ(l.triangles, (std::vector<Triangle>{{2, 1, 0}}));
  EXPECT_EQ(l.triangles, b.triangles);
  EXPECT_TRUE(l.single_precision);
  EXPECT_TRUE(b.single_precision);
  EXPECT_EQ(l.format, "PLY, binary little endian");
  EXPECT_EQ(b.format, "PLY, binary big endian");
}

TEST(IoPly, binary_data_may_start_with_a_line_end) {
  const std::string elements = "element vertex 1\n" + kXyz;
  const std::string ten = little(std::bit_cast<float>(0x3f80000a), 2.0f, 3.0f);
  ASSERT_EQ(ten[0], '\n');
  for (const char* end : {"\n", "\r", "\r\n"}) {
    const std::string text = replaced(header("binary_little_endian", elements), '\n', end) + ten;
    EXPECT_EQ(read(text).vertices[0].x, static_cast<double>(0x1.000014p0f));
  }
}

TEST(IoPly, every_number_type_is_read) {
  const std::string elements =
      "element vertex 2\n"
      "property char x\nproperty uint8 a\nproperty short y\nproperty uint16 b\n"
      "property int32 c\nproperty uint d\nproperty double z\n";
  const auto row = [](auto bytes, double z) {
    return bytes(std::int8_t{-7}) + bytes(std::uint8_t{200}) + bytes(std::int16_t{-30000}) +
           bytes(std::uint16_t{60000}) + bytes(-1) + bytes(4294967295u) + bytes(z);
  };
  const auto l = [](auto... values) { return little(values...); };
  const auto b = [](auto... values) { return big(values...); };
  for (const Mesh& mesh :
       {read(header("binary_little_endian", elements) + row(l, 0.1) + row(l, -1e300)),
        read(header("binary_big_endian", elements) + row(b, 0.1) + row(b, -1e300)),
        read(header("ascii", elements) +
             "-7 200 -30000 60000 -1 4294967295 0.1\n-7 200 -30000 60000 -1 4294967295 -1e300")}) {
    EXPECT_EQ(mesh.vertices, (std::vector<Vec3<double>>{{-7, -30000, 0.1}, {-7, -30000, -1e300}}));
    EXPECT_FALSE(mesh.single_precision);
  }
}

TEST(IoPly, double_coordinates_are_not_single_precision) {
  const std::string elements =
      "element vertex 1\nproperty float x\nproperty float y\nproperty double z\n";
  EXPECT_FALSE(read(header("binary_little_endian", elements) + little(1.0f, 2.0f) + little(3.0))
                   .single_precision);
}

TEST(IoPly, other_elements_properties_and_lists_are_stepped_over_in_any_order) {
  const std::string elements =
      "comment a comment\nobj_info something element vertex 5\n"
      "element camera 1\nproperty double f\nproperty list ushort float k\n"
      "element face 2\nproperty uchar flags\nproperty list int16 uint32 vertex_index\n"
      "property list uchar float texcoord\n"
      "element vertex 4\nproperty float z\nproperty list uchar uchar tags\nproperty float y\n"
      "property float x\nproperty uchar confidence\n"
      "element empty 7\nelement edge 1\nproperty int a\n";
  const Mesh text = read(header("ascii", elements) +
                         "1.5 2 0.5 0.25\n"
                         "1 3 0 1 2 0\n0 4 0 1 2 3 2 0.5 0.5\n"
                         "3 0 2 1 0\n13 2 9 9 12 11 0\n23 0 22 21 0\n33 1 5 32 31 255\n"
                         "77\n");
  const std::string bytes =
      little(1.5) + little(std::uint16_t{2}, 0.5f, 0.25f) + little(std::uint8_t{1}) +
      little(std::int16_t{3}, 0u) + little(1u, 2u) + little(std::uint8_t{0}) +
      little(std::uint8_t{0}) + little(std::int16_t{4}) + little(0u, 1u, 2u, 3u) +
      little(std::uint8_t{2}) + little(0.5f, 0.5f) + little(3.0f) + little(std::uint8_t{0}) +
      little(2.0f, 1.0f) + little(std::uint8_t{0}) + little(13.0f) +
      std::string("\x02\x09\x09", 3) + little(12.0f, 11.0f) + little(std::uint8_t{0}) +
      little(23.0f) + little(std::uint8_t{0}) + little(22.0f, 21.0f) + little(std::uint8_t{0}) +
      little(33.0f) + std::string("\x01\x05", 2) + little(32.0f, 31.0f) +
      little(std::uint8_t{255}) + little(77);
  const Mesh binary = read(header("binary_little_endian", elements) + bytes);
  const std::vector<Vec3<double>> vertices = {{1, 2, 3}, {11, 12, 13}, {21, 22, 23}, {31, 32, 33}};
  const std::vector<Triangle> triangles = {{0, 1, 2}, {0, 1, 2}, {0, 2, 3}};
  EXPECT_EQ(text.vertices, vertices);
  EXPECT_EQ(binary.vertices, vertices);
  EXPECT_EQ(text.triangles, triangles);
  EXPECT_EQ(binary.triangles, triangles);
}

TEST(IoPly, polygons_are_fanned_and_less_than_triangles_are_none) {
  const Mesh mesh =
      read(header("ascii", "element vertex 5\n" + kXyz + "element face 5\n" + kList) +
           "0 0 0\n1 0 0\n1 1 0\n0 1 0\n0 0 1\n0\n1 0\n2 0 1\n5 4 3 2 1 0\n3 0 0 0\n");
  EXPECT_EQ(mesh.triangles, (std::vector<Triangle>{{4, 3, 2}, {4, 2, 1}, {4, 1, 0}, {0, 0, 0}}));
}

TEST(IoPly, lists_of_float_indices_are_read_if_whole) {
  const std::string elements =
      "element vertex 3\n" + kXyz + "element face 1\nproperty list float double vertex_indices\n";
  const std::string start = header("binary_little_endian", elements) + std::string(36, '\0');
  EXPECT_EQ(read(start + little(3.0f) + little(2.0, 1.0, 0.0)).triangles,
            (std::vector<Triangle>{{2, 1, 0}}));
  EXPECT_EQ(error(start + little(3.0f) + little(0.5, 1.0, 0.0)),
            at_byte(start.size() + 4, "expected a whole number, found 0.5: correct it"));
  EXPECT_NE(error(start + little(3.0f) + little(std::nan(""), 1.0, 0.0)), "");
}

TEST(IoPly, triangle_strips_turn_every_second_triangle_round) {
  const Mesh mesh = read(header("ascii", "element vertex 5\n" + kXyz +
                                             "element tristrips 1\n"
                                             "property list int int vertex_indices\n") +
                         "0 0 0 1 0 0 1 1 0 0 1 0 0 0 1\n9 0 1 2 3 -1 4 3 2 -1\n");
  EXPECT_EQ(mesh.triangles, (std::vector<Triangle>{{0, 1, 2}, {2, 1, 3}, {4, 3, 2}}));
}

TEST(IoPly, attributes_are_read_where_the_file_has_them) {
  const std::string elements = "element vertex 2\n" + kXyz +
                               "property float nx\nproperty float ny\nproperty float nz\n"
                               "property uchar red\nproperty uchar green\nproperty uchar blue\n"
                               "property uchar alpha\nproperty float s\nproperty float t\n";
  const Mesh mesh = read(header("ascii", elements) +
                         "0 0 0 0 0 1 255 0 51 9 0.5 0.25\n0 0 0 1 0 0 0 255 0 9 0 1\n");
  EXPECT_EQ(mesh.normals, (std::vector<Vec3<float>>{{0, 0, 1}, {1, 0, 0}}));
  EXPECT_EQ(mesh.colors, (std::vector<Vec3<float>>{{1, 0, 0.2f}, {0, 1, 0}}));
  EXPECT_EQ(mesh.texcoords, (std::vector<std::array<float, 2>>{{0.5f, 0.25f}, {0, 1}}));
  const Mesh fine = read(header("ascii", "element vertex 1\n" + kXyz +
                                             "property ushort red\nproperty ushort green\n"
                                             "property float blue\n") +
                         "0 0 0 65535 13107 0.5\n");
  EXPECT_EQ(fine.colors, (std::vector<Vec3<float>>{{1, 0.2f, 0.5f}}));
  EXPECT_TRUE(read(kTriangle + "0 0 0 1 0 0 0 1 0 3 0 1 2").normals.empty());
}

TEST(IoPly, nan_and_infinite_coordinates_are_read_as_they_stand) {
  const Mesh mesh = read(kTriangle + "nan inf -inf\n1 2 3\n4 5 6\n3 0 1 2\n");
  EXPECT_TRUE(std::isnan(mesh.vertices[0].x));
  EXPECT_EQ(mesh.vertices[0].y, INFINITY);
  EXPECT_EQ(mesh.vertices[0].z, -INFINITY);
}

TEST(IoPly, a_mesh_without_triangles_is_read) {
  EXPECT_EQ(read(header("ascii", "element vertex 1\n" + kXyz) + "1 2 3").vertices.size(), 1u);
  EXPECT_TRUE(read(header("ascii", "element vertex 0\n" + kXyz)).vertices.empty());
  EXPECT_TRUE(read(header("ascii", "")).vertices.empty());
}

TEST(IoPly, broken_headers_are_told_by_line) {
  EXPECT_EQ(error("ply\nformat ascii 2.0\n"),
            "m.ply:2: unknown PLY version '2.0': only 1.0 exists");
  EXPECT_EQ(error("ply\nformat binary 1.0\n"),
            "m.ply:2: unknown PLY format 'binary': it must be ascii, binary_little_endian or "
            "binary_big_endian");
  EXPECT_EQ(error("ply\nformat ascii 1.0\nproperty float x\n"),
            "m.ply:3: a property before any element: put an element first");
  EXPECT_EQ(error("ply\nformat ascii 1.0\nelement vertex x\n"),
            "m.ply:3: expected the number of elements, found 'x': correct it");
  EXPECT_EQ(error("ply\nformat ascii 1.0\nelement vertex -1\n"),
            "m.ply:3: -1 elements cannot be: correct the number");
  EXPECT_EQ(error("ply\nformat ascii 1.0\nelement vertex 1 2\n"),
            "m.ply:3: '2' too much on this line: remove it");
  EXPECT_EQ(error("ply\nformat ascii 1.0\nelement vertex 1\nproperty half x\n"),
            "m.ply:4: 'half' is no PLY number type: use char, uchar, short, ushort, int, uint, "
            "int64, uint64, float or double");
  EXPECT_EQ(error("ply\nformat ascii 1.0\nelement vertex 1\nproperty float\n"),
            "m.ply:4: the property has no name: complete the line");
  EXPECT_EQ(error("ply\nformat ascii 1.0\nelement v 1\nproperty float x\nproperty int x\n"),
            "m.ply:5: a second property 'x': rename one");
  EXPECT_EQ(error("ply\nformat ascii 1.0\nelement v 1\nelement v 1\n"),
            "m.ply:4: a second element 'v': rename one");
  EXPECT_EQ(error("ply\nformat ascii 1.0\nelemnt v 1\n"),
            "m.ply:3: unknown PLY header line 'elemnt': make it a comment");
  EXPECT_EQ(error("ply\nformat ascii 1.0\n"), "m.ply:3: no end_header: the file was cut off");
  EXPECT_NE(error(kTriangle.substr(0, kTriangle.size() - 1)), "");
  EXPECT_EQ(error("ply\nend_header\n"),
            "m.ply:2: no format line in the header: add 'format ascii 1.0' or what it is");
  EXPECT_EQ(error("solid\n"), "m.ply:1: a PLY file starts with the line 'ply': this is none");
}

TEST(IoPly, broken_ascii_data_is_told_by_line) {
  EXPECT_EQ(error(kTriangle + "0 0 0\n1 0 x\n0 1 0\n3 0 1 2\n"),
            "m.ply:11: expected a number, found 'x': correct it");
  EXPECT_EQ(error(kTriangle + "0 0 0\n1 0 1e400\n0 1 0\n3 0 1 2\n"),
            "m.ply:11: '1e400' does not fit a float, as which it is declared: declare a double");
  EXPECT_EQ(error(kTriangle + "0 0 0\n1 0 0\n0 1 0\n3 0 1 3\n"),
            "m.ply:13: index 3 names no vertex, there are 3: correct it");
  EXPECT_EQ(error(kTriangle + "0 0 0\n1 0 0\n0 1 0\n3 0 -1 2\n"),
            "m.ply:13: index -1 names no vertex, there are 3: correct it");
  EXPECT_EQ(error(kTriangle + "0 0 0\n1 0 0\n0 1 0\n-3 0 1 2\n"),
            "m.ply:13: a list of -3 items cannot be: correct it");
  EXPECT_EQ(error(kTriangle + "0 0 0\n1 0 0\n0 1 0\n3 0 1\n"),
            "m.ply:14: expected a whole number, found the end of the file: it was cut off, get it "
            "again");
  EXPECT_EQ(error(kTriangle + "0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n3 0 1 2\n"),
            "m.ply:14: 8 bytes too many after the last element: the counts in the header are wrong "
            "or line ends were converted");
  EXPECT_EQ(
      error(header("ascii", "element vertex 1\nproperty float x\nproperty float y\n") + "0 0"),
      "m.ply:7: the vertices lack a property x, y or z: name them so");
  EXPECT_EQ(error(header("ascii", "element face 1\nproperty list uchar float corners\n") + "0"),
            "m.ply:6: element 'face' lacks a list property vertex_indices: name it so");
}

TEST(IoPly, broken_binary_data_is_told_by_byte) {
  const std::string start =
      header("binary_little_endian", "element vertex 3\n" + kXyz + "element face 1\n" + kList) +
      std::string(36, '\0');
  const std::string end = std::to_string(start.size());
  EXPECT_EQ(error(start + "\x03" + little(0, 1, 3)),
            at_byte(start.size() + 9, "index 3 names no vertex, there are 3: correct it"));
  EXPECT_EQ(error(start + "\x03" + little(0, 1)),
            at_byte(start.size() + 9, "the file ends too early: it was cut off"));
  EXPECT_EQ(
      error(start + "\x03" + little(0, 1, 2) + "xy"),
      at_byte(start.size() + 9,
              "2 bytes too many after the last element: the counts in the header are wrong or "
              "line ends were converted"));
  EXPECT_EQ(read(start + "\x03" + little(0, 1, 2) + "\n").triangles.size(), 1u);
  EXPECT_NE(error(start.substr(0, start.size() - 1)), "");
}

TEST(IoPly, a_header_that_promises_too_much_is_refused_before_any_memory_is_taken) {
  for (const std::string format : {"ascii", "binary_little_endian"}) {
    const std::string huge = "element vertex 4000000000\n" + kXyz;
    EXPECT_NE(
        error(header(format, huge) + "0 0 0").find("announces 4,000,000,000 elements 'vertex'"),
        std::string::npos);
    EXPECT_NE(error(header(format, "element face 9223372036854775807\n" + kList)), "");
    EXPECT_NE(
        error(header(format, "element e 1\nproperty list uint double x\n") + little(0xffffffffu)),
        "");
  }
  EXPECT_EQ(error(header("ascii", "element vertex 9223372036854775807\n")),
            "m.ply:5: the vertices lack a property x, y or z: name them so");
}

TEST(IoPly, what_write_ply_writes_is_read_back_bit_by_bit) {
  const TempFolder folder;
  const std::vector<Vec3<double>> vertices = {{0.1, -0.0, 1e-320}, {1, 2, 3}, {-1e300, 5, 6}};
  const std::vector<Triangle> triangles = {{0, 1, 2}, {2, 1, 0}};
  write_ply<double>(folder / "d.ply", {vertices, triangles});
  const Mesh d = read_mesh(folder / "d.ply");
  EXPECT_EQ(d.vertices, vertices);
  EXPECT_TRUE(std::signbit(d.vertices[0].y));
  EXPECT_EQ(d.triangles, triangles);
  EXPECT_FALSE(d.single_precision);

  const std::vector<Vec3<float>> floats = {{0.1f, -0.0f, 1e-45f}, {1, 2, 3}, {-1e38f, 5, 6}};
  write_ply<float>(folder / "f.ply", {floats, triangles});
  const Mesh f = read_mesh(folder / "f.ply");
  EXPECT_EQ(to_float(f.vertices), floats);
  EXPECT_EQ(f.triangles, triangles);
  EXPECT_TRUE(f.single_precision);
  EXPECT_EQ(folder.files(), 2u);
}

}  // namespace
}  // namespace pierce::io
