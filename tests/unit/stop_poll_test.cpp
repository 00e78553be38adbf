// SPDX-License-Identifier: Apache-2.0
//
// A batch stops within one ray's list, however long: while hits are found, and while they are put
// in order.
#include <gtest/gtest.h>

#include <atomic>
#include <vector>

#include "scene/rays/hit_collector.h"
#include "scene/rays/list_collector.h"
#include "scene/rays/passage_counter.h"

namespace pierce::scene {
namespace {

const std::vector<Vec3<float>> kVertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
const std::vector<Triangle> kTriangles(2000, Triangle{0, 1, 2});
const MeshView<float> kMesh = {kVertices, kTriangles};
const predicate::RayD kRay = {{0.25, 0.25, 1}, {0, 0, -1}};

bool is_stopped(const auto& work) {
  try {
    work();
    return false;
  } catch (const Error& e) {
    return e.code() == ErrorCode::Stopped;
  }
}

struct Offers {
  Geometries<float> geometries{std::span(&kMesh, 1), {}};
  predicate::LadderCounts counts;
  std::atomic<bool> source = false;

  Offers() { geometries.expect_no_copies(); }

  void offer_all(kernels::CandidateSink& sink) const {
    for (std::uint32_t i = 0; i < kTriangles.size(); ++i) sink.add({i, 0, nullptr}, false);
  }

  template <class CandidateSink>
  void expect_stops() {
    CandidateSink sink(geometries, StopPoll(&source), counts);
    expect_stops(sink);
  }
  void expect_list_stops() {
    ListCollector<float> sink(kernels::active_kernel(), geometries, StopPoll(&source), counts);
    expect_stops(sink);
  }

  void expect_stops(auto& sink) {
    sink.start(kRay, {});
    EXPECT_FALSE(is_stopped([&] { offer_all(sink); }));
    source = true;
    EXPECT_TRUE(is_stopped([&] { offer_all(sink); }));
  }
};

TEST(StopPoll, stops_while_hits_are_found) {
  Offers().expect_stops<HitCollector<float>>();
  Offers().expect_stops<HitCounter<float>>();
  Offers().expect_list_stops();
  Offers().expect_stops<PassageCounter<float>>();
}

TEST(StopPoll, stops_while_hits_are_put_in_order) {
  for (const std::uint64_t most : {kUnlimited, std::uint64_t{1000}}) {
    Offers offers;
    ListCollector<float> collector(kernels::active_kernel(), offers.geometries,
                                   StopPoll(&offers.source), offers.counts);
    collector.start(kRay, {});
    offers.offer_all(collector);
    offers.source = true;
    std::vector<Hit<float>> hits;
    EXPECT_TRUE(is_stopped([&] { collector.append_ordered(most, hits); }));
    EXPECT_TRUE(hits.empty());
  }
}

TEST(StopPoll, without_a_token_nothing_ever_stops) {
  StopPoll poll;
  for (int i = 0; i < 1000; ++i) poll.sometimes();
  poll.now();
}

}  // namespace
}  // namespace pierce::scene
