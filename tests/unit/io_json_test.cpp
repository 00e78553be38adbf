// SPDX-License-Identifier: Apache-2.0
//
// JSON: what is written is what JSON allows, whatever the text and the numbers.
#include <gtest/gtest.h>

#include <cstdint>
#include <limits>

#include "io/json_writer.h"

namespace pierce::io {
namespace {

constexpr double kInf = std::numeric_limits<double>::infinity();

std::string quoted(std::string_view text) {
  JsonWriter json;
  json.value("", text);
  const std::string all = json.text();
  return all.substr(1, all.size() - 3);  // without the quotes and the end of the line
}

TEST(IoJson, objects_and_arrays_have_their_commas) {
  JsonWriter json;
  json.open_object();
  json.value("finite", 0.5);
  json.value("infinite", kInf);
  json.values("list", std::vector<double>{1, -kInf, std::numeric_limits<double>::quiet_NaN()});
  json.value("yes", true);
  json.value("text", "words");
  json.open_array("empty");
  json.close_array();
  json.open_array("nested");
  json.open_object();
  json.close_object();
  json.value("", std::uint64_t{18446744073709551615u});
  json.close_array();
  json.close_object();
  EXPECT_EQ(json.text(),
            "{\n  \"finite\": 0.5,\n  \"infinite\": null,\n  \"list\": [1, null, null],\n"
            "  \"yes\": true,\n  \"text\": \"words\",\n  \"empty\": [],\n"
            "  \"nested\": [\n    {},\n    18446744073709551615\n  ]\n}\n");
}

TEST(IoJson, fractions_read_back_exactly_or_have_so_many_digits) {
  JsonWriter exact;
  exact.values("", std::vector<double>{0.1, 1.0 / 3, 5e-324, -0.0, 1e300});
  EXPECT_EQ(exact.text(), "[0.1, 0.3333333333333333, 5e-324, -0, 1e+300]\n");
  JsonWriter floats;
  floats.values("", std::vector<float>{0.1f, 1.0f / 3});
  EXPECT_EQ(floats.text(), "[0.1, 0.33333334]\n");
  JsonWriter short_ones(3);
  short_ones.values("", std::vector<double>{1.0 / 3, 2e9 / 3});
  EXPECT_EQ(short_ones.text(), "[0.333, 6.67e+08]\n");
}

TEST(IoJson, any_bytes_make_a_valid_string) {
  EXPECT_EQ(quoted("a\"b\\c/d"), "a\\\"b\\\\c/d");
  EXPECT_EQ(quoted(std::string_view("\n\t\0\x1f\x7f", 5)), "\\u000a\\u0009\\u0000\\u001f\\u007f");
  for (const char* good : {"\xc3\xa4", "\xe2\x82\xac", "\xf0\x9f\x90\x87", "\xf4\x8f\xbf\xbf",
                           "\xed\x9f\xbf", "\xee\x80\x80", "\xe0\xa0\x80", "\xf0\x90\x80\x80"}) {
    EXPECT_EQ(quoted(good), good);
  }
  // Cut off, bare continuation, longer than needed, surrogates, beyond the last character.
  EXPECT_EQ(quoted("\xc3"), "\\ufffd");
  EXPECT_EQ(quoted("\xa4x"), "\\ufffdx");
  EXPECT_EQ(quoted("\xc0\x80"), "\\ufffd\\ufffd");
  EXPECT_EQ(quoted("\xe0\x9f\x80"), "\\ufffd\\ufffd\\ufffd");
  EXPECT_EQ(quoted("\xed\xa0\x80"), "\\ufffd\\ufffd\\ufffd");
  EXPECT_EQ(quoted("\xf4\x90\x80\x80"), "\\ufffd\\ufffd\\ufffd\\ufffd");
  EXPECT_EQ(quoted("\xf0\x8f\xbf\xbf"), "\\ufffd\\ufffd\\ufffd\\ufffd");
  EXPECT_EQ(quoted("\xff\xc3\""), "\\ufffd\\ufffd\\\"");
}

}  // namespace
}  // namespace pierce::io
