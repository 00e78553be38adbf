// SPDX-License-Identifier: Apache-2.0
#include "mesh/positions.h"

#include <algorithm>
#include <numeric>
#include <tuple>

#include "support/parallel.h"

namespace pierce::mesh {

template <class Real>
std::vector<std::uint32_t> first_at_position(std::span<const Vec3<Real>> vertices,
                                             const scene::StopPoll& stop) {
  struct Placed {
    Vec3<Real> at;
    std::uint32_t vertex;
  };
  std::vector<Placed> sorted(vertices.size());
  parallel::for_ranges(std::size_t{0}, vertices.size(), 4096,
                       [&](std::size_t first, std::size_t last) {
                         for (std::size_t i = first; i != last; ++i) {
                           const Vec3<Real>& v = vertices[i];
                           // x + 0 turns -0 into 0 and NaN would break the order, so it takes a
                           // place of its own.
                           sorted[i] = {{v.x + 0, v.y + 0, v.z + 0}, static_cast<std::uint32_t>(i)};
                         }
                       });
  const auto is_number = [](const Placed& p) {
    return p.at.x == p.at.x && p.at.y == p.at.y && p.at.z == p.at.z;
  };
  const auto end = std::partition(sorted.begin(), sorted.end(), is_number);
  parallel::sort(sorted.begin(), end, [&stop](const Placed& a, const Placed& b) {
    stop.now();
    return std::tie(a.at.x, a.at.y, a.at.z, a.vertex) < std::tie(b.at.x, b.at.y, b.at.z, b.vertex);
  });

  std::vector<std::uint32_t> result(vertices.size());
  std::iota(result.begin(), result.end(), 0U);
  for (auto it = sorted.begin(); it != end; ++it) {
    stop.now();
    if (it != sorted.begin() && std::prev(it)->at == it->at) {
      result[it->vertex] = result[std::prev(it)->vertex];
    }
  }
  return result;
}

template std::vector<std::uint32_t> first_at_position(std::span<const Vec3<float>>,
                                                      const scene::StopPoll&);
template std::vector<std::uint32_t> first_at_position(std::span<const Vec3<double>>,
                                                      const scene::StopPoll&);

}  // namespace pierce::mesh
