// SPDX-License-Identifier: Apache-2.0
//
// The judge of the benchmark: wrong answers of others are counted, our own stop everything.
#include "suite/suite.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <limits>
#include <stdexcept>
#include <string>

#include "kernels/kernel.h"
#include "pierce/error.h"
#include "pierce/scene.h"
#include "suite/compare.h"
#include "suite/report.h"
#include "suite/samples.h"

namespace pierce::bench {
namespace {

class NoEngine : public Engine {
 public:
  NoEngine() : Engine("none") {}
  BuildFigures build(const Mesh&, unsigned) override { return {}; }
  void release() override {}
};

class Speaker : public Contender {  // says what it is told
 public:
  Speaker(Kind kind, Engine& engine) : Contender("speaker", kind, engine) {}
  void prepare(const RaySet&, Query, unsigned) override {}
  void run() override {}
  void collect(Answers&) override {}
};

// Two parallel triangles, the nearer one twice, and rays through all of them.
struct Stack {
  Mesh mesh;
  RaySet set{"down", {}, {}};
  Answers right;

  Stack() {
    mesh.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 0, 1}, {0, 1, 1}};
    mesh.triangles = {{0, 1, 2}, {3, 4, 5}, {3, 4, 5}};
    for (int i = 0; i < 4; ++i) set.rays.push_back({{0.25F, 0.25F, 2}, {0, 0, -1}});
    const auto scene = Scene<float>::build(mesh.mesh_view());
    for (const Ray<float>& ray : set.rays) right.hits.push_back(*scene.closest_hit(ray));
  }
  Differences compare(Kind kind, const Answers& answers) const {
    NoEngine engine;
    const Speaker speaker(kind, engine);
    return compare_answers(mesh, set, Query::Closest, right, speaker, answers);
  }
};

TEST(Judge, counts_misses_other_triangles_and_ties_apart) {
  const Stack stack;
  Answers answers = stack.right;
  answers.hits[1] = {};
  answers.hits[2].triangle = 0;  // further away
  answers.hits[3].triangle = 2;  // just as near as triangle 1
  const Differences found = stack.compare(Kind::Other, answers);
  EXPECT_EQ(found.compared, 4U);
  EXPECT_EQ(found.missed, 1U);
  EXPECT_EQ(found.other_triangle, 1U);
  EXPECT_EQ(found.tied, 1U);
  EXPECT_EQ(found.wrong(), 2U);
}

TEST(Judge, lets_none_of_our_own_differ_in_a_single_bit) {
  const Stack stack;
  EXPECT_EQ(stack.compare(Kind::Exact, stack.right).wrong(), 0U);
  Answers answers = stack.right;
  answers.hits[2].u = std::nextafter(answers.hits[2].u, 1.0F);
  EXPECT_THROW(stack.compare(Kind::Exact, answers), std::runtime_error);
  answers = stack.right;
  answers.hits[3].triangle = 2;  // a tie, but ours must name the first
  EXPECT_THROW(stack.compare(Kind::Exact, answers), std::runtime_error);
}

TEST(Judge, holds_double_scenes_to_the_decisions_of_float_scenes) {
  const Stack stack;
  Answers answers;
  for (const Hit<float>& h : stack.right.hits) {
    answers.hits_double.push_back({static_cast<double>(h.t), static_cast<double>(h.u),
                                   static_cast<double>(h.v), static_cast<double>(h.w), h.geometry,
                                   h.triangle, h.facing});
  }
  EXPECT_NO_THROW(stack.compare(Kind::Double, answers));
  answers.hits_double[1].t += 0x1p-20;
  EXPECT_THROW(stack.compare(Kind::Double, answers), std::runtime_error);
}

TEST(Suite, measures_every_cell_and_writes_every_round) {
  SuiteOptions options;
  options.meshes = {"needles"};
  options.sets = {"primary", "random"};
  options.contenders = {"pierce", "pierce-batch", "pierce-double", "pierce-compact-batch",
                        "textbook"};
  options.rounds = 3;
  options.side = 16;
  unsigned cells = 0;
  SuiteListener listener;
  listener.measured = [&](const MeshResult&, const Cell&) { ++cells; };
  const SuiteResult result = run_suite(options, listener);
  ASSERT_EQ(result.meshes.size(), 1U);
  ASSERT_EQ(result.meshes[0].cells.size(), 4U);  // two sets, two queries
  EXPECT_EQ(cells, 4U);
  for (const Cell& cell : result.meshes[0].cells) {
    ASSERT_EQ(cell.timings.size(), 5U);
    for (const Timing& timing : cell.timings) EXPECT_EQ(timing.seconds.size(), 3U);
    EXPECT_GT(cell.hits, 0U);
    EXPECT_TRUE(cell.ladder);
  }
  const std::string json = to_json(result, {{"cpu", "a \"quoted\" name"}});
  EXPECT_NE(json.find("\"a \\\"quoted\\\" name\""), std::string::npos);
  EXPECT_NE(ratios_text(result).find("pierce-double / pierce"), std::string::npos);
}

TEST(Suite, times_kernels_side_by_side) {
  SuiteOptions options;
  options.meshes = {"needles"};
  options.sets = {"random"};
  const std::string active = kernels::kernels().front()->name;
  options.contenders = {"pierce@plain", "pierce@" + active, "pierce-batch@" + active};
  options.rounds = 1;
  options.side = 16;
  const char* const before = std::getenv("PIERCE_KERNEL");
  const std::string kept = before != nullptr ? before : "";
  const SuiteResult result = run_suite(options, {});
  const char* const after = std::getenv("PIERCE_KERNEL");
  EXPECT_EQ(kept, after != nullptr ? after : "");
  EXPECT_EQ(result.meshes[0].builds.size(), active == "plain" ? 1U : 2U);  // an engine a kernel
  const std::string text = ratios_text(result);
  EXPECT_NE(text.find("pierce-batch@" + active + " / pierce@" + active), std::string::npos) << text;
  EXPECT_THROW((void)make_field({"pierce@nothing"}).engines[0]->build(make_mesh("needles"), 1),
               Error);
}

TEST(Suite, knows_its_names) {
  EXPECT_THROW((void)make_mesh("nothing"), Error);
  EXPECT_THROW((void)make_field({"nobody"}), Error);
}

TEST(Samples, quantiles_lie_between_their_neighbours) {
  EXPECT_EQ(median({3, 1, 2}), 2);
  EXPECT_EQ(median({4, 1, 2, 3}), 2.5);
  EXPECT_EQ(quantile({0, 10}, 0.25), 2.5);
  EXPECT_EQ(median({}), 0);
}

}  // namespace
}  // namespace pierce::bench
