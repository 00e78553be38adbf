// SPDX-License-Identifier: Apache-2.0
//
// Tables in .npy files: every number type, order, shape and kind of record, number by number.
#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <numeric>

#include "io/convert_number.h"
#include "io/npy.h"
#include "io/rays.h"
#include "support/io_files.h"

namespace pierce::io {
namespace {

using Shape = std::vector<std::uint64_t>;
using Row = std::vector<double>;
constexpr double kInf = std::numeric_limits<double>::infinity();

std::string with_fortran_order(std::string bytes) {
  return bytes.replace(bytes.find("False"), 5, "True ");
}

class IoNpyTable : public testing::Test {
 protected:
  [[nodiscard]] std::filesystem::path npy(const char* descr, const Shape& shape,
                                          const std::string& bytes, bool fortran = false) const {
    write_npy(folder_ / "r.npy", descr, shape, bytes);
    if (fortran) (void)folder_.write("r.npy", with_fortran_order(contents(folder_ / "r.npy")));
    return folder_ / "r.npy";
  }
  /// The rays as rows of eight.
  template <class Real>
  [[nodiscard]] static std::vector<Row> rows(const RayFile& file) {
    std::vector<Ray<Real>> rays(file.size());
    file.read(0, std::span(rays));
    std::vector<Row> all;
    for (const auto& [o, d, a, b] : rays) all.push_back({o.x, o.y, o.z, d.x, d.y, d.z, a, b});
    return all;
  }
  template <class Real = double>
  [[nodiscard]] static std::vector<Row> rows(const std::filesystem::path& path) {
    return rows<Real>(RayFile(path));
  }
  template <class Real>
  [[nodiscard]] std::string error(const std::filesystem::path& path) const {
    const std::string message = error_of([&] { (void)rows<Real>(path); });
    return message.substr(std::min(message.size(), (folder_ / "").string().size()));
  }
  TempFolder folder_;
};

TEST(IoHalf, all_65536_halves_widen_exactly) {
  for (std::uint32_t bits = 0; bits < 65536; ++bits) {
    const float got = to_float(Half{static_cast<std::uint16_t>(bits)});
    const int exponent = static_cast<int>(bits >> 10 & 31);
    const double mantissa = bits & 1023;
    ASSERT_EQ(std::signbit(got), bits >> 15 == 1) << bits;
    if (exponent == 31) {
      ASSERT_TRUE(mantissa == 0 ? std::isinf(got) : std::isnan(got)) << bits;
    } else {
      const double expected =
          exponent == 0 ? std::ldexp(mantissa, -24) : std::ldexp(1024 + mantissa, exponent - 25);
      ASSERT_EQ(std::abs(static_cast<double>(got)), expected) << bits;
    }
  }
}

TEST_F(IoNpyTable, integers_of_every_size_are_read_exactly) {
  const Row row = {1, 2, 3, 4, 5, 127, 0, kInf};
  const auto numbers = [&]<class Number>(Number) {
    std::string bytes;
    for (std::size_t k = 0; k < 6; ++k) bytes += little(static_cast<Number>(row[k]));
    return bytes;
  };
  const std::pair<const char*, std::string> types[] = {
      {"'|i1'", numbers(std::int8_t{})},  {"'|u1'", numbers(std::uint8_t{})},
      {"'<i2'", numbers(std::int16_t{})}, {"'<u2'", numbers(std::uint16_t{})},
      {"'<i4'", numbers(std::int32_t{})}, {"'<u4'", numbers(std::uint32_t{})},
      {"'<i8'", numbers(std::int64_t{})}, {"'<u8'", numbers(std::uint64_t{})},
      {"'<f4'", numbers(float{})},        {"'<f8'", numbers(double{})}};
  for (const auto& [type, bytes] : types) {
    const auto path = npy(type, {1, 6}, bytes);
    EXPECT_EQ(rows<double>(path), std::vector<Row>{row}) << type;
    EXPECT_EQ(rows<float>(path), std::vector<Row>{row}) << type;
    const bool whole = type[2] != 'f', small = type[3] < '4' || (type[2] == 'f' && type[3] == '4');
    EXPECT_EQ(RayFile(path).whole_numbers(), whole) << type;
    EXPECT_EQ(RayFile(path).single_precision(), small) << type;
  }
  EXPECT_EQ(rows(npy("'>i2'", {1, 6},
                     big(std::int16_t{-2}, std::int16_t{258}, std::int16_t{3}, std::int16_t{4},
                         std::int16_t{5}, std::int16_t{6})))[0],
            (Row{-2, 258, 3, 4, 5, 6, 0, kInf}));
  EXPECT_EQ(rows(npy("'>f2'", {1, 6},
                     std::string("\x3c\x00\x00\x01\xc0\x00\x7c\x00\x3c\x01\x80\x00", 12)))[0],
            (Row{1, 0x1p-24, -2, kInf, 1 + 0x1p-10, -0.0, 0, kInf}));
}

template <class Number>
std::string six(Number last) {
  const Number zero = 0;
  return little(zero, zero, zero, zero, zero, last);
}

TEST_F(IoNpyTable, integers_that_are_no_numbers_of_the_type_are_refused_by_row) {
  using std::int64_t, std::uint64_t, std::int32_t;
  const int64_t kLeast = std::numeric_limits<int64_t>::min();
  const std::pair<int64_t, bool> in_double[] = {{int64_t{1} << 53, true},
                                                {(int64_t{1} << 53) + 1, false},
                                                {-(int64_t{1} << 53) - 1, false},
                                                {(int64_t{1} << 53) + 2, true},
                                                {kLeast, true},
                                                {kLeast + 1, false},
                                                {-(kLeast + 1), false},
                                                {int64_t{1} << 62, true}};
  for (const auto& [number, fits] : in_double) {
    const auto path = npy("'<i8'", {2, 6}, six(int64_t{0}) + six(number));
    EXPECT_EQ(error<double>(path),
              fits ? ""
                   : "r.npy: row 1: " + std::to_string(number) +
                         " is an integer that double cannot hold exactly: round it with "
                         "astype('f8')");
  }
  const uint64_t kMost = std::numeric_limits<uint64_t>::max();
  EXPECT_NE(error<double>(npy("'<u8'", {1, 6}, six(kMost))), "");
  EXPECT_EQ(error<double>(npy("'<u8'", {1, 6}, six(kMost - 2047))), "");
  EXPECT_NE(error<float>(npy("'<u8'", {1, 6}, six(kMost - 2047))), "");
  EXPECT_EQ(error<float>(npy("'<i4'", {1, 6}, six(int32_t{1 << 24}))), "");
  EXPECT_EQ(error<float>(npy("'<i4'", {1, 6}, six(std::numeric_limits<int32_t>::min()))), "");
  EXPECT_NE(error<float>(npy("'<i4'", {1, 6}, six(std::numeric_limits<int32_t>::max()))), "");
  EXPECT_EQ(error<float>(npy("'<i4'", {1, 6}, six(int32_t{(1 << 24) + 1}))),
            "r.npy: row 0: 16777217 is an integer that float cannot hold exactly: use double "
            "precision, or round it with astype");
}

// Numbers 1, 2, 3 ... where C order has them; and the same array in Fortran order.
std::string counting(const Shape& shape, bool fortran) {
  std::uint64_t count = 1;
  for (const std::uint64_t n : shape) count *= n;
  std::vector<double> numbers(count);
  for (std::uint64_t i = 0; i < count; ++i) {
    std::uint64_t rest = i, place = 0, stride = fortran ? 1 : count;
    if (fortran) {
      std::uint64_t scale = count;  // the first index of C order is the slowest
      for (const std::uint64_t n : shape) {
        scale /= n;
        place += rest / scale * stride;
        rest %= scale;
        stride *= n;
      }
    } else {
      place = i;
    }
    numbers[place] = static_cast<double>(i + 1);
  }
  return {reinterpret_cast<const char*>(numbers.data()), count * sizeof(double)};
}

TEST_F(IoNpyTable, shapes_and_orders_mean_the_same_rows) {
  const Shape shapes[] = {{12, 6},      {12, 8}, {1, 6},    {12, 2, 3}, {3, 4, 6}, {4, 3, 2, 3},
                          {2, 3, 2, 8}, {6, 6},  {1, 2, 3}, {2, 2, 3},  {3000, 6}};
  for (const Shape& shape : shapes) {
    const std::size_t wide = shape.back() == 8 ? 8 : 6;
    for (const bool fortran : {false, true}) {
      const auto path = npy("'<f8'", shape, counting(shape, fortran), fortran);
      const RayFile file(path);
      const std::vector<Row> got = rows<double>(file);
      double next = 1;
      for (const Row& row : got) {
        for (std::size_t k = 0; k < wide; ++k) ASSERT_EQ(row[k], next++) << fortran;
        ASSERT_EQ(row[7] == kInf, wide == 6);
      }
      const std::uint64_t numbers =
          std::accumulate(shape.begin(), shape.end(), std::uint64_t{1}, std::multiplies<>());
      EXPECT_EQ(got.size() * wide, numbers);
      const bool flattened = shape.size() > (shape.back() == 3 ? 3u : 2u);
      EXPECT_EQ(file.remarks().size(), flattened ? 1u : 0u);
    }
  }
  const auto path = npy("'<f8'", {3, 4, 6}, counting({3, 4, 6}, false));
  EXPECT_EQ(RayFile(path).remarks(),
            std::vector{path.string() + ": the rays of shape (3, 4, 6) are read as 12 rows, the "
                                        "last of the first 2 indices fastest"});
  EXPECT_EQ(rows(npy("'<f8'", {0, 6}, "", true)).size(), 0u);
  EXPECT_EQ(rows(npy("'<f8'", {4, 0, 6}, "", true)).size(), 0u);
}

TEST_F(IoNpyTable, any_piece_of_an_array_in_fortran_order_can_be_read) {
  const Shape shape = {7, 5, 6};
  const RayFile file(npy("'<f8'", shape, counting(shape, true), true));
  for (std::uint64_t first = 0; first < 35; ++first) {
    std::vector<Ray<float>> part(35 - first);
    file.read(first, std::span(part));
    for (std::size_t i = 0; i < part.size(); ++i) {
      ASSERT_EQ(part[i].origin.x, static_cast<float>(6 * (first + i) + 1));
    }
  }
}

TEST_F(IoNpyTable, fields_are_found_by_name) {
  const std::string plain =
      little(6.f, 5.f, 4.f) + little(9., 3., 2., 1.) + little(std::int16_t{-7});
  const auto path =
      npy("[('dz', '<f4'), ('DY', '<f4'), ('dx', '<f4'), ('tmax', '<f8'), ('oz', '<f8'), ('oy', "
          "'<f8'), "
          "('ox', '<f8'), ('t_min', '<i2')]",
          {2}, plain + plain);
  EXPECT_EQ(rows(path), (std::vector<Row>(2, {1, 2, 3, 4, 5, 6, -7, 9})));
  EXPECT_FALSE(RayFile(path).single_precision());
  EXPECT_FALSE(RayFile(path).whole_numbers());
  EXPECT_TRUE(RayFile(path).remarks().empty());

  const auto triples =
      npy("[('direction', '>f4', (3,)), ('', '|V3'), ('id', '<u4'), ('origin', "
          "'<f4', (3,)), ('t_max', '<f4')]",
          {1}, big(4.f, 5.f, 6.f) + "???" + little(77u) + little(1.f, 2.f, 3.f, 9.f));
  EXPECT_EQ(rows<float>(triples), (std::vector<Row>{{1, 2, 3, 4, 5, 6, 0, 9}}));
  EXPECT_TRUE(RayFile(triples).single_precision());
  EXPECT_EQ(RayFile(triples).remarks(),
            std::vector{triples.string() + ": fields that are not used: 'id'"});

  const char* origin = "[('origin', '<f8', (3,)), ('direction', '<f8', (3,))]";
  EXPECT_EQ(rows(npy(origin, {2, 3}, counting({36}, false))).size(), 6u);
  EXPECT_EQ(rows(npy(origin, {2, 3}, counting({36}, false)))[3][0], 19);
  EXPECT_EQ(rows(npy(origin, {2, 3}, counting({36}, false), true))[1][0], 13);  // [0, 1]
}

TEST_F(IoNpyTable, fields_that_are_no_rays_are_told) {
  const std::string need = ": rays need ox,oy,oz,dx,dy,dz[,t_min,t_max], by these names";
  EXPECT_EQ(error<float>(npy("[('a', '<f4')]", {1}, std::string(4, '\0'))),
            "r.npy: the fields: nothing is named ox,oy,oz,dx,dy,dz" + need);
  EXPECT_EQ(error<float>(npy("[('origin', '<f4', (3,)), ('dx', '<f4'), ('oy', '<f4')]", {1},
                             std::string(20, '\0'))),
            "r.npy: the fields: oy is there twice: remove one or name it otherwise");
  EXPECT_EQ(error<float>(npy("[('origin', '<f4', (4,))]", {1}, std::string(16, '\0'))),
            "r.npy: the fields: 'origin' holds 4 numbers in place of 3: write it with 3");
  EXPECT_EQ(error<float>(
                npy("[('origin', '<f4', (3,)), ('direction', '|S3')]", {1}, std::string(15, '\0'))),
            "r.npy: the fields: 'direction' holds 1 numbers in place of 3: write it with 3");
  EXPECT_EQ(error<float>(npy("[('origin', '<f4', (3,)), ('direction', '|S1', (3,))]", {1},
                             std::string(15, '\0'))),
            "r.npy: rays must be float16, float32, float64 or integers, not 'S1': convert them "
            "with astype");
}

TEST_F(IoNpyTable, points_too_come_in_every_form) {
  const auto points = [&](const std::filesystem::path& path) {
    const PointFile file(path);
    std::vector<Vec3<double>> all(file.size());
    file.read(0, std::span(all));
    return all;
  };
  const std::vector<Vec3<double>> expected = {{1, 2, 3}, {4, 5, 6}};
  EXPECT_EQ(points(npy("'<f8'", {2, 3}, counting({2, 3}, true), true)), expected);
  EXPECT_EQ(points(npy("'<f8'", {2, 1, 3}, counting({6}, false))), expected);
  EXPECT_EQ(points(npy("[('z', '<f8'), ('hit', '|b1'), ('y', '<f8'), ('X', '<f8')]", {1},
                       little(3.) + "?" + little(2., 1.))),
            (std::vector<Vec3<double>>{{1, 2, 3}}));
  EXPECT_EQ(points(npy("[('point', '<f8', (3,))]", {2}, counting({6}, false))), expected);
}

}  // namespace
}  // namespace pierce::io
