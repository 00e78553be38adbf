// SPDX-License-Identifier: Apache-2.0
//
// What `pierce cast` may be told.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "failure.h"
#include "file_options.h"
#include "pierce/options.h"
#include "pierce/scene.h"

namespace pierce::tool {

enum class Query : std::uint8_t { Closest, Any, All, Count, Crossings };

struct CastOptions : FileOptions {
  std::string rays;              ///< a file
  std::vector<std::string> ray;  ///< or the rays themselves
  Query query = Query::Closest;
  Sides sides = Sides::Both;
  Range range = Range::Closed;
  std::uint64_t max_hits = kUnlimited;
};

void add_query_options(CLI::App& app, CastOptions& options);

[[nodiscard]] const char* name_of(Query query);
/// Without progress, statistics.
[[nodiscard]] BatchOptions batch_options(const CastOptions& options);

/// Throws UsageError unless there is one of --rays and --ray.
void check_rays(const CastOptions& options);

/// --ray, or else the file of --rays, with its remarks printed.
[[nodiscard]] io::RayFile open_rays(const CastOptions& options);

/// Runs `ask`; if it refuses a ray, the Error names the table's row, of which `rays` are the
/// rows from `first` on.
template <class Real, class Ask>
void naming_rays(const std::string& name, std::uint64_t first, const Scene<Real>& scene,
                 std::span<const Ray<Real>> rays, const Ask& ask) {
  naming_rows(name, first, ErrorCode::InvalidRay, ask,
              [&](std::uint64_t i) { (void)scene.any_hit(rays[i]); });
}

/// Asks about all rays at once and prints the answers.
template <class Real>
void print_answers(const CastOptions& options, const LoadedScene<Real>& mesh,
                   const io::RayFile& rays);

extern template void print_answers(const CastOptions&, const LoadedScene<float>&,
                                   const io::RayFile&);
extern template void print_answers(const CastOptions&, const LoadedScene<double>&,
                                   const io::RayFile&);

}  // namespace pierce::tool
