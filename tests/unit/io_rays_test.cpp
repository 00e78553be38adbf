// SPDX-License-Identifier: Apache-2.0
//
// Rays and points from .npy and .csv: every allowed layout, bit by bit, and each way to be wrong.
#include <cmath>
#include <limits>
#include <numeric>

#include "io/npy.h"
#include "io/rays.h"
#include "support/io_files.h"

namespace pierce::io {
namespace {

constexpr double kInf = std::numeric_limits<double>::infinity();

template <class Real>
std::vector<Ray<Real>> rays(const std::filesystem::path& path) {
  const RayFile file(path);
  std::vector<Ray<Real>> out(file.size());
  file.read(0, std::span(out));
  return out;
}

class IoRays : public testing::Test {
 protected:
  std::filesystem::path npy(const char* descr, std::vector<std::uint64_t> shape,
                            const std::string& bytes) const {
    write_npy(folder_ / "r.npy", descr, shape, bytes);
    return folder_ / "r.npy";
  }
  [[nodiscard]] std::filesystem::path csv(const std::string& text) const {
    return folder_.write("r.csv", text);
  }
  /// The message without the folder.
  [[nodiscard]] std::string error(const std::filesystem::path& path) const {
    const std::string message = error_of([&] { (void)rays<float>(path); });
    const std::string start = (folder_ / "").string();
    EXPECT_EQ(message.substr(0, start.size()), start) << message;
    return message.size() < start.size() ? message : message.substr(start.size());
  }
  TempFolder folder_;
};

TEST_F(IoRays, six_columns_are_rays_from_0_to_infinity) {
  const auto path =
      npy("'<f4'", {2, 6},
          little(0.1f, 1.f, 2.f, 3.f, 4.f, 5.f) + little(6.f, 7.f, 8.f, -0.f, 1e-45f, 11.f));
  const RayFile file(path);
  EXPECT_EQ(file.size(), 2u);
  EXPECT_TRUE(file.single_precision());
  const std::vector<Ray<float>> f = rays<float>(path);
  EXPECT_EQ(f[0].origin, (Vec3<float>{0.1f, 1, 2}));
  EXPECT_EQ(f[1].direction, (Vec3<float>{0, 1e-45f, 11}));
  EXPECT_TRUE(std::signbit(f[1].direction.x));
  EXPECT_EQ(f[1].t_min, 0);
  EXPECT_EQ(f[1].t_max, std::numeric_limits<float>::infinity());
  const std::vector<Ray<double>> d = rays<double>(path);
  EXPECT_EQ(d[0].origin.x, static_cast<double>(0.1f));
}

TEST_F(IoRays, eight_columns_give_the_range) {
  const std::vector<Ray<double>> d =
      rays<double>(npy("'<f8'", {1, 8}, little(0.1, 1., 2., 3., 4., 5., -kInf, 7.5)));
  EXPECT_EQ(d[0].origin.x, 0.1);
  EXPECT_EQ(d[0].t_min, -kInf);
  EXPECT_EQ(d[0].t_max, 7.5);
  EXPECT_FALSE(RayFile(folder_ / "r.npy").single_precision());
}

TEST_F(IoRays, big_endian_arrays_are_read) {
  EXPECT_EQ(rays<float>(npy("'>f4'", {1, 6}, big(0.1f, 1.f, 2.f, 3.f, 4.f, 5.f)))[0].origin.x,
            0.1f);
  EXPECT_EQ(rays<double>(npy("'>f8'", {1, 6}, big(0.1, 1., 2., 3., 4., 5.)))[0].origin.x, 0.1);
}

TEST_F(IoRays, any_piece_of_a_large_file_can_be_read) {
  constexpr std::uint64_t kRows = 20'000;
  std::vector<double> numbers(kRows * 6);
  std::iota(numbers.begin(), numbers.end(), 0.0);
  const RayFile file(npy("'<f8'", {kRows, 6},
                         {reinterpret_cast<const char*>(numbers.data()), numbers.size() * 8}));
  std::vector<Ray<double>> piece(12'345);
  file.read(7'000, std::span(piece));
  for (std::size_t i = 0; i < piece.size(); ++i) {
    ASSERT_EQ(piece[i].origin.x, static_cast<double>(6 * (7'000 + i)));
    ASSERT_EQ(piece[i].direction.z, static_cast<double>(6 * (7'000 + i) + 5));
  }
  EXPECT_NE(error_of([&] { file.read(kRows - 1, std::span(piece)); }, ErrorCode::InvalidArgument),
            "");
}

TEST_F(IoRays, doubles_become_floats_by_rounding_to_nearest) {
  const auto path = npy("'<f8'", {1, 6}, little(0.1, 1., 2., 3., 4., 5.));
  EXPECT_EQ(rays<float>(path)[0].origin.x, 0.1f);
  EXPECT_EQ(error(npy("'<f8'", {2, 6}, std::string(48, '\0') + little(0., 1e39, 2., 3., 4., 5.))),
            "r.npy: row 1: 1e+39 does not fit the range of float: use double precision");
}

TEST_F(IoRays, csv_is_read_with_and_without_titles) {
  for (const char* start : {"", "ox,oy,oz,dx,dy,dz\n", "a, b, c, d, e, f\r\n", "\xef\xbb\xbf",
                            "# ox,oy,oz,dx,dy,dz\n\n", "\"OX\",\"OY\",oz,dx,dy,dz\n"}) {
    std::string text = start;
    text += "0.1,9007199254740993,2,3, 4 ,\t5\r\n\n6,7,8,9,10,nan";
    const std::vector<Ray<double>> d = rays<double>(csv(text));
    ASSERT_EQ(d.size(), 2u) << start;
    EXPECT_EQ(d[0].origin, (Vec3<double>{0.1, 9007199254740992.0, 2}));
    EXPECT_EQ(d[0].direction, (Vec3<double>{3, 4, 5}));
    EXPECT_TRUE(std::isnan(d[1].direction.z));
    EXPECT_EQ(d[1].t_max, kInf);
    EXPECT_FALSE(RayFile(folder_ / "r.csv").single_precision());
  }
  EXPECT_EQ(rays<double>(csv("1,2,3,4,5,6,-inf,8\n"))[0].t_min, -kInf);
}

TEST_F(IoRays, no_rays_at_all_are_fine) {
  EXPECT_EQ(rays<float>(npy("'<f4'", {0, 6}, "")).size(), 0u);
  EXPECT_EQ(rays<float>(csv("ox,oy,oz,dx,dy,dz\n")).size(), 0u);
}

TEST_F(IoRays, points_have_three_columns) {
  write_npy(folder_ / "p.npy", "'<f4'", std::array{std::uint64_t{2}, std::uint64_t{3}},
            little(0.1f, 1.f, 2.f) + little(3.f, 4.f, 5.f));
  const PointFile file(folder_ / "p.npy");
  std::vector<Vec3<double>> points(1);
  file.read(1, std::span(points));
  EXPECT_EQ(points[0], (Vec3<double>{3, 4, 5}));
  EXPECT_TRUE(file.single_precision());
  const PointFile text(folder_.write("p.csv", "x,y,z\n0.1,2,3\n"));
  std::vector<Vec3<float>> floats(1);
  text.read(0, std::span(floats));
  EXPECT_EQ(floats[0], (Vec3<float>{0.1f, 2, 3}));
  EXPECT_NE(error_of([&] {
              PointFile(folder_.write("p.csv", "1,2,3,4,5,6\n"));
            }).find("p.csv:1: points need 3 numbers (x,y,z) between commas, found 6"),
            std::string::npos);
}

TEST_F(IoRays, wrong_arrays_are_told) {
  const std::string columns = "6 or 8 columns (ox oy oz dx dy dz t_min t_max)";
  EXPECT_EQ(error(npy("'<f4'", {1, 7}, std::string(28, '\0'))),
            "r.npy: rays must be a 2-D array of " + columns + ", not of shape (1, 7): reshape it");
  EXPECT_EQ(error(npy("'<f4'", {6}, std::string(24, '\0'))),
            "r.npy: rays must be a 2-D array of " + columns + ", not of shape (6): reshape it");
  EXPECT_EQ(error(npy("'<i8'", {1, 6}, std::string(48, '\0'))),
            "r.npy: rays must be float32 or float64 numbers, not 'i8': convert them with astype");
  EXPECT_EQ(
      error(npy("[('a', '<f4')]", {6}, std::string(24, '\0'))),
      "r.npy: rays must be float32 or float64 numbers, not records: convert them with astype");
  EXPECT_EQ(error(npy("'<f4'", {2, 6}, std::string(47, '\0'))),
            "r.npy: has 175 bytes where its header announces 176: it was cut off, write it again");
  EXPECT_EQ(
      error(npy("'<f4'", {2, 6}, std::string(49, '\0'))),
      "r.npy: has 177 bytes where its header announces 176: it was lengthened, keep one array "
      "in it");
  EXPECT_NE(error(npy("'<f4'", {1ull << 58, 6}, "")), "");
  std::string fortran = contents(npy("'<f4'", {2, 6}, std::string(48, '\0')));
  fortran.replace(fortran.find("False"), 5, "True ");
  EXPECT_EQ(error(folder_.write("f.npy", fortran)),
            "f.npy: the array is in Fortran order: save numpy.ascontiguousarray of it");
  EXPECT_EQ(error(folder_.write("t.npy", "1,2,3,4,5,6\n")),
            "t.npy: is no .npy file of version 1, 2 or 3: write it with numpy.save");
  EXPECT_EQ(error(folder_.write("z.csv", std::string("PK\3\4\0\0", 6))),
            "z.csv: is neither .npy nor .csv: save the rays as one of these");
  EXPECT_EQ(error(folder_ / "none.npy"),
            "none.npy: cannot be opened: No such file or directory: check the name");
}

TEST_F(IoRays, wrong_text_is_told_by_line) {
  const std::string names = "(ox,oy,oz,dx,dy,dz,t_min,t_max) between commas, found ";
  EXPECT_EQ(error(csv("1,2,3,4,5\n")),
            "r.csv:1: rays need 6 or 8 numbers " + names + "5: correct the line");
  EXPECT_EQ(error(csv("ox,oy,oz,dx,dy,dz\n1,2,3,4,5,6\n\n1,2,3,4,5,6,7,8\n")),
            "r.csv:4: rays need 6 numbers like the rows above " + names + "8: correct the line");
  EXPECT_EQ(error(csv("1,2,3,4,5,6\n1,2,x,4,5,6\n")),
            "r.csv:2: column oz: 'x' is no number that fits a double: correct it");
  EXPECT_EQ(error(csv("1,2,3,4,5,1e400\n")),
            "r.csv:1: column dz: '1e400' is no number that fits a double: correct it");
  EXPECT_EQ(error(csv("1;2;3;4;5;6\n7;8;9;1;2;3\n")),
            "r.csv:2: rays need 6 or 8 numbers " + names + "1: correct the line");
  EXPECT_EQ(error(csv("dx,dy,dz,ox,oy,oz\n1,2,3,4,5,6\n")),
            "r.csv:1: the columns are in another order than ox,oy,oz,dx,dy,dz,t_min,t_max: reorder "
            "them");
}

}  // namespace
}  // namespace pierce::io
