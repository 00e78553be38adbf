// SPDX-License-Identifier: Apache-2.0
//
// Many hits by the lower ends of their t, in linear time where these are spread evenly.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "support/finite.h"
#include "support/stop_poll.h"

namespace pierce::scene {

struct OrderKey {
  double low, high;     // t lies between
  std::uint32_t place;  // of the hit
};
using OrderKeys = std::vector<OrderKey>;

/// Keeps its memory from one list to the next.
class HitSorter {
 public:
  /// By `low`.
  void sort(OrderKeys& keys, StopPoll& stop) {
    const auto sort = [&](OrderKeys::iterator first, OrderKeys::iterator last) {
      std::sort(first, last, [&stop](const OrderKey& a, const OrderKey& b) {
        stop.sometimes();
        return a.low < b.low;
      });
    };
    if (keys.size() < kFew || !into_buckets(keys, stop)) return sort(keys.begin(), keys.end());
    std::size_t begin = 0;
    for (const std::uint32_t end : ends_) {
      if (end - begin > 1) {
        const auto at = [&](std::size_t i) {
          return keys.begin() + static_cast<std::ptrdiff_t>(i);
        };
        sort(at(begin), at(end));
      }
      begin = end;
    }
  }

 private:
  static constexpr std::size_t kFew = 32;

  // As many buckets as keys, each as wide. False if they are all alike, or some are infinite.
  bool into_buckets(OrderKeys& keys, StopPoll& stop) {
    double least = keys.front().low, most = least;
    for (const OrderKey& key : keys) {
      least = std::min(least, key.low);
      most = std::max(most, key.low);
    }
    const double scale = static_cast<double>(keys.size() - 1) / (most - least);
    if (!is_finite_number(most - least) || !is_finite_number(scale)) return false;
    // Monotone: every operation is, and never beyond the last bucket.
    const auto bucket = [=](const OrderKey& key) {
      return static_cast<std::size_t>((key.low - least) * scale);
    };
    ends_.assign(keys.size(), 0);
    for (const OrderKey& key : keys) ++ends_[bucket(key)];
    std::uint32_t begin = 0;
    for (std::uint32_t& end : ends_) {  // the beginning, until the bucket is full
      begin += end;
      end = begin - end;
    }
    sorted_.resize(keys.size());
    for (const OrderKey& key : keys) {
      stop.sometimes();
      sorted_[ends_[bucket(key)]++] = key;
    }
    keys.swap(sorted_);
    return true;
  }

  std::vector<std::uint32_t> ends_;  // of the buckets
  OrderKeys sorted_;
};

}  // namespace pierce::scene
