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
  for (const char* start : {"", "ox,oy,oz,dx,dy,dz\n", "oX, oy, oz, dx, DY, dz\r\n", "\xef\xbb\xbf",
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

TEST_F(IoRays, names_in_the_title_give_the_order) {
  for (const char* start :
       {"dz,dy,dx,t_max,oz,oy,ox,t_min\n", "dz,dy,dx,TMAX,\"oz\",oy,ox,tmin\r\n"}) {
    const Ray<double> ray = rays<double>(csv(start + std::string("6,5,4,9,3,2,1,-8\n"))).at(0);
    EXPECT_EQ(ray.origin, (Vec3<double>{1, 2, 3}));
    EXPECT_EQ(ray.direction, (Vec3<double>{4, 5, 6}));
    EXPECT_EQ(ray.t_min, -8);
    EXPECT_EQ(ray.t_max, 9);
  }
  // Either end of the range by itself.
  EXPECT_EQ(rays<double>(csv("ox,oy,oz,dx,dy,dz,t_max\n1,2,3,4,5,6,7\n"))[0].t_max, 7);
  EXPECT_EQ(rays<double>(csv("tmin,ox,oy,oz,dx,dy,dz\n7,1,2,3,4,5,6\n"))[0].t_min, 7);
  EXPECT_EQ(rays<double>(csv("tmin,ox,oy,oz,dx,dy,dz\n7,1,2,3,4,5,6\n"))[0].t_max, kInf);
  const auto path = csv("id,oz,oy,ox,\"say, what\",dx,dy,dz\nfirst,3,2,1,\"a, b\",4,5,6\n");
  EXPECT_EQ(rays<float>(path)[0].origin, (Vec3<float>{1, 2, 3}));
  EXPECT_EQ(rays<float>(path)[0].direction, (Vec3<float>{4, 5, 6}));
  EXPECT_EQ(RayFile(path).remarks(),
            std::vector{path.string() + ": columns that are not used: 'id', 'say, what'"});
}

TEST_F(IoRays, numbers_are_no_title_and_titles_no_numbers) {
  const auto path = csv("0,1,2,3,4,5\n6,7,8,9,10,11\n");
  EXPECT_EQ(rays<double>(path).size(), 2u);
  EXPECT_EQ(RayFile(path).remarks(),
            std::vector{path.string() + ": the first line, 0,1,...,5, is read as numbers; if these "
                                        "are titles, name the columns"});
  EXPECT_TRUE(RayFile(csv("0,1,2,3,4,6\n")).remarks().empty());
  const std::string need = ": rays need ox,oy,oz,dx,dy,dz[,t_min,t_max], by these names";
  EXPECT_EQ(error(csv("a,b,c,d,e,f\n1,2,3,4,5,6\n")),
            "r.csv:1: the titles: nothing is named ox,oy,oz,dx,dy,dz" + need);
  EXPECT_EQ(error(csv("\nox,oy,oz,dx,dy,DX\n")),
            "r.csv:2: the titles: dx is there twice: remove one or name it otherwise");
  EXPECT_EQ(error(csv("ox,oy,oz,dx,dy,tmin\n")), "r.csv:1: the titles: nothing is named dz" + need);
  EXPECT_EQ(error(csv("ox,oy,oz,dx,dy,dz,tmin,t_min\n")),
            "r.csv:1: the titles: t_min is there twice: remove one or name it otherwise");
  EXPECT_EQ(error(csv("ox,oy,oz,dx,dy,6\n")),
            "r.csv:1: column ox: 'ox' is no number that fits a double: correct it");
  EXPECT_EQ(error(csv("1,2,3,4,5,6\nox,oy,oz,dx,dy,dz\n")),
            "r.csv:2: column ox: 'ox' is no number that fits a double: correct it");
  for (const auto& [between, name] :
       {std::pair{"\t", "tabs"}, {";", "semicolons"}, {" ", "blanks"}}) {
    EXPECT_EQ(error(csv(replaced("1,2,3,4,5,6\n1,2,3\n", ',', between))),
              std::string("r.csv:2: expected 6 fields like the rows above, found 3 between ") +
                  name + ": correct the line");
  }
}

std::string utf16(const std::string& ascii, bool big) {
  std::string out = big ? "\xfe\xff" : "\xff\xfe";
  for (const char c : ascii) out += big ? std::string{'\0', c} : std::string{c, '\0'};
  return out;
}

// One row in all the ways that programs write it.
TEST_F(IoRays, whatever_stands_between_numbers_the_points_are_the_same) {
  const std::vector<std::string> numbers = {"0.5", "-1.25e2", "3"};
  const std::vector<std::string> titles = {"z", "X [m]", "y"};
  const std::string separators[] = {",", ";", "\t", " ", "  \t ", " , ", " ; "};
  int variants = 0;
  for (const std::string& separator : separators) {
    for (const char* end : {"\n", "\r\n", "\r"}) {
      for (const bool titled : {true, false}) {
        for (const char* quote : {"", "\""}) {
          for (const bool comma : {true, false}) {
            for (const bool trailing : {true, false}) {
              const bool is_comma = separator.find(',') != separator.npos;
              if (comma && is_comma && *quote == '\0') continue;  // cannot be told apart
              if (titled && separator.find_first_of(",;\t") == separator.npos && *quote == '\0')
                continue;  // a title in two words
              std::string text;
              const auto add = [&](const std::vector<std::string>& fields, bool decimals) {
                for (std::size_t k = 0; k < 3; ++k) {
                  std::string field = fields[k];
                  if (decimals && comma) field = replaced(field, '.', ",");
                  text += (k > 0 ? separator : "") + (quote + field + quote);
                }
                text += (trailing ? separator : "") + end;
              };
              if (titled) add(titles, false);
              add(numbers, true);
              text += end;
              add(numbers, true);
              for (const std::string& bytes :
                   {text, "\xef\xbb\xbf" + text, utf16(text, false), utf16(text, true),
                    "# a comment" + std::string(end) + text}) {
                const PointFile file(folder_.write("p.csv", bytes));
                ASSERT_EQ(file.size(), 2u) << text;
                std::vector<Vec3<double>> points(2);
                file.read(0, std::span(points));
                const Vec3<double> want =
                    titled ? Vec3<double>{-125, 3, 0.5} : Vec3<double>{0.5, -125, 3};
                ASSERT_EQ(points[0], want) << text;
                ASSERT_EQ(points[1], want) << text;
                ASSERT_EQ(file.remarks().size(), comma ? 1u : 0u) << text;
                ++variants;
              }
            }
          }
        }
      }
    }
  }
  EXPECT_GT(variants, 1000);
}

TEST_F(IoRays, a_first_row_is_a_title_only_if_it_looks_like_one) {
  const auto refused = [&](const std::string& text) {
    return error_of([&] { PointFile(folder_.write("p.csv", text)); });
  };
  for (const char* text : {"0.5|0.5|0.5\n", "0.5:0.5:0.5\n", "1,5,2,5,3,5\n", "a b c\n1 2 3\n",
                           "0.5/0.5/0.5\n", "(1,2,3)\n", "[1 2 3]\n", "1_2_3\n", "x\n1\n",
                           "none,none,none\n1,2,3\n", "0.5,,0.5\n", "0x1,0x2,0x3\n"}) {
    EXPECT_NE(refused(text), "") << text;
  }
  const auto size = [&](const std::string& text) {
    return PointFile(folder_.write("p.csv", text)).size();
  };
  EXPECT_EQ(size("sep=;\n1;2;3\n"), 1u);
  EXPECT_EQ(size("//X Y Z R G B\n1 2 3 255 0 0\n"), 1u);  // CloudCompare
  EXPECT_EQ(size(",x,y,z\n0,1,2,3\n1,4,5,6\n"), 2u);      // pandas, with its index
  EXPECT_EQ(size("x,y,z,7\n1,2,3,4\n"), 1u);
  EXPECT_EQ(PointFile(folder_.write("p.csv", "0.0;1.0;2.0\n")).remarks().size(), 0u);
  EXPECT_EQ(PointFile(folder_.write("p.csv", "0;1;2\n")).remarks().size(), 1u);
  EXPECT_EQ(PointFile(folder_.write("p.csv", "x,y,z\n")).remarks(),
            std::vector{(folder_ / "p.csv").string() + ": holds no points"});
}

TEST_F(IoRays, rows_in_memory_are_rays) {
  const RayFile file({0.5, 1, 2, 3, 4, 5, -kInf, 7, 1, 1, 1, 1, 1, 1, 0, kInf}, "--ray");
  EXPECT_EQ(file.size(), 2u);
  EXPECT_TRUE(file.single_precision());
  std::vector<Ray<float>> out(2);
  file.read(0, std::span(out));
  EXPECT_EQ(out[0].origin, (Vec3<float>{0.5, 1, 2}));
  EXPECT_EQ(out[0].t_min, -std::numeric_limits<float>::infinity());
  EXPECT_EQ(out[1].t_max, std::numeric_limits<float>::infinity());
  EXPECT_FALSE(PointFile({0.1, 0, 0}, "--point").single_precision());
}

TEST_F(IoRays, wrong_arrays_are_told) {
  const std::string shape =
      "r.npy: rays must be an array of 6 or 8 columns (ox,oy,oz,dx,dy,dz[,t_min,t_max]), of shape "
      "(n, 2, 3), or of records with these names, not of shape (";
  EXPECT_EQ(error(npy("'<f4'", {1, 7}, std::string(28, '\0'))), shape + "1, 7): reshape it");
  EXPECT_EQ(error(npy("'<f4'", {6}, std::string(24, '\0'))), shape + "6): reshape it");
  EXPECT_EQ(error(npy("'<f4'", {2, 3}, std::string(24, '\0'))), shape + "2, 3): reshape it");
  EXPECT_EQ(error(npy("'<f4'", {}, std::string(4, '\0'))), shape + "): reshape it");
  EXPECT_EQ(error(npy("'<c8'", {1, 6}, std::string(48, '\0'))),
            "r.npy: rays must be float16, float32, float64 or integers, not 'c8': convert them "
            "with astype");
  for (const char* type :
       {"'|b1'", "'<f1'", "'<f16'", "'<i16'", "'<i3'", "'<f0'", "'|O8'", "'<M8'"}) {
    EXPECT_NE(error(npy(type, {0, 6}, "")), "") << type;
  }
  EXPECT_EQ(error(npy("'<f4'", {2, 6}, std::string(47, '\0'))),
            "r.npy: has 175 bytes where its header announces 176: it was cut off, write it again");
  EXPECT_EQ(
      error(npy("'<f4'", {2, 6}, std::string(49, '\0'))),
      "r.npy: has 177 bytes where its header announces 176: it was lengthened, keep one array "
      "in it");
  EXPECT_NE(error(npy("'<f4'", {1ull << 58, 6}, "")), "");
  EXPECT_EQ(error(folder_.write("t.npy", "1,2,3,4,5,6\n")),
            "t.npy: is no .npy file of version 1, 2 or 3: write it with numpy.save");
  EXPECT_EQ(error(folder_.write("z.csv", std::string("XY\3\4\0\0", 6))),
            "z.csv: is neither .npy nor .csv: save the rays as one of these");
  EXPECT_EQ(error(folder_.write("z.npz", std::string("PK\3\4\0\0", 6))),
            "z.npz: is no ZIP archive that can be read ('Not a zip archive'): get it again");
  EXPECT_EQ(error(folder_ / "none.npy"),
            "none.npy: cannot be opened: No such file or directory: check the name");
}

TEST_F(IoRays, wrong_text_is_told_by_line) {
  const std::string wrong =
      "rays need 6 or 8 numbers (ox,oy,oz,dx,dy,dz[,t_min,t_max]) between "
      "commas, found ";
  const std::string cure = ": correct the line, or name the columns in a first line";
  EXPECT_EQ(error(csv("1,2,3,4,5\n")), "r.csv:1: " + wrong + "5" + cure);
  EXPECT_EQ(error(csv("1 2 3 4 5\n")), "r.csv:1: " + wrong + "5" + cure);
  EXPECT_EQ(error(csv("nothing\n")), "r.csv:1: " + wrong + "1" + cure);
  EXPECT_EQ(error(csv("1;2;3;4;5\n")), "r.csv:1: " + wrong + "5" + cure);
  EXPECT_EQ(error(csv("ox;oy;oz;dx;dy;dz\n1;2;3;4;5\n")),
            "r.csv:2: expected 6 fields like the titles above, found 5 between semicolons: correct "
            "the line");
  EXPECT_EQ(error(csv("0,5;1;2;3;4;5\n0.5;1;2;3;4;5\n")),
            "r.csv:2: '0.5' has a decimal point, numbers above have commas: write all with points");
  EXPECT_EQ(error(csv("0,5,1,5,2,5,3,5,4,5,5,5\n")),
            "r.csv:1: " + wrong + "12" + cure +
                "; if commas are decimal signs, put semicolons between the numbers");
  EXPECT_EQ(error(csv("0.5 1 2 3 4 1,234.5\n")), "r.csv:1: " + wrong + "2" + cure);
  EXPECT_EQ(error(csv("ox,oy,oz,dx,dy,dz\n1,2,3,4,5,6\n\n1,2,3,4,5,6,7,8\n")),
            "r.csv:4: expected 6 fields like the titles above, found 8: correct the line");
  EXPECT_EQ(error(csv("1,2,3,4,5,6\n1,2,3,4,5\n")),
            "r.csv:2: expected 6 fields like the rows above, found 5: correct the line");
  EXPECT_EQ(error(csv("1,2,3,4,5,6\n1,2,x,4,5,6\n")),
            "r.csv:2: column oz: 'x' is no number that fits a double: correct it");
  EXPECT_EQ(error(csv("1,2,3,4,5,1e400\n")),
            "r.csv:1: column dz: '1e400' is no number that fits a double: correct it");
}

std::vector<Vec3<double>> points_of(const std::filesystem::path& path) {
  const PointFile file(path);
  std::vector<Vec3<double>> out(file.size());
  file.read(0, std::span(out));
  return out;
}

TEST_F(IoRays, titles_in_a_comment_are_meant) {
  for (const char* text : {"# z x y\n3 1 2\n", "# made by hand\n#z,x,y\n3,1,2\n",
                           "% id z x y\n7\t3\t1\t2\n", "# z x y\n# m m m\n3,1,2\n"}) {
    EXPECT_EQ(points_of(csv(text)), (std::vector<Vec3<double>>{{1, 2, 3}})) << text;
  }
  // Not all columns, or another number of them: a comment.
  for (const char* text : {"# z y\n1 2 3\n", "# z y x w\n1,2,3\n", "# x, y: z\n1 2 3\n"}) {
    EXPECT_EQ(points_of(csv(text)), (std::vector<Vec3<double>>{{1, 2, 3}})) << text;
  }
}

TEST_F(IoRays, point_clouds_in_the_forms_of_others) {
  const std::vector<Vec3<double>> two = {{1, 2, 3}, {4, 5, 6}};
  const auto write = [&](const char* name, const std::string& text) {
    return points_of(folder_.write(name, text));
  };
  EXPECT_EQ(write("a.pts", "2\n1 2 3 9 117 130 149\n4 5 6 9 117 130 149\n"), two);
  EXPECT_EQ(write("a.txt", "2\n1 2 3\n4 5 6\n"), two);
  EXPECT_EQ(write("a.asc", "//X;Y;Z;R\n2\n1;2;3;9\n4;5;6;9\n"), two);
  EXPECT_EQ(write("a.XYZ", "1 2 3 0 0 1\n4 5 6 0 0 1\n"), two);
  EXPECT_EQ(write("a.xyz", "1,2,3\n4,5,6\n" + std::string("\x1a\0\0", 3)), two);
  const std::string ply =
      "ply\nformat ascii 1.0\nelement vertex 2\nproperty double x\n"
      "property double y\nproperty double z\nend_header\n1 2 3\n4 5 6\n";
  EXPECT_EQ(write("a.ply", ply), two);
  EXPECT_EQ(error(folder_.write("r.ply", ply)),
            "r.ply: is a PLY, not a table of rays: save them as .npy or .csv");
  const auto refused = [&](const char* text) {
    return error_of([&] { (void)PointFile(csv(text)); });
  };
  EXPECT_NE(refused("1 2 3 9\n4 5 6 9\n").find("found 4"), std::string::npos);  // an index?
  EXPECT_NE(refused("3\n1 2 3\n4 5 6\n").find("r.csv:1: 3 rows are announced, 2 are there"),
            std::string::npos);
  for (const char* text : {"# .PCD v0.7\nDATA ascii\n1 2 3\n", "PAR1", "[[1,2,3]]", "<html>"}) {
    EXPECT_NE(refused(text).find("is neither .npy nor .csv"), std::string::npos) << text;
  }
}

}  // namespace
}  // namespace pierce::io
