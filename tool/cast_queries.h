// SPDX-License-Identifier: Apache-2.0
//
// The values of --query: each asks a scene about one piece of the rays and appends the answers to
// the output file. All have the same form:
//
//   make_room(n)       for the answers of the piece's n rays
//   ask(..., at, ...)  asks about some of them, the first of which is the at-th; on any thread
//   finish_piece()     when all are there: returns how many hits (or passages) there were
//   seconds_writing()  how much of that time it wrote already
//   write()            appends the answers to the file
//   finish()           gives the file its name
//
// (AllQuery asks about all rays of the piece at once.)
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <span>
#include <vector>

#include "io/hits.h"
#include "pierce/scene.h"
#include "stopwatch.h"

namespace pierce::tool {

/// What asks first and writes then.
struct WritesLater {
  [[nodiscard]] static double seconds_writing() { return 0; }
};

template <class Real>
class ClosestQuery : public WritesLater {
 public:
  explicit ClosestQuery(const io::RecordTarget& out) : writer_(out) {}

  void make_room(std::size_t size) { hits_.resize(size); }
  void ask(const Scene<Real>& scene, std::span<const Ray<Real>> rays, std::size_t at,
           const BatchOptions& options) {
    scene.closest_hits(rays, std::span(hits_).subspan(at, rays.size()), options);
  }
  std::uint64_t finish_piece() {
    return static_cast<std::uint64_t>(std::count_if(
        hits_.begin(), hits_.end(), [](const Hit<Real>& hit) { return hit.triangle != kNone; }));
  }
  void write() { writer_.append(std::span<const Hit<Real>>(hits_)); }
  void finish() { writer_.finish(); }

 private:
  io::ClosestWriter<Real> writer_;
  std::vector<Hit<Real>> hits_;
};

template <class Real>
class AnyQuery : public WritesLater {
 public:
  explicit AnyQuery(const io::RecordTarget& out) : writer_(out) {}

  void make_room(std::size_t size) { hits_.resize(size); }
  void ask(const Scene<Real>& scene, std::span<const Ray<Real>> rays, std::size_t at,
           const BatchOptions& options) {
    scene.any_hits(rays, std::span(hits_).subspan(at, rays.size()), options);
  }
  std::uint64_t finish_piece() {
    return static_cast<std::uint64_t>(std::count(hits_.begin(), hits_.end(), 1));
  }
  void write() { writer_.append(std::span<const std::uint8_t>(hits_)); }
  void finish() { writer_.finish(); }

 private:
  io::AnyWriter writer_;
  std::vector<std::uint8_t> hits_;
};

template <class Real>
class CrossingsQuery : public WritesLater {
 public:
  explicit CrossingsQuery(const io::RecordTarget& out) : writer_(out) {}

  void make_room(std::size_t size) { crossings_.resize(size); }
  void ask(const Scene<Real>& scene, std::span<const Ray<Real>> rays, std::size_t at,
           const BatchOptions& options) {
    scene.crossings(rays, std::span(crossings_).subspan(at, rays.size()), options);
  }
  std::uint64_t finish_piece() {
    std::uint64_t passages = 0;
    for (const Crossings& crossings : crossings_) passages += crossings.count;
    return passages;
  }
  void write() { writer_.append(std::span<const Crossings>(crossings_)); }
  void finish() { writer_.finish(); }

 private:
  io::CrossingsWriter writer_;
  std::vector<Crossings> crossings_;
};

template <class Real>
class CountQuery : public WritesLater {
 public:
  explicit CountQuery(const io::RecordTarget& out) : writer_(out) {}

  void make_room(std::size_t size) { counts_.resize(size); }
  void ask(const Scene<Real>& scene, std::span<const Ray<Real>> rays, std::size_t at,
           const BatchOptions& options) {
    scene.count_hits(rays, std::span(counts_).subspan(at, rays.size()), options);
  }
  std::uint64_t finish_piece() {
    return std::accumulate(counts_.begin(), counts_.end(), std::uint64_t{0});
  }
  void write() { writer_.append(std::span<const std::uint32_t>(counts_)); }
  void finish() { writer_.finish(); }

 private:
  io::CountWriter writer_;
  std::vector<std::uint32_t> counts_;
};

/// Lists may be long: they are written as they come, and not kept.
template <class Real>
class AllQuery {
 public:
  explicit AllQuery(const io::RecordTarget& out, std::uint64_t first_ray = 0)
      : writer_(out, first_ray) {}

  std::uint64_t ask(const Scene<Real>& scene, std::span<const Ray<Real>> rays,
                    const BatchOptions& options) {
    std::uint64_t hits = 0;
    seconds_writing_ = 0;
    scene.all_hits(rays, options, [&](std::uint64_t, const HitLists<Real>& lists) {
      const Stopwatch watch;
      writer_.append(lists);
      hits += lists.hits.size();
      seconds_writing_ += watch.seconds();
    });
    return hits;
  }
  [[nodiscard]] double seconds_writing() const { return seconds_writing_; }
  void write() {}
  void finish() { writer_.finish(); }

 private:
  io::AllWriter<Real> writer_;
  double seconds_writing_ = 0;
};

}  // namespace pierce::tool
