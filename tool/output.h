// SPDX-License-Identifier: Apache-2.0
//
// Text for people: answers to stdout, remarks to stderr.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "pierce/options.h"
#include "support/count_words.h"

namespace pierce::tool {

/// Call first thing in main. Standard streams that the parent closed (`>&-`) are opened so that
/// writing to them fails: otherwise the next file opened takes their number, and what is meant for
/// people goes into it.
void reserve_standard_streams();

/// Answers. A reader that has gone away (`pierce info x | head -1`) ends the program quietly; any
/// other failure to write throws Error (BadFile).
void print(std::string_view text);

/// Remarks; failures to write them are of no consequence.
void remark(std::string_view text);

/// Two columns, the second aligned: what commands print when they are done.
class Summary {
 public:
  void add(std::string_view name, std::string value);
  [[nodiscard]] std::string text() const;

 private:
  std::vector<std::pair<std::string, std::string>> rows_;
};

[[nodiscard]] std::string percentage(std::uint64_t part, std::uint64_t whole);
[[nodiscard]] std::string seconds(double value);        ///< 0.0123 s, 1.23 s, 123 s
[[nodiscard]] std::string memory(std::uint64_t bytes);  ///< 12.3 MiB
/// What took so long, and how fast that is: 1.23 s, 12.3 M rays/s. No rate if there was none.
[[nodiscard]] std::string timing(double seconds, std::uint64_t count, const char* of);
/// How often the ladder went down to exact arithmetic: 3 of 1,234 decisions.
[[nodiscard]] std::string exact_decisions(const Statistics& statistics);
[[nodiscard]] std::string exact_roundings(const Statistics& statistics);

}  // namespace pierce::tool
