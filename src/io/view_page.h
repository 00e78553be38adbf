// SPDX-License-Identifier: Apache-2.0
//
// A page for a browser: meshes, rays and hits in one HTML file, which is web/viewer/viewer.html
// with the numbers in it, exactly as they are.
//
// In place of its line "<!--data-->" stand two elements: `facts`, a JSON object (title, bits, up,
// meshes, rays, hits, names), and `bytes`, one block of memory in base64, little-endian. In the
// facts [at, count] stands for numbers that lie from byte `at` on: of `bits` bits, or integers of
// 32. A ray has eight, a hit has t, u, v, w in `hits` and ray, geometry, triangle in `names`.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "pierce/transform.h"
#include "pierce/types.h"

namespace pierce::io {

template <class Real>
struct ViewMesh {
  std::string name;
  MeshView<Real> mesh;
  const Transform<Real>* place = nullptr;  ///< if any: where it stands
};

template <class Real>
struct ViewHit {
  std::array<Real, 4> numbers;         ///< t, u, v, w
  std::array<std::uint32_t, 3> names;  ///< ray (kNone: not known), geometry, triangle (kNone: miss)
};

template <class Real>
struct ViewContent {
  std::string title;
  bool z_up = false;
  std::vector<ViewMesh<Real>> meshes;
  std::span<const Ray<Real>> rays = {};
  std::vector<ViewHit<Real>> hits = {};
};

/// Throws Error (IndexOutOfRange) if a hit names a triangle that is not there.
template <class Real>
void check_hits(std::span<const ViewHit<Real>> hits, std::span<const MeshView<Real>> meshes);

/// Hands the page to `write`, piece by piece. Throws Error (IndexOutOfRange) if a hit names a
/// triangle that is not there, or a triangle a vertex; meshes of one and the same array share it.
template <class Real>
void write_view_page(const ViewContent<Real>& content,
                     const std::function<void(std::string_view)>& write);

extern template void write_view_page(const ViewContent<float>&,
                                     const std::function<void(std::string_view)>&);
extern template void write_view_page(const ViewContent<double>&,
                                     const std::function<void(std::string_view)>&);

}  // namespace pierce::io
