// SPDX-License-Identifier: Apache-2.0
//
// The values of --query: each asks a scene about one chunk of rays and appends the answers to the
// output file. All have the same form:
//
//   next_chunk()  how many rays it wants to be given
//   ask(...)      asks, keeps the answers, returns how many hits (or passages) there were
//   write()       appends the answers to the file
//   finish()      gives the file its name
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "io/hits.h"
#include "pierce/scene.h"

namespace pierce::tool {

inline constexpr std::size_t kChunk = std::size_t{1} << 21;  // rays; some 200 MB with the answers

template <class Real>
class ClosestQuery {
 public:
  explicit ClosestQuery(const std::string& out) : writer_(out) {}

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
class AnyQuery {
 public:
  explicit AnyQuery(const std::string& out) : writer_(out) {}

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
class CrossingsQuery {
 public:
  explicit CrossingsQuery(const std::string& out) : writer_(out) {}

  std::uint64_t ask(const Scene<Real>& scene, std::span<const Ray<Real>> rays,
                    const BatchOptions& options) {
    crossings_.resize(rays.size());
    scene.crossings(rays, crossings_, options);
    std::uint64_t passages = 0;
    for (const Crossings& crossings : crossings_) passages += crossings.count;
    return passages;
  }
  void write() { writer_.append(std::span<const Crossings>(crossings_)); }
  void finish() { writer_.finish(); }
  [[nodiscard]] std::size_t next_chunk() const { return kChunk; }

 private:
  io::CrossingsWriter writer_;
  std::vector<Crossings> crossings_;
};

/// Lists may be long: chunks begin small and grow while the lists so far allow it.
template <class Real>
class AllQuery {
 public:
  explicit AllQuery(const std::string& out) : writer_(out) {}

  std::uint64_t ask(const Scene<Real>& scene, std::span<const Ray<Real>> rays,
                    const BatchOptions& options) {
    lists_ = scene.all_hits(rays, options);
    // As many rays next as would fill one chunk with hits, going by these.
    const std::size_t full = kHits / (lists_.hits.size() / rays.size() + 1);
    next_ = std::clamp<std::size_t>(full, 1, std::min(kChunk, kGrowth * rays.size()));
    return lists_.hits.size();
  }
  void write() { writer_.append(lists_); }
  void finish() { writer_.finish(); }
  [[nodiscard]] std::size_t next_chunk() const { return next_; }

 private:
  static constexpr std::size_t kFirst = 64;
  static constexpr std::size_t kGrowth = 8;                   // at most, from one chunk to the next
  static constexpr std::size_t kHits = std::size_t{1} << 22;  // aimed at, in one chunk

  io::AllWriter<Real> writer_;
  HitLists<Real> lists_;
  std::size_t next_ = kFirst;
};

}  // namespace pierce::tool
