// SPDX-License-Identifier: Apache-2.0
//
// Answers out: the bytes are the fields that the design promises, in its order, and csv reads back.
#include <array>

#include "io/hits.h"
#include "io/npy.h"
#include "support/io_files.h"

namespace pierce::io {
namespace {

// The type as written, and the bytes behind the header.
struct Written {
  std::string descr;
  std::vector<std::uint64_t> shape;
  std::string data;
};
Written written(const std::filesystem::path& path) {
  const std::string bytes = contents(path);
  const NpyHeader header = parse_npy_header(bytes, "written");
  const std::size_t first = bytes.find("'descr': ") + 9;
  return {bytes.substr(first, bytes.find(", 'fortran_order'") - first), header.shape,
          bytes.substr(header.data_offset)};
}

template <class Real>
Hit<Real> hit(Real t, std::uint32_t triangle) {
  return {t, Real(0.1), Real(0.2), Real(0.7), 3, triangle, Facing::Back};
}

template <class Real>
std::string bytes_of(const Hit<Real>& h) {
  // As in memory, with zeros in the gap at the end.
  std::string bytes =
      little(h.t, h.u, h.v, h.w) + little(h.geometry, h.triangle) + little(h.facing);
  bytes.resize(sizeof h);
  return bytes;
}

// Ends the description of a record whose struct ends with a gap.
std::string gap(int bytes) { return ", ('', '|V" + std::to_string(bytes) + "')]"; }

constexpr std::uint32_t kMiss = 4294967295u;

TEST(IoHits, closest_is_one_record_a_ray) {
  const TempFolder folder;
  ClosestWriter<float> file(folder / "f.npy");
  file.append(std::array{hit(1.5f, 7), Hit<float>{}});
  file.append(std::array{hit(-0.0f, 8)});
  file.finish();
  const Written f = written(folder / "f.npy");
  EXPECT_EQ(f.descr,
            "[('t', '<f4'), ('u', '<f4'), ('v', '<f4'), ('w', '<f4'), ('geometry', '<u4'), "
            "('triangle', '<u4'), ('facing', '|u1')" +
                gap(3));
  EXPECT_EQ(f.shape, (std::vector<std::uint64_t>{3}));
  const std::string miss =
      little(std::numeric_limits<float>::infinity(), 0.0f, 0.0f, 0.0f) + little(kMiss, kMiss, 0);
  EXPECT_EQ(f.data.size(), 3 * 28u);
  EXPECT_EQ(f.data, bytes_of(hit(1.5f, 7)) + miss + bytes_of(hit(-0.0f, 8)));

  ClosestWriter<double> doubles(folder / "d.npy");
  doubles.append(std::array{hit(0.1, 9)});
  doubles.finish();
  const Written d = written(folder / "d.npy");
  EXPECT_EQ(d.descr,
            "[('t', '<f8'), ('u', '<f8'), ('v', '<f8'), ('w', '<f8'), ('geometry', '<u4'), "
            "('triangle', '<u4'), ('facing', '|u1')" +
                gap(7));
  EXPECT_EQ(d.data.size(), 48u);
  EXPECT_EQ(d.data, bytes_of(hit(0.1, 9)));
}

TEST(IoHits, all_begins_with_the_ray_counted_over_all_pieces) {
  const TempFolder folder;
  AllWriter<float> file(folder / "a.npy");
  file.append({{0, 2, 2}, {hit(1.0f, 1), hit(2.0f, 2)}});
  file.append({{0, 1}, {hit(3.0f, 3)}});
  file.append({{0}, {}});
  file.finish();
  const Written a = written(folder / "a.npy");
  EXPECT_EQ(a.descr,
            "[('ray', '<u8'), ('t', '<f4'), ('u', '<f4'), ('v', '<f4'), ('w', '<f4'), ('geometry', "
            "'<u4'), ('triangle', '<u4'), ('facing', '|u1')" +
                gap(7));
  EXPECT_EQ(a.shape, (std::vector<std::uint64_t>{3}));
  const auto record = [](std::uint64_t ray, const Hit<float>& h) {
    struct Record {
      std::uint64_t ray;
      Hit<float> hit;
    };
    std::string bytes = little(ray) + bytes_of(h);
    bytes.resize(sizeof(Record));
    return bytes;
  };
  EXPECT_EQ(a.data.size(), 3 * 40u);
  EXPECT_EQ(a.data, record(0, hit(1.0f, 1)) + record(0, hit(2.0f, 2)) + record(2, hit(3.0f, 3)));
}

TEST(IoHits, any_crossings_and_locate_have_their_types) {
  const TempFolder folder;
  AnyWriter any(folder / "any.npy");
  any.append(std::array<std::uint8_t, 3>{0, 1, 2});
  any.finish();
  EXPECT_EQ(written(folder / "any.npy").descr, "'|b1'");
  EXPECT_EQ(written(folder / "any.npy").data, std::string("\0\1\1", 3));

  CrossingsWriter crossings(folder / "c.npy");
  crossings.append(std::array{Crossings{3, -1, true}});
  crossings.finish();
  EXPECT_EQ(written(folder / "c.npy").descr,
            "[('count', '<u4'), ('signed_count', '<i4'), ('origin_on_surface', '|b1')" + gap(3));
  EXPECT_EQ(written(folder / "c.npy").data, little(3, -1) + std::string("\1\0\0\0", 4));

  CountWriter counts(folder / "n.npy");
  counts.append(std::array<std::uint32_t, 2>{7, 0});
  counts.finish();
  EXPECT_EQ(written(folder / "n.npy").descr, "'<u4'");
  EXPECT_EQ(written(folder / "n.npy").data, little(7U, 0U));

  LocationWriter locations(folder / "l.npy");
  locations.append(std::array{Location::Inside, Location::OnSurface, Location::Outside});
  locations.finish();
  EXPECT_EQ(written(folder / "l.npy").descr, "'|i1'");
  EXPECT_EQ(written(folder / "l.npy").data, std::string("\1\0\xff", 3));
}

TEST(IoHits, nearest_is_one_record_a_point) {
  const TempFolder folder;
  const NearestPoint<float> edge{{1, 2, 3}, 0.5f, 0.25f, 0, 0.75f, 4, 5, Feature::EdgeAB};
  NearestWriter<float> file(folder / "n.npy");
  file.append(std::array{edge, NearestPoint<float>{}});
  file.finish();
  const Written n = written(folder / "n.npy");
  EXPECT_EQ(n.descr,
            "[('x', '<f4'), ('y', '<f4'), ('z', '<f4'), ('distance', '<f4'), ('u', '<f4'), "
            "('v', '<f4'), ('w', '<f4'), ('geometry', '<u4'), ('triangle', '<u4'), ('feature', "
            "'|u1')" +
                gap(3));
  const float inf = std::numeric_limits<float>::infinity();
  EXPECT_EQ(n.data, little(1.0f, 2.0f, 3.0f, 0.5f, 0.25f, 0.0f, 0.75f) + little(4U, 5U, 3) +
                        little(0.0f, 0.0f, 0.0f, inf, 0.0f, 0.0f, 0.0f) + little(kMiss, kMiss, 6));
  EXPECT_EQ(n.data.size(), 2 * sizeof edge);
  NearestWriter<double> csv(folder / "n.csv");
  csv.append(std::array{NearestPoint<double>{{0.1, 2, 3}, -0.5, 0.25, 0, 0.75, 4, 5}});
  csv.finish();
  EXPECT_EQ(contents(folder / "n.csv"),
            "x,y,z,distance,u,v,w,geometry,triangle,feature\n0.1,2,3,-0.5,0.25,0,0.75,4,5,6\n");
}

TEST(IoHits, csv_has_the_same_columns_in_the_shortest_exact_form) {
  const TempFolder folder;
  ClosestWriter<float> closest(folder / "c.csv");
  closest.append(std::array{hit(0.1f, 7), Hit<float>{}});
  closest.finish();
  EXPECT_EQ(contents(folder / "c.csv"),
            "t,u,v,w,geometry,triangle,facing\n"
            "0.1,0.1,0.2,0.7,3,7,1\n"
            "inf,0,0,0,4294967295,4294967295,0\n");
  AllWriter<double> all(folder / "a.CSV");
  all.append({{0, 0, 1}, {hit(0x1.999999999999bp-4, 7)}});
  all.finish();
  EXPECT_EQ(contents(folder / "a.CSV"),
            "ray,t,u,v,w,geometry,triangle,facing\n"
            "1,0.10000000000000002,0.1,0.2,0.7,3,7,1\n");
  AnyWriter any(folder / "any.csv");
  any.append(std::array<std::uint8_t, 2>{0, 1});
  any.finish();
  EXPECT_EQ(contents(folder / "any.csv"), "hit\n0\n1\n");
  CrossingsWriter crossings(folder / "x.csv");
  crossings.append(std::array{Crossings{3, -1, true}});
  crossings.finish();
  EXPECT_EQ(contents(folder / "x.csv"), "count,signed_count,origin_on_surface\n3,-1,1\n");
  LocationWriter locations(folder / "l.csv");
  locations.append(std::array{Location::Inside, Location::Outside});
  locations.finish();
  EXPECT_EQ(contents(folder / "l.csv"), "location\n1\n-1\n");
}

TEST(IoHits, no_answers_make_an_empty_array) {
  const TempFolder folder;
  ClosestWriter<float>(folder / "e.npy").finish();
  EXPECT_EQ(written(folder / "e.npy").shape, (std::vector<std::uint64_t>{0}));
  EXPECT_EQ(written(folder / "e.npy").data, "");
}

TEST(IoHits, many_records_survive_the_buffer) {
  const TempFolder folder;
  ClosestWriter<double> file(folder / "m.npy");
  constexpr std::uint32_t kCount = 100'000;
  for (std::uint32_t i = 0; i < kCount; ++i) file.append(std::array{hit(double(i), i)});
  file.finish();
  const Written m = written(folder / "m.npy");
  EXPECT_EQ(m.shape, (std::vector<std::uint64_t>{kCount}));
  ASSERT_EQ(m.data.size(), kCount * 48u);
  for (std::uint32_t i = 0; i < kCount; ++i) {
    ASSERT_EQ(m.data.substr(i * 48u, 48), bytes_of(hit(double(i), i)));
  }
}

TEST(IoHits, an_unfinished_writer_leaves_nothing_and_spares_what_was_there) {
  const TempFolder folder;
  const auto path = folder.write("h.npy", "before");
  {
    ClosestWriter<float> file(path);
    file.append(std::array{hit(1.0f, 1)});
    EXPECT_EQ(folder.files(), 2u);
  }
  EXPECT_EQ(folder.files(), 1u);
  EXPECT_EQ(contents(path), "before");
}

TEST(IoHits, other_endings_are_refused) {
  EXPECT_EQ(
      error_of([] { AnyWriter(std::filesystem::path("hits.txt")); }, ErrorCode::InvalidArgument),
      "hits.txt: unknown kind of output file: end its name in .npy, .npz or "
      ".csv");
}

}  // namespace
}  // namespace pierce::io
