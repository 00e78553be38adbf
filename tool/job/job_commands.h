// SPDX-License-Identifier: Apache-2.0
//
// The commands of `pierce job`.
#pragma once

#include <cstdint>
#include <string>

#include "cast_options.h"

namespace pierce::tool {

struct CreateOptions : CastOptions {
  std::string folder;
  std::uint64_t chunk = std::uint64_t{1} << 22;
};

struct RunOptions {
  std::string folder, part;
  unsigned threads = 0;
  bool quiet = false, json = false;
};

struct VerifyOptions {
  std::string folder;
  std::uint64_t chunks = 10, seed = 0;  ///< seed 0: other chunks each time
  unsigned threads = 0;
  bool all = false, quiet = false;
};

struct StatusOptions {
  std::string folder;
  bool json = false;
};

struct MergeOptions {
  std::string folder, out;
  bool quiet = false;
};

[[nodiscard]] int create_job(CreateOptions options);
[[nodiscard]] int run_job(const RunOptions& options);
[[nodiscard]] int verify_job(const VerifyOptions& options);
[[nodiscard]] int status_of_job(const StatusOptions& options);
[[nodiscard]] int merge_job(const MergeOptions& options);

}  // namespace pierce::tool
