// SPDX-License-Identifier: Apache-2.0
#include "io/mesh.h"

#include <fmt/format.h>

#include <cmath>

#include "pierce/error.h"

namespace pierce::io {

std::vector<Vec3<float>> to_float(std::span<const Vec3<double>> vertices) {
  std::vector<Vec3<float>> out(vertices.size());
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    const Vec3<double>& p = vertices[i];
    const Vec3<float> q{static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(p.z)};
    const auto overflows = [](double from, float to) {
      return std::isfinite(from) && !std::isfinite(to);
    };
    if (overflows(p.x, q.x) || overflows(p.y, q.y) || overflows(p.z, q.z)) {
      throw Error(ErrorCode::InvalidArgument,
                  fmt::format("vertex {} ({}, {}, {}) does not fit the range of float: use double "
                              "precision",
                              i, p.x, p.y, p.z),
                  i);
    }
    out[i] = q;
  }
  return out;
}

}  // namespace pierce::io
