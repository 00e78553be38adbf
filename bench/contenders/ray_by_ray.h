// SPDX-License-Identifier: Apache-2.0
//
// What contenders of other engines that take the rays as they lie have in common.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "contenders/contender.h"

namespace pierce::bench {

template <class Real>
class RayByRay : public Contender {
 public:
  RayByRay(std::string name, Engine& engine) : Contender(std::move(name), Kind::Other, engine) {}

  void prepare(const RaySet& set, Query query, unsigned threads) override {
    threads_ = threads;
    query_ = query;
    if constexpr (std::is_same_v<Real, float>) {
      rays_ = set.rays;
    } else {
      rays_ = set.rays_double;
    }
    hits_.assign(query == Query::Closest ? rays_.size() : 0, {});
    any_.assign(query == Query::Any ? rays_.size() : 0, 0);
  }

  void collect(Answers& answers) override { answers = {hits_, {}, any_}; }

 protected:
  Query query_ = Query::Closest;
  std::span<const Ray<Real>> rays_;
  std::vector<Hit<float>> hits_;
  std::vector<std::uint8_t> any_;
};

}  // namespace pierce::bench
