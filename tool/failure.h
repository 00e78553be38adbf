// SPDX-License-Identifier: Apache-2.0
//
// How commands fail. UsageError: the command line is wrong (exit status 2). pierce::Error: the data
// are wrong (1), or the user stopped the work. Either way one line on stderr says what to do.
#pragma once

#include <cstdint>
#include <filesystem>
#include <stdexcept>
#include <string>
#include <system_error>
#include <vector>

#include "io/extension.h"
#include "pierce/error.h"
#include "tool_words.h"

namespace pierce::tool {

inline constexpr int kExitBadData = 1;
inline constexpr int kExitBadUsage = 2;

class UsageError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Throws UsageError if writing `out`, the value of an option, would replace one of the files that
/// are read. "-" is standard output, or input.
inline void refuse_to_replace(const std::filesystem::path& out,
                              const std::vector<std::filesystem::path>& inputs,
                              const std::string& option = "--out") {
  for (const std::filesystem::path& input : inputs) {
    if (out == "-" || input == "-") continue;
    std::error_code ignored;  // most often: there is no such output file yet
    if (!std::filesystem::equivalent(out, input, ignored)) continue;
    throw UsageError(option + ": '" + out.string() + "' is an input file; choose another name");
  }
}

/// Throws UsageError unless the file, the value of an option, has one of these extensions.
inline void check_extension(const std::filesystem::path& file,
                            const std::vector<std::string>& extensions,
                            const std::string& option = "--out") {
  std::string list;
  for (const std::string& extension : extensions) {
    if (io::has_extension(file, extension)) return;
    list += (list.empty() ? "" : " or ") + extension;
  }
  throw UsageError(option + ": '" + file.string() + "' must end in " + list);
}

/// Runs `ask`, a batch about items that came from a file, from row `first_row` on. If it refuses
/// one of them, with `code`, the Error names the row; what is wrong with it `ask_one(index)` says,
/// which asks about it alone.
template <class Ask, class AskOne>
void naming_rows(const std::string& path, std::uint64_t first_row, ErrorCode code, const Ask& ask,
                 const AskOne& ask_one) {
  try {
    ask();
  } catch (const Error& batch) {
    if (batch.code() != code || batch.index() == Error::kNoIndex) throw;
    const std::uint64_t row = first_row + batch.index();
    try {
      ask_one(batch.index());
    } catch (const Error& e) {
      throw Error(code, path + ": row " + std::to_string(row) + " (counted from 0): " + e.what(),
                  row, batch.count());
    }
    throw;
  }
}

/// Runs `work`; errors of the library, which knows nothing of files and options, come out with the
/// name of the file that holds the offending numbers and in the words of the command line. Readers
/// and writers name theirs themselves.
template <class Work>
auto naming_file(const std::filesystem::path& file, Work work) {
  try {
    return work();
  } catch (const Error& e) {
    switch (e.code()) {
      case ErrorCode::BadFile:
      case ErrorCode::Stopped:
      case ErrorCode::UnknownKernel:
        throw;
      default:
        throw Error(e.code(), file.string() + ": " + in_tool_words(e), e.index(), e.count());
    }
  }
}

}  // namespace pierce::tool
