// SPDX-License-Identifier: Apache-2.0
//
// pierce itself: single rays and batches, float and double scenes, each build quality and kernel.
#include "pierce/pierce.h"

#include <algorithm>
#include <charconv>
#include <chrono>
#include <cstddef>
#include <cstdlib>
#include <limits>
#include <optional>
#include <string_view>
#include <thread>
#include <type_traits>

#include "contenders/families.h"
#include "contenders/scene_loops.h"

namespace pierce::bench {
namespace {

constexpr std::size_t kAll = std::numeric_limits<std::size_t>::max();  // rays in one batch

// PIERCE_KERNEL while it lives: a scene keeps the kernel that it was built with.
class KernelNamed {
 public:
  explicit KernelNamed(const std::string& kernel) {
    if (kernel.empty()) return;
    if (const char* const before = std::getenv(kVariable)) before_ = before;
    set_ = true;
    setenv(kVariable, kernel.c_str(), 1);
  }
  KernelNamed(const KernelNamed&) = delete;
  KernelNamed& operator=(const KernelNamed&) = delete;
  ~KernelNamed() {
    if (!set_) return;
    before_ ? setenv(kVariable, before_->c_str(), 1) : unsetenv(kVariable);
  }

 private:
  static constexpr const char* kVariable = "PIERCE_KERNEL";
  std::optional<std::string> before_;
  bool set_ = false;
};

template <class Real>
class PierceEngine : public Engine {
 public:
  // `kernel`: empty for the one that everybody gets.
  PierceEngine(std::string name, Quality quality, std::string kernel)
      : Engine(std::move(name)), quality_(quality), kernel_(std::move(kernel)) {}

  BuildFigures build(const Mesh& mesh, unsigned threads) override {
    release();
    std::span<const Vec3<Real>> vertices;
    if constexpr (std::is_same_v<Real, float>) {
      vertices = mesh.vertices;
    } else {
      vertices_.reserve(mesh.vertices.size());
      for (const Vec3<float>& p : mesh.vertices) vertices_.push_back(to_double(p));
      vertices = vertices_;
    }
    BuildOptions options;
    options.quality = quality_;
    options.work.threads = threads;
    const KernelNamed named(kernel_);
    const auto start = std::chrono::steady_clock::now();
    scene_ = Scene<Real>::build(MeshView<Real>{vertices, mesh.triangles}, options);
    const std::chrono::duration<double> time = std::chrono::steady_clock::now() - start;
    const SceneInfo info = scene_->info();
    return {time.count(), info.bytes, info.sah_cost};
  }

  void release() override {
    scene_.reset();
    vertices_ = {};
  }

  [[nodiscard]] const Scene<Real>& scene() const { return *scene_; }

 private:
  Quality quality_;
  std::string kernel_;
  std::vector<Vec3<double>> vertices_;  // a double scene's mesh: the caller's, so not counted
  std::optional<Scene<Real>> scene_;
};

template <class Real>
class PierceContender : public Contender {
 public:
  // `batch`: how many rays a call has; 0: one, in a call of its own.
  PierceContender(std::string name, std::size_t batch, bool all_threads, PierceEngine<Real>& engine)
      : Contender(std::move(name), std::is_same_v<Real, float> ? Kind::Exact : Kind::Double,
                  engine),
        batch_(batch),
        all_threads_(all_threads),
        pierce_(engine) {}

  void prepare(const RaySet& set, Query query, unsigned threads) override {
    threads_ = all_threads_ ? std::thread::hardware_concurrency() : threads;
    if constexpr (std::is_same_v<Real, float>) {
      asked_.start(set.rays, query == Query::Closest);
    } else {
      asked_.start(set.rays_double, query == Query::Closest);
    }
  }

  void run() override {
    if (batch_ != 0) {
      run_batch(nullptr, batch_);
    } else {
      ask_one_by_one(pierce_.scene(), threads_, asked_);
    }
  }

  void collect(Answers& answers) override {
    answers = {};
    answers.any = asked_.any;
    if constexpr (std::is_same_v<Real, float>) {
      answers.hits = asked_.hits;
    } else {
      answers.hits_double = asked_.hits;
    }
  }

  bool statistics(Statistics& statistics) override {
    run_batch(&statistics, kAll);
    return true;
  }

 private:
  void run_batch(Statistics* statistics, std::size_t size) {
    BatchOptions options;
    options.work.threads = threads_;
    options.work.statistics = statistics;
    ask_together(pierce_.scene(), options, size, asked_);
  }

  std::size_t batch_;
  bool all_threads_;
  PierceEngine<Real>& pierce_;
  Asked<Real> asked_;
};

// A contender of pierce: its name, "@" and a kernel behind it or not.
struct PierceWay {
  const char* name;
  const char* engine;  // those of one engine share a scene
  Quality quality;
  bool doubles;
  std::size_t batch;
  bool all_threads = false;
};

constexpr PierceWay kPierceWays[] = {
    {"pierce", "pierce", Quality::Balanced, false, 0},
    {"pierce-batch", "pierce", Quality::Balanced, false, kAll},
    {"pierce-batch-all", "pierce", Quality::Balanced, false, kAll, true},
    {"pierce-double", "pierce-double", Quality::Balanced, true, 0},
    {"pierce-double-batch", "pierce-double", Quality::Balanced, true, kAll},
    {"pierce-fast", "pierce-fast", Quality::Fast, false, 0},
    {"pierce-high", "pierce-high", Quality::High, false, 0},
    {"pierce-compact", "pierce-compact", Quality::Compact, false, 0},
    {"pierce-compact-batch", "pierce-compact", Quality::Compact, false, kAll},
};

template <class Real>
void add(Field& field, const std::string& name, const PierceWay& way, const std::string& kernel) {
  const std::string engine = way.engine + (kernel.empty() ? "" : '@' + kernel);
  auto& built = shared_engine<PierceEngine<Real>>(field, engine, way.quality, kernel);
  field.contenders.push_back(
      std::make_unique<PierceContender<Real>>(name, way.batch, way.all_threads, built));
}

// "pierce-batch-" and a number of rays.
std::optional<PierceWay> sized_way(std::string_view name) {
  constexpr std::string_view kSized = "pierce-batch-";
  if (!name.starts_with(kSized)) return std::nullopt;
  std::size_t size = 0;
  const char* const end = name.data() + name.size();
  const auto read = std::from_chars(name.data() + kSized.size(), end, size);
  if (read.ec != std::errc() || read.ptr != end || size == 0) return std::nullopt;
  return PierceWay{"", "pierce", Quality::Balanced, false, size};
}

std::optional<PierceWay> way_named(std::string_view name) {
  for (const PierceWay& way : kPierceWays) {
    if (name == way.name) return way;
  }
  return sized_way(name);
}

}  // namespace

bool add_pierce(Field& field, const std::string& name) {
  const std::size_t at = std::min(name.find('@'), name.size());
  const std::optional<PierceWay> way = way_named(std::string_view(name).substr(0, at));
  if (!way) return false;
  const std::string kernel = at == name.size() ? "" : name.substr(at + 1);
  way->doubles ? add<double>(field, name, *way, kernel) : add<float>(field, name, *way, kernel);
  return true;
}

}  // namespace pierce::bench
