// SPDX-License-Identifier: Apache-2.0
#include "parse.h"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <optional>
#include <system_error>

#include "failure.h"

namespace pierce::tool {
namespace {

std::string_view trim(std::string_view text) {
  while (!text.empty() && text.front() == ' ') text.remove_prefix(1);
  while (!text.empty() && text.back() == ' ') text.remove_suffix(1);
  return text;
}

std::optional<double> to_number(std::string_view text);

// 1/3: the double nearest to the quotient of two numbers; nothing if it is none.
std::optional<double> to_quotient(std::string_view above, std::string_view below) {
  const std::optional<double> x = to_number(above), y = to_number(below);
  if (!x || !y || !std::isfinite(*x) || !std::isfinite(*y) || *y == 0) return {};
  const double quotient = *x / *y;
  if (!std::isfinite(quotient)) return {};
  return quotient;
}

// The nearest double; nothing if the text is no number, or one beyond the doubles.
std::optional<double> to_number(std::string_view text) {
  text = trim(text);
  if (const std::size_t bar = text.rfind('/'); bar != std::string_view::npos) {
    const std::string_view above = text.substr(0, bar);
    if (above.find('/') != std::string_view::npos) return {};  // 1/2/3
    return to_quotient(above, text.substr(bar + 1));
  }
  const bool negative = text.starts_with('-');
  if (negative || text.starts_with('+')) text.remove_prefix(1);
  const bool hex = text.starts_with("0x") || text.starts_with("0X");
  if (hex) text.remove_prefix(2);
  if (text.starts_with('-')) return {};  // from_chars would read a second sign

  double value = 0;
  const char* end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(
      text.data(), end, value, hex ? std::chars_format::hex : std::chars_format::general);
  if (error != std::errc() || stop != end) return {};
  return negative ? -value : value;
}

std::vector<std::string_view> split(std::string_view text, char separator) {
  std::vector<std::string_view> parts;
  for (;;) {
    const std::size_t at = text.find(separator);
    parts.push_back(text.substr(0, at));
    if (at == std::string_view::npos) return parts;
    text.remove_prefix(at + 1);
  }
}

}  // namespace

std::vector<double> parse_list(std::string_view text, std::string_view option) {
  std::vector<double> numbers;
  for (const std::string_view part : split(text, ',')) {
    const std::optional<double> number = to_number(part);
    if (!number) throw UsageError(fmt::format("{}: '{}' is not a number", option, part));
    numbers.push_back(*number);
  }
  return numbers;
}

std::vector<double> parse_row(std::string_view text, std::string_view option) {
  std::string list;
  bool gap = false;  // blanks behind a number
  for (const char c : trim(text)) {
    const bool blank = c == ' ' || c == '\t' || c == '\n';
    if (!blank && gap && c != ',' && !list.ends_with(',')) list += ',';
    if (!blank) list += c;
    gap = blank;
  }
  return parse_list(list, option);
}

std::vector<double> parse_numbers(std::string_view text, std::size_t count,
                                  std::string_view option) {
  std::vector<double> numbers = parse_list(text, option);
  if (numbers.size() != count) {
    throw UsageError(fmt::format("{}: needs {} numbers with commas between them; '{}' has {}",
                                 option, count, text, numbers.size()));
  }
  for (const double number : numbers) {
    if (!std::isfinite(number))
      throw UsageError(fmt::format("{}: {} is not finite", option, number));
  }
  return numbers;
}

Vec3<double> parse_vector(std::string_view text, std::string_view option) {
  const std::vector<double> n = parse_numbers(text, 3, option);
  return {n[0], n[1], n[2]};
}

ImageSize parse_size(std::string_view text, std::string_view option) {
  const auto side = [&](std::string_view part) {
    unsigned value = 0;
    const char* end = part.data() + part.size();
    const auto [stop, error] = std::from_chars(part.data(), end, value);
    if (error != std::errc() || stop != end || value < 1 || value > 65535) {
      throw UsageError(fmt::format(
          "{}: '{}' is not WIDTHxHEIGHT, such as 1024x768 (each 1 to 65535)", option, text));
    }
    return value;
  };
  const std::size_t x = text.find('x');
  if (x == std::string_view::npos) return {side(""), 0};
  return {side(text.substr(0, x)), side(text.substr(x + 1))};
}

}  // namespace pierce::tool
