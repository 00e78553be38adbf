// SPDX-License-Identifier: Apache-2.0
//
// pierce with its double and exact rungs off, for one purpose: to show what exactness costs.
//
// The library pierce_float_only is made of the sources of pierce itself under another name
// (`pierce` is a macro there), with two files of this folder in the place of their namesakes:
// nobody is asked about what float cannot tell, and nothing is certified about the numbers of a
// hit. Its answers are wrong now and then. It is never installed. What is declared here is free of
// the name, so that both can be linked together.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>

namespace float_only {

struct FoundHit {
  float t, u, v, w;
  std::uint32_t geometry, triangle;
  bool back;
};

/// A scene and the rays it is asked about.
class Caster {
 public:
  /// x, y, z a vertex and three indices a triangle, which outlive it. `threads` 0: all.
  Caster(const float* vertices, std::size_t vertex_count, const std::uint32_t* triangles,
         std::size_t triangle_count, unsigned threads);
  Caster(const Caster&) = delete;
  Caster& operator=(const Caster&) = delete;
  ~Caster();

  [[nodiscard]] std::uint64_t bytes() const;
  [[nodiscard]] double sah_cost() const;

  /// Ox, oy, oz, dx, dy, dz, t_min, t_max a ray; they are copied.
  void take_rays(const float* rays, std::size_t count, bool closest);
  /// Answers all of them.
  void run(bool batch, unsigned threads);
  [[nodiscard]] FoundHit hit(std::size_t ray) const;
  [[nodiscard]] bool any(std::size_t ray) const;

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace float_only
