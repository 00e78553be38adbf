// SPDX-License-Identifier: Apache-2.0
#include "output.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <signal.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstring>

#include "interrupt.h"
#include "pierce/error.h"

namespace pierce::tool {

void reserve_standard_streams() {
  int opened = 0;
  while (opened >= 0 && opened <= STDERR_FILENO) opened = ::open("/dev/null", O_RDONLY);
  if (opened > STDERR_FILENO) ::close(opened);
}

void print(std::string_view text) {
  while (!text.empty()) {
    const ssize_t written = ::write(STDOUT_FILENO, text.data(), text.size());
    if (written >= 0) {
      text.remove_prefix(static_cast<std::size_t>(written));
    } else if (errno == EPIPE) {
      interrupt::end_at_once(128 + SIGPIPE);  // as if the signal had not been ignored
    } else if (errno != EINTR) {
      throw Error(ErrorCode::BadFile, fmt::format("standard output: {}", std::strerror(errno)));
    }
  }
}

void remark(std::string_view text) { (void)!::write(STDERR_FILENO, text.data(), text.size()); }

void Summary::add(std::string_view name, std::string value) {
  rows_.emplace_back(name, std::move(value));
}

std::string Summary::text() const {
  std::size_t width = 0;
  for (const auto& [name, value] : rows_) width = std::max(width, name.size());
  std::string result;
  for (const auto& [name, value] : rows_) result += fmt::format("{:<{}}  {}\n", name, width, value);
  return result;
}

std::string percentage(std::uint64_t part, std::uint64_t whole) {
  if (whole == 0) return "0 %";
  return fmt::format("{:.3g} %", 100 * static_cast<double>(part) / static_cast<double>(whole));
}

std::string seconds(double value) { return fmt::format("{:.3g} s", value); }

std::string memory(std::uint64_t bytes) {
  const double b = static_cast<double>(bytes);
  if (b >= 0x1p30) return fmt::format("{:.3g} GiB", b * 0x1p-30);
  if (b >= 0x1p20) return fmt::format("{:.3g} MiB", b * 0x1p-20);
  if (b >= 0x1p10) return fmt::format("{:.3g} KiB", b * 0x1p-10);
  return counted(bytes, "byte", "bytes");
}

std::string timing(double seconds, std::uint64_t count, const char* of) {
  if (count == 0) return tool::seconds(seconds);
  const double rate = static_cast<double>(count) / seconds;
  const auto [unit, prefix] = rate >= 1e6   ? std::pair(1e6, "M ")
                              : rate >= 1e3 ? std::pair(1e3, "k ")
                                            : std::pair(1.0, "");
  return fmt::format("{}, {:.3g} {}{}/s", tool::seconds(seconds), rate / unit, prefix, of);
}

std::string exact_decisions(const Statistics& s) {
  const std::uint64_t exact = s.settled + s.settled_big + s.orders_settled;
  return fmt::format("{} of {} decisions", grouped(exact),
                     grouped(exact + s.certified + s.orders_certified));
}

std::string exact_roundings(const Statistics& s) {
  return fmt::format("{} of {} roundings", grouped(s.rounded_exactly), grouped(s.hits));
}

}  // namespace pierce::tool
