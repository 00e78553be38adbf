// SPDX-License-Identifier: Apache-2.0
//
// A build tells how far it is and can be stopped wherever it is, whatever the quality.
#include <gtest/gtest.h>

#include <atomic>
#include <string>
#include <vector>

#include "pierce/scene.h"
#include "support/meshes.h"
#include "support/run_cases.h"

namespace pierce {
namespace {

constexpr Quality kQualities[] = {Quality::Fast, Quality::Balanced, Quality::High,
                                  Quality::Compact};

/// Ordinary triangles, and long ones that spatial splits cut.
struct Meshes {
  hard::Mesh<float> terrain, needles;
  std::vector<MeshView<float>> views;

  Meshes() {
    hard::Rng rng(hard::seed() + 910, 0);
    terrain = hard::terrain<float>(rng, 100);
    needles = hard::needles<float>(rng, 8000);
    views = {terrain.view(), needles.view()};
  }
};

std::string what_of_build(const Meshes& meshes, const BuildOptions& options) {
  try {
    (void)Scene<float>::build(meshes.views, options);
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::Stopped) << error.what();
    return error.what();
  }
  return "built";
}

TEST(BuildProgress, rises_from_0_to_1_and_comes_from_one_thread_at_a_time) {
  const Meshes meshes;
  for (const Quality quality : kQualities) {
    for (const unsigned threads : {1U, 2U, 0U}) {
      std::vector<double> seen;
      std::atomic<int> callers = 0;
      BuildOptions options;
      options.quality = quality;
      options.work.threads = threads;
      options.work.progress = [&](double fraction) {
        EXPECT_EQ(callers.fetch_add(1), 0);
        seen.push_back(fraction);
        callers.fetch_sub(1);
      };
      EXPECT_EQ(what_of_build(meshes, options), "built");
      ASSERT_GE(seen.size(), 10U);
      EXPECT_EQ(seen.front(), 0);
      EXPECT_EQ(seen.back(), 1);
      for (std::size_t i = 1; i < seen.size(); ++i) ASSERT_GT(seen[i], seen[i - 1]);
    }
  }
}

TEST(BuildProgress, ends_where_the_caller_stops_it) {
  const Meshes meshes;
  for (const Quality quality : kQualities) {
    for (int tenths = 0; tenths < 10; ++tenths) {
      std::atomic<bool> stop = false;
      BuildOptions options;
      options.quality = quality;
      options.work.stop = &stop;
      options.work.progress = [&](double fraction) {
        if (fraction * 10 >= tenths) stop = true;
      };
      EXPECT_NE(what_of_build(meshes, options), "built") << tenths;
    }
  }
}

TEST(BuildProgress, of_what_was_stopped_before_it_began_never_starts) {
  const Meshes meshes;
  std::atomic<bool> stop = false;
  stop = true;
  BuildOptions options;
  options.work.stop = &stop;
  options.work.progress = [](double) { ADD_FAILURE() << "it did"; };
  EXPECT_NE(what_of_build(meshes, options), "built");
}

}  // namespace
}  // namespace pierce
