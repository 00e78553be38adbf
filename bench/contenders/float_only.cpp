// SPDX-License-Identifier: Apache-2.0
//
// pierce with its double and exact rungs off (see float_only/float_only.h), beside itself: the cost
// of exactness. Its wrong answers are counted like those of any other contender.
#include "float_only/float_only.h"

#include <chrono>
#include <memory>

#include "contenders/families.h"

namespace pierce::bench {
namespace {

class FloatOnlyEngine : public Engine {
 public:
  explicit FloatOnlyEngine(std::string name) : Engine(std::move(name)) {}

  BuildFigures build(const Mesh& mesh, unsigned threads) override {
    release();
    const auto start = std::chrono::steady_clock::now();
    caster_ = std::make_unique<float_only::Caster>(&mesh.vertices.data()->x, mesh.vertices.size(),
                                                   mesh.triangles.data()->data(),
                                                   mesh.triangles.size(), threads);
    const std::chrono::duration<double> time = std::chrono::steady_clock::now() - start;
    return {time.count(), caster_->bytes(), caster_->sah_cost()};
  }

  void release() override { caster_.reset(); }

  [[nodiscard]] float_only::Caster& caster() const { return *caster_; }

 private:
  std::unique_ptr<float_only::Caster> caster_;
};

class FloatOnlyContender : public Contender {
 public:
  FloatOnlyContender(std::string name, bool batch, FloatOnlyEngine& engine)
      : Contender(std::move(name), Kind::Other, engine), batch_(batch), engine_(engine) {}

  void prepare(const RaySet& set, Query query, unsigned threads) override {
    static_assert(sizeof(Ray<float>) == 8 * sizeof(float));
    threads_ = threads;
    query_ = query;
    count_ = set.rays.size();
    engine_.caster().take_rays(&set.rays.data()->origin.x, count_, query == Query::Closest);
  }

  void run() override { engine_.caster().run(batch_, threads_); }

  void collect(Answers& answers) override {
    answers = {};
    for (std::size_t i = 0; i < count_; ++i) {
      if (query_ == Query::Any) {
        answers.any.push_back(engine_.caster().any(i) ? 1 : 0);
      } else {
        const float_only::FoundHit h = engine_.caster().hit(i);
        answers.hits.push_back(
            {h.t, h.u, h.v, h.w, h.geometry, h.triangle, h.back ? Facing::Back : Facing::Front});
      }
    }
  }

 private:
  bool batch_;
  FloatOnlyEngine& engine_;
  Query query_ = Query::Closest;
  std::size_t count_ = 0;
};

}  // namespace

bool add_float_only(Field& field, const std::string& name) {
  const bool batch = name == "pierce-float-only-batch";
  if (!batch && name != "pierce-float-only") return false;
  auto& engine = shared_engine<FloatOnlyEngine>(field, "pierce-float-only");
  field.contenders.push_back(std::make_unique<FloatOnlyContender>(name, batch, engine));
  return true;
}

}  // namespace pierce::bench
