// SPDX-License-Identifier: Apache-2.0
//
// The passages of a ray through the surface, counted.
#pragma once

#include <cstdint>

#include "predicate/passage.h"
#include "scene/rays/ladder_sink.h"

namespace pierce::scene {

struct FoundPassage {
  std::uint32_t primitive;
  predicate::Passage passage;
};

template <class Real>
class PassageCounter final : public LadderSink<Real, FoundPassage> {
 public:
  using LadderSink<Real, FoundPassage>::LadderSink;

  void add(const kernels::Candidate& candidate, bool /*certain*/) override {
    if (!this->sees(candidate)) return;
    const auto passage =
        predicate::decide_passage(this->ray_, this->geometries_.triangle(candidate), this->counts_);
    if (passage != predicate::Passage::None && this->sight_.sees(passage)) {
      this->found_.push_back({candidate.primitive, passage});
    }
  }

  /// The passages of this ray, each triangle counted once.
  void count(Crossings& crossings) {
    crossings.count = 0;
    crossings.signed_count = 0;
    for (const FoundPassage& found : this->found_once()) {
      ++crossings.count;
      crossings.signed_count += static_cast<std::int32_t>(found.passage);
    }
  }
};

}  // namespace pierce::scene
