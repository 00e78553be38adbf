// SPDX-License-Identifier: Apache-2.0
//
// .npz: the check sum by its published value, the archive byte by byte, and answers as columns.
// That Python reads it is shown by the tests of the tool.
#include "io/hits.h"
#include "io/npy.h"
#include "io/npz.h"
#include "support/io_files.h"

namespace pierce::io {
namespace {

std::uint32_t slow_crc32(std::string_view bytes) {
  std::uint32_t crc = 0xffffffff;
  for (const char c : bytes) {
    crc ^= static_cast<unsigned char>(c);
    for (int bit = 0; bit < 8; ++bit) crc = crc >> 1 ^ (crc % 2 == 1 ? 0xedb88320u : 0u);
  }
  return ~crc;
}

TEST(IoNpz, check_sums_are_right_in_one_piece_or_many) {
  EXPECT_EQ(crc32(0, "123456789"), 0xcbf43926u);
  EXPECT_EQ(crc32(0, ""), 0u);
  std::string bytes;
  for (unsigned i = 0; i < 100; ++i) {
    bytes += static_cast<char>(i * i * 7 + 3);
    ASSERT_EQ(crc32(0, bytes), slow_crc32(bytes)) << i;
    ASSERT_EQ(crc32(crc32(0, bytes.substr(0, i / 3)), bytes.substr(i / 3)), slow_crc32(bytes)) << i;
  }
}

TEST(IoNpz, an_archive_has_the_bytes_of_the_format) {
  const TempFolder folder;
  OutputFile file(folder / "a.zip");
  SpoolFile data(folder / "", "a.zip");
  data.write("data");
  NpzWriter archive(file);
  archive.add("t", "head", data);
  archive.finish();
  file.commit();
  const std::uint16_t none = 0, version = 20, version64 = 45, name = 5;
  const std::string sizes = little(crc32(0, "headdata"), 8u, 8u) + little(name, none);
  const std::string local = "PK\x03\x04" + little(version, none, none, none, std::uint16_t{33}) +
                            sizes + "t.npy" + "headdata";
  const std::string central = "PK\x01\x02" + little(version64, version, none, none, none) +
                              little(std::uint16_t{33}) + sizes + little(none, none, none) +
                              little(0u, 0u) + "t.npy";
  EXPECT_EQ(contents(folder / "a.zip"), local + central + "PK\x05\x06" +
                                            little(none, none, std::uint16_t{1}, std::uint16_t{1}) +
                                            little(static_cast<std::uint32_t>(central.size()),
                                                   static_cast<std::uint32_t>(local.size())) +
                                            little(none));
}

TEST(IoNpz, what_32_bits_cannot_count_has_its_64_bits_elsewhere) {
  const TempFolder folder;
  OutputFile file(folder / "a.zip");
  SpoolFile data(folder / "", "a.zip");
  data.write("data");
  NpzWriter archive(file, 8);  // both the sizes and the place of the second are too large
  archive.add("a", "", data);
  archive.add("b", "head", data);
  archive.finish();
  file.commit();
  const std::string bytes = contents(folder / "a.zip");
  const std::uint16_t tag = 1, sixteen = 16, twenty_four = 24, version64 = 45, none = 0;
  const std::uint64_t size = 8, place = bytes.find("PK\x03\x04", 4);
  EXPECT_NE(bytes.find(little(~0u, ~0u) + little(std::uint16_t{5}, std::uint16_t{20}) + "b.npy" +
                       little(tag, sixteen) + little(size, size) + "headdata"),
            std::string::npos);
  const std::string central = "b.npy" + little(tag, twenty_four) + little(size, size, place);
  const std::uint64_t start = bytes.find("PK\x01\x02");
  const std::uint64_t end = bytes.find("PK\x06\x06");
  EXPECT_EQ(bytes.substr(end),
            "PK\x06\x06" + little(std::uint64_t{44}) + little(version64, version64) +
                little(std::uint64_t{0}, std::uint64_t{2}, std::uint64_t{2}, end - start, start) +
                "PK\x06\x07" + little(0u) + little(end) + little(1u) + "PK\x05\x06" + little(0u) +
                little(std::uint16_t{2}, std::uint16_t{2}) + little(~0u, ~0u) + little(none));
  EXPECT_EQ(bytes.substr(end - central.size(), central.size()), central);
}

TEST(IoNpz, answers_are_columns) {
  const TempFolder folder;
  ClosestWriter<double> file(folder / "h.NPZ");
  for (int i = 0; i < 3; ++i) {
    file.append(std::array{Hit<double>{double(i), 0.25, 0.5, 0.25, 0, 7, Facing::Back}});
  }
  EXPECT_EQ(folder.files(), 1u);  // the columns wait without a name
  file.finish();
  EXPECT_EQ(folder.files(), 1u);
  const std::string bytes = contents(folder / "h.NPZ");
  for (const char* name :
       {"t.npy", "u.npy", "v.npy", "w.npy", "geometry.npy", "triangle.npy", "facing.npy"}) {
    EXPECT_NE(bytes.find(name), std::string::npos) << name;
  }
  const std::string t = make_npy_header("'<f8'", std::array{std::uint64_t{3}}) + little(0., 1., 2.);
  EXPECT_NE(bytes.find("t.npy" + t), std::string::npos);
  const std::string facing =
      make_npy_header("'|u1'", std::array{std::uint64_t{3}}) + std::string("\1\1\1");
  EXPECT_NE(bytes.find("facing.npy" + facing), std::string::npos);
}

TEST(IoNpz, unfinished_ones_leave_nothing) {
  const TempFolder folder;
  {
    AnyWriter file(folder / "h.npz");
    file.append(std::array<std::uint8_t, 2>{0, 1});
  }
  EXPECT_EQ(folder.files(), 0u);
}

}  // namespace
}  // namespace pierce::io
