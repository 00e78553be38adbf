// SPDX-License-Identifier: Apache-2.0
//
// What `pierce cast` may be told.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "cast_queries.h"
#include "failure.h"
#include "file_options.h"
#include "geometries.h"
#include "io/json_view.h"
#include "pierce/options.h"
#include "pierce/scene.h"
#include "ray_options.h"
#include "reduce.h"

namespace pierce::tool {

enum class Query : std::uint8_t { Closest, Any, All, Count, Crossings };

struct CastOptions : FileOptions {
  RayOptions source;
  std::vector<std::string> ray;  ///< or the rays themselves
  Query query = Query::Closest;
  Sides sides = Sides::Both;
  Range range = Range::Closed;
  std::uint64_t max_hits = kUnlimited;
  ReduceOptions reduce;
  std::string t_range;  ///< as typed
};

void add_query_options(CLI::App& app, CastOptions& options);

[[nodiscard]] const char* name_of(Query query);
[[nodiscard]] const char* name_of(Reduction reduction);
[[nodiscard]] const char* name_of(Sides sides);
[[nodiscard]] const char* name_of(Range range);
/// What these words stand for; throws Error (BadFile) that names `where` if nothing.
void parse_question(const io::JsonView& json, CastOptions& options);

/// How many rays are cast and answered at a time: enough for each thread. A multiple of eight.
[[nodiscard]] std::size_t rays_at_a_time(unsigned threads);

/// Without progress, statistics.
[[nodiscard]] BatchOptions batch_options(const CastOptions& options);

/// Completes what --reduce, --bins and --t-range say. Throws UsageError unless there is one source
/// of rays and the query has such answers.
void check_cast(CastOptions& options);

/// What a cast is about, read: --ray, or else the file of --rays, with its remarks printed (none if
/// rays are made), and the meshes.
struct CastInputs {
  std::optional<io::RayFile> rays;
  std::vector<Geometry> meshes;
  bool use_float;
};
[[nodiscard]] CastInputs read_inputs(const CastOptions& options);

/// Calls `cast(asker)` with what asks the query and writes, or reduces, the answers about rays
/// first, first + 1, ... as a file of their own.
template <class Real, class Cast>
auto with_asker(const CastOptions& options, const io::RecordTarget& out, const Scene<Real>& scene,
                std::uint64_t first, std::span<const std::uint64_t> shape, Cast cast) {
  switch (options.reduce.reduction) {
    case Reduction::None:
      break;
    case Reduction::Bits: {
      std::uint64_t rays = 1;
      for (const std::uint64_t side : shape) rays *= side;
      return cast(BitsReduction<Real>(out.path, rays));
    }
    case Reduction::Depth:
      return cast(DepthReduction<Real>(out.path, shape));
    case Reduction::Histogram:
    case Reduction::Triangles:
    case Reduction::Parts:
      return cast(CountsReduction<Real>(out.path, options.reduce, scene));
  }
  switch (options.query) {
    case Query::Any:
      return cast(AnyQuery<Real>(out));
    case Query::All:
      return cast(AllQuery<Real>(out, first));
    case Query::Count:
      return cast(CountQuery<Real>(out));
    case Query::Crossings:
      return cast(CrossingsQuery<Real>(out));
    case Query::Closest:
      break;
  }
  return cast(ClosestQuery<Real>(out));
}

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
