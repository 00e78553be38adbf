// SPDX-License-Identifier: Apache-2.0
//
// Text numbers are the nearest doubles, whatever their length; lines are counted right.
#include <array>
#include <cmath>
#include <cstdlib>
#include <random>

#include "io/text_cursor.h"
#include "io/text_encoding.h"
#include "support/io_files.h"

namespace pierce::io {
namespace {

double parsed(const std::string& text) {
  double value = 0;
  EXPECT_TRUE(parse_number(text, value)) << text;
  return value;
}

TEST(IoText, hard_decimals_are_read_to_the_nearest_double) {
  EXPECT_EQ(parsed("0.1"), 0x1.999999999999ap-4);
  EXPECT_EQ(parsed("2.2250738585072011e-308"), 0x0.fffffffffffffp-1022);
  EXPECT_EQ(parsed("2.2250738585072012e-308"), 0x1p-1022);
  EXPECT_EQ(parsed("4.9e-324"), 0x1p-1074);
  EXPECT_EQ(parsed("2.4703282292062327208e-324"), 0.0);
  EXPECT_EQ(parsed("2.4703282292062327209e-324"), 0x1p-1074);
  EXPECT_EQ(parsed("1.7976931348623157e308"), 0x1.fffffffffffffp1023);
  // 2^53 + 1 lies halfway and goes to the even neighbour; the slightest more goes up
  EXPECT_EQ(parsed("9007199254740993"), 9007199254740992.0);
  EXPECT_EQ(parsed("9007199254740993.00000000000000000000000000000000000000000000000001"),
            9007199254740994.0);
  EXPECT_EQ(parsed("9007199254740992." + std::string(300, '9')), 9007199254740992.0);
  EXPECT_EQ(parsed("9007199254740993" + std::string(280, '0') + "e-280"), 9007199254740992.0);
  EXPECT_EQ(parsed("9007199254740993" + std::string(280, '0') + "1e-281"), 9007199254740994.0);
  EXPECT_EQ(parsed("0." + std::string(400, '0') + "1e401"), 1.0);
  EXPECT_EQ(parsed("1e-400"), 0.0);
}

TEST(IoText, signs_points_and_exponents_may_be_left_out) {
  EXPECT_EQ(parsed("+1.5"), 1.5);
  EXPECT_EQ(parsed("-.5"), -0.5);
  EXPECT_EQ(parsed("5."), 5.0);
  EXPECT_EQ(parsed("1E+2"), 100.0);
  EXPECT_EQ(parsed("0001"), 1.0);
  EXPECT_TRUE(std::signbit(parsed("-0.0")));
}

TEST(IoText, nan_and_inf_are_numbers) {
  EXPECT_TRUE(std::isnan(parsed("nan")));
  EXPECT_TRUE(std::isnan(parsed("-NaN")));
  EXPECT_EQ(parsed("inf"), INFINITY);
  EXPECT_EQ(parsed("-Infinity"), -INFINITY);
}

TEST(IoText, what_is_no_number_is_refused) {
  double value = 0;
  for (const char* text : {"", "-", "+", "+-1", "1,5", "1.5x", "0x10", "1e", "abc", "1e400",
                           "-1e400", ".", "1 2", "--1", "1d5"}) {
    EXPECT_FALSE(parse_number(text, value)) << text;
  }
}

// glibc's strtod rounds correctly, too, by another method.
TEST(IoText, random_decimals_agree_with_strtod) {
  std::mt19937_64 random(7);
  for (int i = 0; i < 200'000; ++i) {
    std::string text = random() % 2 ? "-" : "";
    for (std::uint64_t digits = 1 + random() % 40; digits > 0; --digits) {
      text += static_cast<char>('0' + random() % 10);
      if (random() % 20 == 0 && text.find('.') == text.npos) text += '.';
    }
    text += 'e';
    text += std::to_string(static_cast<int>(random() % 660) - 350);
    const double expected = std::strtod(text.c_str(), nullptr);
    double value = 0;
    ASSERT_EQ(parse_number(text, value), std::isfinite(expected)) << text;
    if (std::isfinite(expected)) {
      ASSERT_EQ(std::bit_cast<std::uint64_t>(value), std::bit_cast<std::uint64_t>(expected))
          << text;
    }
  }
}

// Halfway between two neighbours, exactly and a digit beside: the hardest decimals there are.
TEST(IoText, decimals_beside_the_midpoint_of_two_doubles_agree_with_strtod) {
  std::mt19937_64 random(8);
  std::array<char, 2000> text;
  for (int i = 0; i < 20'000; ++i) {
    const std::uint64_t bits = random() % 0x7fe0'0000'0000'0000;
    const auto below = static_cast<long double>(std::bit_cast<double>(bits));
    const auto above = static_cast<long double>(std::bit_cast<double>(bits + 1));
    // 80-bit floats hold the midpoint exactly, and %Le prints all of its digits
    std::snprintf(text.data(), text.size(), "%.800Le", below + (above - below) / 2);
    std::string decimal(text.data());
    const std::size_t last = decimal.find('e') - 1;
    for (const char digit : {'0', '1'}) {
      decimal[last] = digit;
      double value = 0;
      ASSERT_TRUE(parse_number(decimal, value)) << decimal;
      ASSERT_EQ(value, std::strtod(decimal.c_str(), nullptr)) << decimal;
    }
  }
}

TEST(IoText, utf16_becomes_utf8) {
  using namespace std::string_literals;
  const std::pair<std::string, std::string> texts[] = {
      {"\0v"s, "v"},
      {"\x07\xff"s, "\xdf\xbf"},
      {"\x08\x00"s, "\xe0\xa0\x80"},
      {"\x20\xac\xff\xff"s, "\xe2\x82\xac\xef\xbf\xbf"},
      {"\xd8\x00\xdc\x00\xdb\xff\xdf\xff\0x"s, "\xf0\x90\x80\x80\xf4\x8f\xbf\xbfx"},
  };
  for (const auto& [big, utf8] : texts) {
    std::string little = big;
    for (std::size_t i = 0; i < little.size(); i += 2) std::swap(little[i], little[i + 1]);
    EXPECT_EQ(from_utf16("\xfe\xff" + big), utf8);
    EXPECT_EQ(from_utf16("\xff\xfe" + little), utf8);
  }
  // Half a pair, the second half first, two first halves; half a unit; no mark.
  for (const std::string& wrong : {"\xfe\xff\xd8\x00"s, "\xfe\xff\xdc\x00\xd8\x00"s,
                                   "\xfe\xff\xd8\x00\xd8\x00"s, "\xfe\xff\0"s, "\0v"s}) {
    EXPECT_EQ(from_utf16(wrong), std::nullopt);
  }
}

TEST(IoText, lines_end_with_lf_cr_lf_or_cr) {
  for (const char* end : {"\n", "\r\n", "\r"}) {
    const std::string all = replaced("1\n\n2\nx", '\n', end);
    TextCursor text(all, "f");
    EXPECT_EQ(text.number("a number"), 1);
    text.skip_space();
    EXPECT_EQ(text.number("a number"), 2);
    text.skip_line();
    EXPECT_EQ(error_of([&] { (void)text.number("a number"); }),
              "f:4: expected a number, found 'x': correct it");
  }
}

TEST(IoText, an_error_says_what_was_expected_and_what_is_there) {
  const auto number = [](std::string_view all) {
    return error_of([&] { (void)TextCursor(all, "f").number("the width"); });
  };
  EXPECT_EQ(number("\n1"), "f:1: expected the width, found the end of the line: complete the line");
  EXPECT_EQ(number(""),
            "f:1: expected the width, found the end of the file: it was cut off, get it again");
  EXPECT_EQ(number("1,5 2"), "f:1: expected the width, found '1,5': write it with a decimal point");
  EXPECT_EQ(number("1e400"), "f:1: '1e400' does not fit a double: scale the data");
  EXPECT_EQ(number("\x01\xff"), "f:1: expected the width, found '\?\?': correct it");
}

TEST(IoText, a_backslash_joins_lines_where_the_rules_say_so) {
  TextCursor joined("1 \\\n2 \\\r\n3 # \\\n4", "f", {'#', true});
  EXPECT_EQ(joined.number("n"), 1);
  EXPECT_EQ(joined.number("n"), 2);
  EXPECT_EQ(joined.number("n"), 3);
  joined.skip_blanks();
  EXPECT_TRUE(joined.at_line_end());
  joined.skip_space();
  EXPECT_EQ(joined.number("n"), 4);
  joined.skip_space();
  EXPECT_TRUE(joined.at_end());
}

}  // namespace
}  // namespace pierce::io
