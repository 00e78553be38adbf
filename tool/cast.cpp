// SPDX-License-Identifier: Apache-2.0
//
// pierce cast: a file of rays against a mesh, to a file of answers. Rays are read, asked and
// answered a chunk at a time, so that the size of the files does not matter.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <type_traits>
#include <vector>

#include "command.h"
#include "failure.h"
#include "interrupt.h"
#include "io/hits.h"
#include "io/rays.h"
#include "output.h"
#include "progress_bar.h"
#include "scene_file.h"
#include "stopwatch.h"

namespace pierce::tool {
namespace {

enum class Query : std::uint8_t { Closest, Any, All };

struct Options {
  std::string mesh, rays, out;
  Query query = Query::Closest;
  Precision precision = Precision::Auto;
  unsigned threads = 0;
  bool quiet = false;
};

constexpr std::size_t kChunk = std::size_t{1} << 21;  // rays; some 200 MB of rays and answers
constexpr std::size_t kFirstLists = 64;               // rays, until we know how long lists are
constexpr std::size_t kGrowth = 8;                    // at most, from one chunk to the next
constexpr std::size_t kHitsInLists = std::size_t{1} << 22;  // aimed at, in one chunk

// One kind of query: asks the scene and appends the answers to the output file.
template <class Real>
class Closest {
 public:
  explicit Closest(const std::string& out) : writer_(out) {}

  std::uint64_t ask(const Scene<Real>& scene, std::span<const Ray<Real>> rays,
                    const BatchOptions& options) {
    hits_.resize(rays.size());
    scene.closest_hits(rays, hits_, options);
    return static_cast<std::uint64_t>(std::count_if(
        hits_.begin(), hits_.end(), [](const Hit<Real>& hit) { return hit.triangle != kNone; }));
  }
  void write() { writer_.append(std::span<const Hit<Real>>(hits_)); }
  void finish() { writer_.finish(); }
  [[nodiscard]] std::size_t next_chunk() const { return kChunk; }

 private:
  io::ClosestWriter<Real> writer_;
  std::vector<Hit<Real>> hits_;
};

template <class Real>
class Any {
 public:
  explicit Any(const std::string& out) : writer_(out) {}

  std::uint64_t ask(const Scene<Real>& scene, std::span<const Ray<Real>> rays,
                    const BatchOptions& options) {
    hits_.resize(rays.size());
    scene.any_hits(rays, hits_, options);
    return static_cast<std::uint64_t>(std::count(hits_.begin(), hits_.end(), 1));
  }
  void write() { writer_.append(std::span<const std::uint8_t>(hits_)); }
  void finish() { writer_.finish(); }
  [[nodiscard]] std::size_t next_chunk() const { return kChunk; }

 private:
  io::AnyWriter writer_;
  std::vector<std::uint8_t> hits_;
};

template <class Real>
class All {
 public:
  explicit All(const std::string& out) : writer_(out) {}

  std::uint64_t ask(const Scene<Real>& scene, std::span<const Ray<Real>> rays,
                    const BatchOptions& options) {
    lists_ = scene.all_hits(rays, options);
    // As many rays next as would fill one chunk with hits, going by these.
    const std::size_t full = kHitsInLists / (lists_.hits.size() / rays.size() + 1);
    next_ = std::clamp<std::size_t>(full, 1, std::min(kChunk, kGrowth * rays.size()));
    return lists_.hits.size();
  }
  void write() { writer_.append(lists_); }
  void finish() { writer_.finish(); }

  [[nodiscard]] std::size_t next_chunk() const { return next_; }

