// SPDX-License-Identifier: Apache-2.0
//
// pierce itself: single rays and batches, float and double scenes, each build quality.
#include "pierce/pierce.h"

#include <charconv>
#include <chrono>
#include <cstddef>
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

template <class Real>
class PierceEngine : public Engine {
 public:
  PierceEngine(std::string name, Quality quality) : Engine(std::move(name)), quality_(quality) {}

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

template <class Real>
void add(Field& field, const std::string& name, const std::string& engine, Quality quality,
         std::size_t batch, bool all_threads = false) {
  auto& built = shared_engine<PierceEngine<Real>>(field, engine, quality);
  field.contenders.push_back(
      std::make_unique<PierceContender<Real>>(name, batch, all_threads, built));
}

}  // namespace

bool add_pierce(Field& field, const std::string& name) {
  if (name == "pierce") {
    add<float>(field, name, "pierce", Quality::Balanced, 0);
  } else if (name == "pierce-batch") {
    add<float>(field, name, "pierce", Quality::Balanced, kAll);
  } else if (name == "pierce-batch-all") {
    add<float>(field, name, "pierce", Quality::Balanced, kAll, true);
  } else if (name == "pierce-double") {
    add<double>(field, name, "pierce-double", Quality::Balanced, 0);
  } else if (name == "pierce-double-batch") {
    add<double>(field, name, "pierce-double", Quality::Balanced, kAll);
  } else if (name == "pierce-fast") {
    add<float>(field, name, "pierce-fast", Quality::Fast, 0);
  } else if (name == "pierce-high") {
    add<float>(field, name, "pierce-high", Quality::High, 0);
  } else if (name == "pierce-compact") {
    add<float>(field, name, "pierce-compact", Quality::Compact, 0);
  } else if (name == "pierce-compact-batch") {
    add<float>(field, name, "pierce-compact", Quality::Compact, kAll);
  } else {
    constexpr std::string_view kSized = "pierce-batch-";
    std::size_t size = 0;
    if (!name.starts_with(kSized)) return false;
    const char* const end = name.data() + name.size();
    const auto read = std::from_chars(name.data() + kSized.size(), end, size);
    if (read.ec != std::errc() || read.ptr != end || size == 0) return false;
    add<float>(field, name, "pierce", Quality::Balanced, size);
  }
  return true;
}

}  // namespace pierce::bench
