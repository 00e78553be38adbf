// SPDX-License-Identifier: Apache-2.0
//
// Which reader a file gets: what it holds comes before what it is called; and what is said about
// files that cannot be read at all.
#include <sys/stat.h>

#include <cmath>
#include <limits>

#include "io/read_mesh.h"
#include "support/io_files.h"

namespace pierce::io {
namespace {

const std::string kPly =
    "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\n"
    "property float z\nend_header\n1 2 3\n";
const std::string kOff = "OFF\n1 0 0\n1 2 3\n";
const std::string kObj = "# made by hand\nv 1 2 3\n";
const std::string kStl = "solid\nendsolid\n";

std::string binary_stl() { return std::string(80, 'x') + little(1u) + std::string(50, '\0'); }

TEST(IoReadMesh, content_decides_before_the_name) {
  for (const char* name : {"m.ply", "m.stl", "m.obj", "m.off", "m.3ds", "m.txt", "m"}) {
    EXPECT_EQ(read_mesh_bytes(kPly, name).format, "PLY, ascii") << name;
    EXPECT_EQ(read_mesh_bytes(kOff, name).format, "OFF") << name;
  }
  for (const char* name : {"m.stl", "m.STL", "m.obj", "m.txt", "m"}) {
    EXPECT_EQ(read_mesh_bytes(binary_stl(), name).format, "STL, binary") << name;
  }
  EXPECT_EQ(read_mesh_bytes(kStl, "m").format, "STL, ascii");
  EXPECT_EQ(read_mesh_bytes(kObj, "m").format, "OBJ");
  EXPECT_EQ(read_mesh_bytes(kObj, "m.OBJ").format, "OBJ");
}

TEST(IoReadMesh, the_mark_of_utf_8_is_no_part_of_the_text) {
  const std::string mark = "\xef\xbb\xbf";
  EXPECT_EQ(read_mesh_bytes(mark + "v 1 2 3\n", "m.obj").vertices.size(), 1u);
  EXPECT_EQ(read_mesh_bytes(mark + kOff, "m").vertices.size(), 1u);
  EXPECT_EQ(read_mesh_bytes(mark + kPly, "m").vertices.size(), 1u);
  EXPECT_EQ(read_mesh_bytes(mark + kStl, "m.stl").format, "STL, ascii");
  std::string titled = binary_stl();
  titled.replace(0, 3, mark);
  EXPECT_EQ(read_mesh_bytes(titled, "m").triangles.size(), 1u);
}

TEST(IoReadMesh, a_binary_stl_may_have_the_title_of_any_other_format) {
  for (const std::string_view title : {"ply ", "OFF ", "v 1 2 3\n", "glTF"}) {
    std::string bytes = binary_stl();
    bytes.replace(0, title.size(), title);
    EXPECT_EQ(read_mesh_bytes(bytes, "m.obj").format, "STL, binary");
  }
}

TEST(IoReadMesh, utf_16_is_read_as_what_it_says) {
  const std::string text("\xff\xfev\0 \0001\0\n\0", 10);
  EXPECT_EQ(error_of([&] { (void)read_mesh_bytes(text, "m.obj"); }),
            "m.obj:1: expected the vertex's y, found the end of the line: complete the line");
}

TEST(IoReadMesh, a_name_that_the_content_denies_is_an_error_of_that_format) {
  EXPECT_EQ(error_of([] { (void)read_mesh_bytes("rubbish", "m.ply"); }),
            "m.ply:1: a PLY file starts with the line 'ply': this is none");
  EXPECT_EQ(error_of([] { (void)read_mesh_bytes("rubbish", "m.dat"); }),
            "m.dat: is neither PLY, STL, OBJ, OFF nor glTF: convert it to PLY");
}

TEST(IoReadMesh, what_is_no_file_is_told) {
  const TempFolder folder;
  const auto error = [&](const std::filesystem::path& path) {
    const std::string message = error_of([&] { (void)read_mesh(path); });
    EXPECT_EQ(message.substr(0, path.string().size()), path.string());
    return message.substr(path.string().size());
  };
  EXPECT_EQ(error(folder / "none.ply"),
            ": cannot be opened: No such file or directory: check the name");
  EXPECT_EQ(error(folder / ""), ": is a folder: name a file in it");
  EXPECT_EQ(error(folder.write("empty.ply", "")), ": is empty: write it again");
  EXPECT_EQ(error("/dev/null"), ": is a pipe or a device: save its contents to a file first");
  ASSERT_EQ(::mkfifo((folder / "pipe").c_str(), 0600), 0);
  EXPECT_EQ(error(folder / "pipe"), ": is a pipe or a device: save its contents to a file first");
  EXPECT_EQ(error("-"), ": standard input is not read: give the name of a file");
}

TEST(IoReadMesh, a_file_gives_what_its_bytes_give) {
  const TempFolder folder;
  EXPECT_EQ(read_mesh(folder.write("a.ply", kPly)).vertices[0], (Vec3<double>{1, 2, 3}));
  EXPECT_EQ(read_mesh(folder.write("b", kObj)).vertices[0], (Vec3<double>{1, 2, 3}));
}

TEST(IoMesh, to_float_rounds_to_nearest_and_refuses_what_does_not_fit) {
  const std::vector<Vec3<double>> near = {{0.1, 1 + 0x1p-24, -0x1p-160}};
  EXPECT_EQ(to_float(near), (std::vector<Vec3<float>>{{0.1f, 1.0f, -0.0f}}));
  const std::vector<Vec3<double>> inf = {{std::numeric_limits<double>::infinity(), 0, 0}};
  EXPECT_EQ(to_float(inf)[0].x, INFINITY);
  const std::vector<Vec3<double>> far = {{0, 0, 0}, {1, 2, 1e39}};
  EXPECT_EQ(error_of([&] { (void)to_float(far); }, ErrorCode::InvalidArgument),
            "vertex 1 (1, 2, 1e+39) does not fit the range of float: use double precision");
}

}  // namespace
}  // namespace pierce::io