 private:
  io::AllWriter<Real> writer_;
  HitLists<Real> lists_;
  std::size_t next_ = kFirstLists;
};

struct Totals {
  std::uint64_t rays = 0, hits = 0;
  double query_seconds = 0;
  Statistics statistics;
};

// What is wrong with the ray, or nothing.
template <class Real>
std::string fault(const Ray<Real>& ray) {
  const auto finite = [](const Vec3<Real>& v) {
    return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
  };
  if (!finite(ray.origin)) return "the origin is not finite";
  if (!finite(ray.direction)) return "the direction is not finite";
  if (ray.direction == Vec3<Real>{0, 0, 0}) return "the direction is zero";
  if (std::isnan(ray.t_min) || std::isnan(ray.t_max)) return "t_min or t_max is NaN";
  return {};
}

// The batch knows its rays, but not where in the file they came from.
template <class Real>
[[noreturn]] void rethrow_naming_row(const Error& e, const std::string& path, std::uint64_t first,
                                     std::span<const Ray<Real>> rays) {
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const std::string what = fault(rays[i]);
    if (what.empty()) continue;
    throw Error(e.code(), fmt::format("{}: row {} (counted from 0): {}; correct or remove it", path,
                                      first + i, what));
  }
  throw e;
}

template <class Real, class Asker>
Totals cast_all(const Options& options, const Scene<Real>& scene, const io::RayFile& file,
                Asker asker) {
  const interrupt::Graceful graceful;
  Totals totals;
  BatchOptions batch;
  batch.threads = options.threads;
  batch.stop = interrupt::token();
  if (!options.quiet) batch.statistics = &totals.statistics;

  ProgressBar bar("cast");
  const double all = static_cast<double>(file.size());
  std::vector<Ray<Real>> rays;
  for (std::uint64_t first = 0; first < file.size(); first += rays.size()) {
    interrupt::check();
    rays.resize(std::min<std::uint64_t>(asker.next_chunk(), file.size() - first));
    file.read(first, std::span(rays));
    const Stopwatch watch;
    batch.progress = bar.callback(static_cast<double>(first) / all,
                                  static_cast<double>(first + rays.size()) / all);
    try {
      totals.hits += asker.ask(scene, rays, batch);
    } catch (const Error& e) {
      if (e.code() != ErrorCode::InvalidRay) throw;
      rethrow_naming_row<Real>(e, options.rays, first, rays);
    }
    totals.query_seconds += watch.seconds();
    asker.write();
  }
  interrupt::check();
  asker.finish();
  totals.rays = file.size();
  return totals;
}

template <class Real>
Totals cast_query(const Options& options, const Scene<Real>& scene, const io::RayFile& file) {
  switch (options.query) {
    case Query::Any:
      return cast_all(options, scene, file, Any<Real>(options.out));
    case Query::All:
      return cast_all(options, scene, file, All<Real>(options.out));
    case Query::Closest:
      break;
  }
  return cast_all(options, scene, file, Closest<Real>(options.out));
}

template <class Real>
void summarise(const Options& options, const SceneFile<Real>& mesh, const Totals& totals) {
  const Statistics& s = totals.statistics;
  Summary table;
  table.add("triangles", grouped(mesh.view().triangles.size()));
  table.add("rays", grouped(totals.rays));
  table.add("hits", options.query == Query::All
                        ? grouped(totals.hits)
                        : fmt::format("{} ({})", grouped(totals.hits),
                                      percentage(totals.hits, totals.rays)));
  table.add("precision", std::is_same_v<Real, float> ? "float" : "double");
  table.add("build", seconds(mesh.build_seconds()));
  table.add("cast", totals.rays == 0
                        ? seconds(0)
                        : fmt::format("{}, {}", seconds(totals.query_seconds),
                                      rate(static_cast<double>(totals.rays) / totals.query_seconds,
                                           "rays")));
  table.add("exact arithmetic", fmt::format("{} of {} decisions, {} of {} roundings",
                                            grouped(s.settled + s.settled_big + s.orders_settled),
                                            grouped(s.certified + s.settled + s.settled_big +
                                                    s.orders_certified + s.orders_settled),
                                            grouped(s.rounded_exactly), grouped(s.hits)));
  table.add("wrote", options.out);
  remark(table.text());
}

template <class Real>
int cast_as(const Options& options, io::Mesh mesh, const io::RayFile& rays) {
  BuildOptions build;
  build.threads = options.threads;
  const SceneFile<Real> scene(options.mesh, std::move(mesh), build);
  const Totals totals = cast_query(options, scene.scene(), rays);
  if (!options.quiet) summarise(options, scene, totals);
  return 0;
}

int run(const Options& options) {
  refuse_to_replace(options.out, {options.mesh, options.rays});
  const io::RayFile rays(options.rays);
  io::Mesh mesh = read_triangles(options.mesh);
  const bool use_float = choose_float(options.precision, options.mesh, mesh.single_precision,
                                      options.rays, rays.single_precision());
  return use_float ? cast_as<float>(options, std::move(mesh), rays)
                   : cast_as<double>(options, std::move(mesh), rays);
}

}  // namespace

Command add_cast(CLI::App& app) {
  CLI::App* sub = app.add_subcommand("cast", "Cast a file of rays at a mesh");
  const auto options = std::make_shared<Options>();
  sub->add_option("MESH", options->mesh, "Mesh file (PLY, STL, OBJ, OFF, glTF, 3DS, ...)")
      ->required();
  sub->add_option("--rays", options->rays,
                  "Rays: .npy (2-D, float32 or float64) or .csv, with columns "
                  "ox oy oz dx dy dz [t_min t_max]")
      ->required();
  sub->add_option("--out", options->out, "Answers: .npy or .csv, in the order of the rays")
      ->required();
  static const std::map<std::string, Query> queries = {
      {"closest", Query::Closest}, {"any", Query::Any}, {"all", Query::All}};
  sub->add_option("--query", options->query,
                  "closest: the first hit of each ray; any: whether there is one; all: every hit")
      ->transform(CLI::Transformer(queries).description("closest|any|all"))
      ->default_str("closest");
  add_precision_option(*sub, options->precision);
  add_threads_option(*sub, options->threads);
  sub->add_flag("--quiet", options->quiet, "Print no summary");
  sub->footer(
      "Examples:\n"
      "  pierce cast bunny.obj --rays rays.npy --out hits.npy\n"
      "  pierce cast part.stl --rays rays.csv --query all --out hits.csv\n"
      "A record of closest is t u v w geometry triangle facing; a miss has t = inf and\n"
      "triangle 4294967295; facing is 0 for the front and 1 for the back.");
  return {sub, [options] { return run(*options); }};
}

}  // namespace pierce::tool
