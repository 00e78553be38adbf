// SPDX-License-Identifier: Apache-2.0
//
// .npy headers: all versions, all types, and whatever can be wrong with them.
#include "io/npy.h"
#include "support/io_files.h"

namespace pierce::io {
namespace {

std::string npy(const std::string& dictionary, char version = 1) {
  std::string out = "\x93NUMPY";
  out += version;
  out += '\0';
  const auto length = static_cast<std::uint32_t>(dictionary.size());
  out += version == 1 ? little(static_cast<std::uint16_t>(length)) : little(length);
  return out + dictionary;
}
NpyHeader parse(const std::string& bytes) { return parse_npy_header(bytes, "a.npy"); }
std::string error(const std::string& dictionary) {
  return error_of([&] { (void)parse(npy(dictionary)); });
}

TEST(IoNpy, all_three_versions_are_read) {
  const std::string dictionary = "{'descr': '<f4', 'fortran_order': False, 'shape': (2, 6), }\n";
  for (const char version : {'\1', '\2', '\3'}) {
    const std::string bytes = npy(dictionary, version) + std::string(48, '\0');
    const NpyHeader header = parse(bytes);
    EXPECT_EQ(header.shape, (std::vector<std::uint64_t>{2, 6}));
    EXPECT_EQ(header.count(), 12u);
    EXPECT_EQ(header.element_bytes, 4u);
    EXPECT_FALSE(header.fortran_order);
    EXPECT_FALSE(header.structured);
    EXPECT_EQ(header.data_offset, bytes.size() - 48);
    EXPECT_EQ(npy_header_bytes(bytes.substr(0, 12)), header.data_offset);
  }
}

TEST(IoNpy, spacing_quotes_and_order_of_the_keys_do_not_matter) {
  const NpyHeader header = parse(npy("{\"shape\":(3L,),\n\"fortran_order\" : True,'descr':'>f8'}"));
  EXPECT_EQ(header.shape, (std::vector<std::uint64_t>{3}));
  EXPECT_TRUE(header.fortran_order);
  EXPECT_TRUE(header.fields[0].big_endian);
  EXPECT_EQ(parse(npy("{'descr':'|b1','fortran_order':False,'shape':()}")).count(), 1u);
}

TEST(IoNpy, structured_types_give_fields_with_offsets) {
  const NpyHeader header =
      parse(npy("{'descr': [('ray', '<u8'), ('p', '>f4', (3,)), (('A title', 'hit'), '|b1'), ('', "
                "'|V3')], 'fortran_order': False, 'shape': (7,), }"));
  EXPECT_TRUE(header.structured);
  ASSERT_EQ(header.fields.size(), 4u);
  EXPECT_EQ(header.fields[1].name, "p");
  EXPECT_EQ(header.fields[1].kind, 'f');
  EXPECT_EQ(header.fields[1].repeat, 3u);
  EXPECT_TRUE(header.fields[1].big_endian);
  EXPECT_EQ(header.fields[1].offset, 8u);
  EXPECT_EQ(header.fields[2].name, "hit");
  EXPECT_EQ(header.fields[2].offset, 20u);
  EXPECT_EQ(header.element_bytes, 24u);
}

TEST(IoNpy, broken_headers_are_told) {
  const std::string cure = ": write the file again with numpy.save";
  const std::string rest = "'fortran_order': False, 'shape': (1,)}";
  EXPECT_EQ(error("[]"), "a.npy: bad .npy header: expected '{', found '[]'" + cure);
  EXPECT_EQ(error("{'descr': '<f4'}"),
            "a.npy: bad .npy header: descr, fortran_order or shape is missing" + cure);
  EXPECT_EQ(error("{'descr': 'f', " + rest),
            "a.npy: bad .npy header: unknown number type 'f'" + cure);
  EXPECT_EQ(error("{'descr': '<f4x', " + rest),
            "a.npy: bad .npy header: unknown number type '<f4x'" + cure);
  EXPECT_EQ(error("{'descr': '<f4', 'fortran_order': 0, 'shape': (1,)}"),
            "a.npy: bad .npy header: expected True or False, found '0, 'shape''" + cure);
  EXPECT_EQ(error("{'descr': '<f4', 'fortran_order': False, 'shape': (-1,)}"),
            "a.npy: bad .npy header: expected a count, found '-1,)}'" + cure);
  EXPECT_EQ(error("{'descr': '<f4', 'colour': 1}"),
            "a.npy: bad .npy header: unknown key 'colour'" + cure);
  EXPECT_EQ(error("{'descr': '<f4', 'descr': '<f8', 'fortran_order': False, 'shape': (1,)}"),
            "a.npy: bad .npy header: descr is there twice" + cure);
  EXPECT_EQ(error("{'shape': (2,), 'shape': (1,)}"),
            "a.npy: bad .npy header: shape is there twice" + cure);
  EXPECT_EQ(error("{'descr': '<f4"), "a.npy: bad .npy header: a string has no end" + cure);
  EXPECT_EQ(error("{'descr': [('a', [('b', '<f4')])], " + rest),
            "a.npy: bad .npy header: a structure inside a structure is not read" + cure);
  EXPECT_EQ(error_of([] { (void)parse("rubbish and more"); }),
            "a.npy: is no .npy file of version 1, 2 or 3: write it with numpy.save");
  EXPECT_EQ(error_of([] { (void)parse(npy("{'descr': '<f4'", 4)); }),
            "a.npy: is no .npy file of version 1, 2 or 3: write it with numpy.save");
  EXPECT_EQ(error_of([] { (void)parse(npy("{'descr': '<f4'").substr(0, 20)); }),
            "a.npy: ends inside the .npy header: it was cut off");
}

TEST(IoNpy, shapes_that_64_bits_cannot_count_are_refused) {
  for (const char* shape : {"(4294967296, 4294967296)", "(0, 18446744073709551615)",
                            "(9223372036854775807,)", "(99999999999999999999,)"}) {
    std::string dictionary = "{'descr': '<f4', 'fortran_order': False, 'shape': ";
    dictionary += shape;
    dictionary += '}';
    EXPECT_NE(error(dictionary), "") << shape;
  }
  EXPECT_NE(error("{'descr': [('a', '<f8', (4294967296, 4294967296))], 'fortran_order': False, "
                  "'shape': (1,)}"),
            "");
}

TEST(IoNpy, a_written_header_is_read_back_and_keeps_its_length_for_any_count) {
  std::size_t bytes = 0;
  for (const std::uint64_t count : {0ull, 7ull, 12345678901234ull, 1ull << 57}) {
    const std::string text =
        make_npy_header("[('t', '<f8'), ('facing', '|u1')]", std::array{count});
    const NpyHeader header = parse(text);
    EXPECT_EQ(header.shape, std::vector{count});
    EXPECT_EQ(header.fields[1].name, "facing");
    EXPECT_EQ(header.element_bytes, 9u);
    EXPECT_EQ(header.data_offset, text.size());
    EXPECT_EQ(text.size() % 64, 0u);
    EXPECT_EQ(text.back(), '\n');
    EXPECT_EQ(text.size(), bytes == 0 ? text.size() : bytes);
    bytes = text.size();
  }
}

}  // namespace
}  // namespace pierce::io
