// SPDX-License-Identifier: Apache-2.0
//
// OFF: the variants of its header, colours and normals, comments anywhere.
#include "io/read_mesh.h"
#include "support/io_files.h"

namespace pierce::io {
namespace {

Mesh read(const std::string& text) { return read_mesh_bytes(text, "m.off"); }
std::string error(const std::string& text) {
  return error_of([&] { (void)read(text); });
}

const std::string kBody = "0.1 0 0\n1 0 0\n1 1 0\n0 1 0\n4 0 1 2 3\n3 0 1 2\n";

TEST(IoOff, the_header_may_be_written_in_many_ways) {
  for (const char* start : {"OFF\n4 2 0\n", "OFF 4 2 0\n", "OFF4 2 0\n", "OFF\n4 2\n", "4 2 0\n",
                            "# a comment\n\nOFF # another\n# and\n4 2 0 # more\n\n",
                            "OFF\r\n4 2 0\r\n", "  OFF\n4 2 5\n"}) {
    const Mesh mesh = read(start + kBody);
    EXPECT_EQ(mesh.vertices,
              (std::vector<Vec3<double>>{{0.1, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}));
    EXPECT_EQ(mesh.triangles, (std::vector<Triangle>{{0, 1, 2}, {0, 2, 3}, {0, 1, 2}}));
    EXPECT_EQ(mesh.format, "OFF");
  }
}

TEST(IoOff, colors_of_vertices_are_read_with_and_without_announcement) {
  for (const char* word : {"OFF", "COFF"}) {
    const Mesh floats = read(std::string(word) + "\n2 0 0\n0 0 0 1 0 0.5\n1 1 1 0 1 0 1\n");
    EXPECT_EQ(floats.colors, (std::vector<Vec3<float>>{{1, 0, 0.5f}, {0, 1, 0}}));
    const Mesh bytes = read(std::string(word) + "\n1 0 0\n0 0 0 255 0 51 255\n");
    EXPECT_EQ(bytes.colors, (std::vector<Vec3<float>>{{1, 0, 0.2f}}));
  }
}

TEST(IoOff, normals_and_texture_coordinates_are_read_if_announced) {
  const Mesh mesh = read("STCNOFF\n1 0 0\n1 2 3 0 0 1 1 0 0 1 0.5 0.25\n");
  EXPECT_EQ(mesh.vertices[0], (Vec3<double>{1, 2, 3}));
  EXPECT_EQ(mesh.normals[0], (Vec3<float>{0, 0, 1}));
  EXPECT_EQ(mesh.colors[0], (Vec3<float>{1, 0, 0}));
  EXPECT_EQ(mesh.texcoords[0], (std::array<float, 2>{0.5f, 0.25f}));
  EXPECT_EQ(read("NOFF\n1 0 0\n1 2 3 0 1 0\n").normals[0], (Vec3<float>{0, 1, 0}));
  EXPECT_EQ(read("STOFF\n1 0 0\n1 2 3 0 1\n").texcoords[0], (std::array<float, 2>{0, 1}));
}

TEST(IoOff, colors_of_faces_are_stepped_over_and_small_faces_are_none) {
  const Mesh mesh = read(
      "OFF\n3 5 0\n0 0 0\n1 0 0\n0 1 0\n"
      "3 0 1 2 255 0 0\n3 2 1 0 0.5 0.5 0.5 1\n2 0 1 7\n1 0\n0\n");
  EXPECT_EQ(mesh.triangles, (std::vector<Triangle>{{0, 1, 2}, {2, 1, 0}}));
}

TEST(IoOff, broken_files_are_told_by_line) {
  EXPECT_EQ(error("OFF\n1 1 0\n0 0\n3 0 0 0\n"),
            "m.off:3: expected a coordinate, found the end of the line: complete the line");
  EXPECT_EQ(error("OFF\n1 1 0\n0 0 0\n3 0 0 1\n"),
            "m.off:4: index 1 names no vertex, there is 1: correct it");
  EXPECT_EQ(error("OFF\n1 1 0\n0 0 0\n3 0 0\n"),
            "m.off:4: expected the index of a vertex, found the end of the line: complete the "
            "line");
  EXPECT_EQ(error("OFF\n1 1 0\n0 0 0 1\n3 0 0 0\n"),
            "m.off:3: expected a colour of 3 or 4 numbers, found 1: correct the line or the header "
            "word");
  EXPECT_EQ(error("NOFF\n1 0 0\n0 0 0\n"),
            "m.off:3: expected a part of the normal, found the end of the line: complete the line");
  EXPECT_EQ(error("OFF\n2 0 0\n0 0 0 1 1 1 2 2 2 3 3 3\n"),
            "m.off:3: too many numbers for a vertex: put each on a line of its own");
  EXPECT_EQ(error("OFF\n1 0 0\n0 0 0\n3 0 0 0\n"),
            "m.off:4: '3' behind the last face: the counts are wrong, correct them");
  EXPECT_EQ(error("OFF\n-1 0 0\n"), "m.off:2: the number of vertices cannot be -1: correct it");
  EXPECT_EQ(error("OFF\n1 0 0 7\n0 0 0\n"), "m.off:2: too much behind the counts: remove it");
  EXPECT_EQ(error("4OFF\n1 0 0\n0 0 0 2\n"),
            "m.off:3: a fourth coordinate that is not 1: divide the others by it");
  EXPECT_EQ(error("nOFF\n4\n1 0 0\n"), "m.off:2: a mesh of 4 dimensions: only 3 are read");
  EXPECT_EQ(error("rubbish\n"),
            "m.off:1: expected the number of vertices, found 'rubbish': correct it");
}

std::string big(std::uint32_t word) {
  std::string bytes;
  for (int shift = 24; shift >= 0; shift -= 8) bytes += static_cast<char>(word >> shift & 0xff);
  return bytes;
}

TEST(IoOff, binary) {
  constexpr std::uint32_t kOne = 0x3f800000;  // as a float
  const auto words = [](std::vector<std::uint32_t> numbers) {
    std::string bytes;
    for (const std::uint32_t number : numbers) bytes += big(number);
    return bytes;
  };
  const std::string vertices = words({0, 0, 0, kOne, 0, 0, 0, kOne, 0});
  const std::string good = words({3, 1, 0}) + vertices + words({3, 0, 1, 2, 1, kOne});
  const Mesh mesh = read("OFF BINARY\n" + good);
  EXPECT_EQ(mesh.vertices, (std::vector<Vec3<double>>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}));
  EXPECT_EQ(mesh.triangles, (std::vector<Triangle>{{0, 1, 2}}));
  EXPECT_TRUE(mesh.single_precision);
  EXPECT_EQ(read("nOFF BINARY\r\n" + big(3) + good).vertices, mesh.vertices);
  for (std::size_t size = 0; size < good.size(); ++size) {
    EXPECT_NE(error("OFF BINARY\n" + good.substr(0, size)), "") << size;
  }
  EXPECT_EQ(error("OFF BINARY\n" + good + "xyz"),
            "m.off: byte 79: 3 bytes behind the last face: the counts are wrong, get the file "
            "again");
  EXPECT_EQ(error("OFF BINARY\n" + words({3, 1, 0}) + vertices + words({3, 0, 1, 3, 0})),
            "m.off: byte 71: index 3 names no vertex, there are 3: correct it");
  EXPECT_EQ(error("OFF BINARY\n" + words({0x7fffffff, 1, 0}) + vertices),
            "m.off: byte 19: 2,147,483,647 vertices and 1 face are announced, too many for the "
            "size of the file: it was cut off");
  EXPECT_EQ(error("OFF BINARY\n" + big(0xffffffff)),
            "m.off: byte 11: the number of vertices cannot be -1: get the file again");
  EXPECT_EQ(error("nOFF BINARY\n" + big(4) + good),
            "m.off: byte 12: a mesh of other than 3 dimensions: only 3 are read");
  EXPECT_EQ(error("4OFF BINARY\n" + words({1, 0, 0, 0, 0, 0, 0})),
            "m.off: byte 36: a fourth coordinate that is not 1: divide the others by it");
}

TEST(IoOff, header_words_in_small_letters_and_of_more_dimensions) {
  const std::string counts = "\n3 1 0\n", face = "3 0 1 2\n";
  const std::vector<Vec3<double>> expected = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  EXPECT_EQ(read("off" + counts + "0 0 0\n1 0 0\n0 1 0\n" + face).vertices, expected);
  EXPECT_EQ(read("noff" + counts + "0 0 0 0 0 1\n1 0 0 0 0 1\n0 1 0 0 0 1\n" + face).vertices,
            expected);
  EXPECT_EQ(read("4OFF" + counts + "0 0 0 1\n1 0 0 1\n0 1 0 1.0\n" + face).vertices, expected);
  EXPECT_EQ(read("nOFF\n3\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n" + face).vertices, expected);
}

// The same numbers, whose lines end anywhere.
TEST(IoOff, free_form) {
  const std::vector<std::string> words = {"OFF", "4", "2", "0", "0.1", "0", "0", "1", "0",
                                          "0",   "1", "1", "0", "0",   "1", "0", "4", "0",
                                          "1",   "2", "3", "3", "0",   "1", "2"};
  for (const char* end : {"\n", " ", "\r\n", " # and\n\n", "\t\v"}) {
    for (const std::size_t every : {1u, 2u, 3u, 5u, 7u, 100u}) {
      std::string text;
      for (std::size_t i = 0; i < words.size(); ++i) {
        text += words[i] + ((i + 1) % every == 0 ? end : " ");
      }
      const Mesh mesh = read(text);
      EXPECT_EQ(mesh.vertices, read("OFF\n4 2 0\n" + kBody).vertices) << text;
      EXPECT_EQ(mesh.triangles, read("OFF\n4 2 0\n" + kBody).triangles) << text;
      EXPECT_EQ(mesh.warnings.size(), 1u) << text;
    }
  }
  const Mesh colored =
      read("COFF 3 1 0\n0 0\n0 1 0 0 1\n1 0 0 0 1 0 1 0 1 0\n0 0 1 1\n3 0 1\n2 0.5 0.5 0.5\n");
  EXPECT_EQ(colored.colors, (std::vector<Vec3<float>>{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}));
  EXPECT_EQ(colored.triangles, (std::vector<Triangle>{{0, 1, 2}}));
}

// What lacks a number, or has one too many, is no file in free form, wherever it is.
TEST(IoOff, a_number_too_few_or_too_many_is_never_passed_over) {
  const std::string file =
      "OFF\n5 4 0\n0 0 0\n1 0 0\n1 1 0\n0 1 7\n3 4 4\n3 0 1 2\n3 0 2 3\n4 4 3 2 1\n3 3 1 4\n";
  EXPECT_EQ(read(file).triangles.size(), 5u);
  const std::size_t faces = file.find("3 0 1 2");
  for (std::size_t at = file.find("0 0 0"); at != file.npos;
       at = file.find_first_of("0123456789", at + 1)) {
    const std::size_t end = at + (file[at + 1] == '\n' ? 1 : 2);
    EXPECT_NE(error(file.substr(0, at) + file.substr(end)), "") << at;
    // A number more behind a face is a colour.
    if (at < faces) {
      EXPECT_NE(error(file.substr(0, at) + "2 " + file.substr(at)), "") << at;
    }
  }
}

TEST(IoOff, counts_beyond_the_file_are_refused_before_any_memory_is_taken) {
  EXPECT_EQ(error("OFF\n4000000000 4000000000 0\n0 0 0\n"),
            "m.off:2: 4,000,000,000 vertices and 4,000,000,000 faces are announced, too many for "
            "the size of the file: it was cut off");
  EXPECT_NE(error("OFF\n1 1 0\n0 0 0\n4000000000 0 0 0\n"), "");
}

}  // namespace
}  // namespace pierce::io
