// SPDX-License-Identifier: Apache-2.0
#include "space/local_space.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "support/finite.h"

namespace pierce::space {
namespace {

// Two roundings of sums of at most a dozen terms each, and room: what is computed here by the way
// is within this of the sum of its terms' magnitudes.
constexpr double kRoughly = 0x1p-48;

using Vector = std::array<double, 3>;

Vector vector(const Vec3<double>& p) { return {p.x, p.y, p.z}; }
Vec3<double> point(const Vector& p) { return {p[0], p[1], p[2]}; }

double linear(const std::array<double, 4>& row, const Vector& p) {
  return row[0] * p[0] + row[1] * p[1] + row[2] * p[2];
}

// The sum of the terms' magnitudes.
double terms(const std::array<double, 4>& row, const Vector& p) {
  return std::fabs(row[0] * p[0]) + std::fabs(row[1] * p[1]) + std::fabs(row[2] * p[2]);
}

Vector image(const Affine& map, const Vector& p) {
  return {linear(map[0], p) + map[0][3], linear(map[1], p) + map[1][3],
          linear(map[2], p) + map[2][3]};
}

// Three numbers, and one that is zero: whole vectors of the machine.
struct Four {
  double of[4];

  [[nodiscard]] double max_norm() const {
    return std::max({std::fabs(of[0]), std::fabs(of[1]), std::fabs(of[2])});
  }
  [[nodiscard]] double dot(const Four& other) const {
    return of[0] * other.of[0] + of[1] * other.of[1] + of[2] * other.of[2];
  }
};

// What the half sides of a box become, those of a box around its image.
Vector half_image(const Affine& map, const Vector& half) {
  return {terms(map[0], half), terms(map[1], half), terms(map[2], half)};
}

bool is_finite_map(const Affine& map) {
  for (const auto& row : map) {
    for (const double x : row) {
      if (!is_finite_number(x)) return false;
    }
  }
  return true;
}

// The linear part's inverse; no finite numbers if it has none.
Affine inverse_of(const Affine& a) {
  Affine inverse{};
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t i1 = (i + 1) % 3, i2 = (i + 2) % 3;
    for (std::size_t j = 0; j < 3; ++j) {
      const std::size_t j1 = (j + 1) % 3, j2 = (j + 2) % 3;
      inverse[j][i] = a[i1][j1] * a[i2][j2] - a[i1][j2] * a[i2][j1];
    }
  }
  const double determinant =
      a[0][0] * inverse[0][0] + a[0][1] * inverse[1][0] + a[0][2] * inverse[2][0];
  for (auto& row : inverse) {
    for (double& x : row) x /= determinant;
  }
  return inverse;
}

// The power of two that brings a positive number into [1, 2); 0 if that is out of all measure.
double power_to_one(double x) {
  if (!(x > 0x1p-400 && x < 0x1p400)) return 0;
  constexpr std::uint64_t kExponent = std::uint64_t{0x7ff} << 52;
  const std::uint64_t exponent = std::bit_cast<std::uint64_t>(x) & kExponent;
  return std::bit_cast<double>((std::uint64_t{2 * 1023} << 52) - exponent);
}

}  // namespace

std::optional<LocalSpace> LocalSpace::make(const AffineMap& scene, const AffineMap& local,
                                           const PlacedExtent& extent) {
  if (!scene.usable || !local.usable) return std::nullopt;
  const Affine& placement = extent.placement;
  const Affine inverse = inverse_of(placement);
  const Vector size = vector(extent.size);
  LocalSpace space;
  // Local (L), placement (M) and scene (W) are exact as real maps; to_local_ is about L M^-1 W^-1.
  Affine placed;   // W M
  Vector reach;    // what W M adds up, in magnitude, for any vertex
  Vector rounded;  // what rounding a placed vertex moves its image under W by
  for (std::size_t i = 0; i < 3; ++i) {
    const double at_most = terms(placement[i], size) + std::fabs(placement[i][3]);
    for (std::size_t j = 0; j < 3; ++j) placed[i][j] = placement[i][j] * scene.scale;
    placed[i][3] = (placement[i][3] - scene.center[i]) * scene.scale;
    reach[i] = (at_most + std::fabs(scene.center[i])) * scene.scale;
    rounded[i] = (at_most * extent.ulp * (1 + 0x1p-40) + extent.tiny) * scene.scale;
    // As if the scene's centre were a point of the mesh.
    const double back = local.scale / scene.scale;
    for (std::size_t j = 0; j < 3; ++j) space.to_local_[i][j] = inverse[i][j] * back;
    const Vector from = {scene.center[0] - placement[0][3], scene.center[1] - placement[1][3],
                         scene.center[2] - placement[2][3]};
    space.to_local_[i][3] = (linear(inverse[i], from) - local.center[i]) * local.scale;
    const double there = scene.scale / local.scale;
    for (std::size_t j = 0; j < 3; ++j) space.to_scene_[i][j] = placement[i][j] * there;
    const Vector centre = {local.center[0], local.center[1], local.center[2]};
    space.to_scene_[i][3] =
        (linear(placement[i], centre) + placement[i][3] - scene.center[i]) * scene.scale;
  }
  if (!is_finite_map(space.to_local_) || !is_finite_map(space.to_scene_) ||
      !is_finite_map(placed)) {
    return std::nullopt;
  }
  // How far to_local_ W M is from L, over the mesh, and what rounding the placed vertices adds.
  double blur = 0;
  Vector off;
  for (std::size_t i = 0; i < 3; ++i) {
    const auto& row = space.to_local_[i];
    double error = 0;
    for (std::size_t j = 0; j < 3; ++j) {
      const Vector column = {placed[0][j], placed[1][j], placed[2][j]};
      error += std::fabs(linear(row, column) - (i == j ? local.scale : 0.0)) * size[j];
    }
    const Vector last = {placed[0][3], placed[1][3], placed[2][3]};
    error += std::fabs(linear(row, last) + row[3] + local.scale * local.center[i]);
    const double magnitude = terms(row, reach) + std::fabs(row[3]) +
                             local.scale * (size[i] + std::fabs(local.center[i]));
    blur = std::max(blur, error + kRoughly * magnitude + terms(row, rounded));
    const double row_size = std::fabs(row[0]) + std::fabs(row[1]) + std::fabs(row[2]);
    space.size_ = std::max(space.size_, row_size);
    space.origin_off_ =
        std::max(space.origin_off_,
                 0x1p-51 * row_size + bounds::kLocalRound * (2 * row_size + std::fabs(row[3])));
    off[i] = kRoughly * reach[i] + rounded[i];
    for (std::size_t j = 0; j < 3; ++j) space.columns_[j][i] = row[j];
    space.offset_[i] = row[3];
  }
  space.blur_ = blur;
  space.off_ = point(off);
  // A ray adds to it; what is half of what a float can do with already is no good.
  if (!(blur <= 0.5 * bounds::kLargestBlur)) return std::nullopt;
  return space;
}

Brought LocalSpace::bring(const TransformedRay& ray, LocalRay& out) const {
  const auto along_row = [](const Affine& columns, std::size_t i, const Vec3<double>& p) {
    return columns[0][i] * p.x + columns[1][i] * p.y + columns[2][i] * p.z;
  };
  Four direction, origin;
  for (std::size_t i = 0; i < 4; ++i) direction.of[i] = along_row(columns_, i, ray.direction);
  for (std::size_t i = 0; i < 4; ++i) {
    origin.of[i] = along_row(columns_, i, ray.origin) + offset_[i];
  }
  const double power = power_to_one(direction.max_norm());
  if (power == 0) return Brought::Unknown;
  for (double& x : direction.of) x *= power;
  // The origin was within 2, or so many times that, to within 2^-53 of itself or 2^-49 of its
  // reach; the direction below 2.
  const double from =
      std::max({std::fabs(ray.origin.x), std::fabs(ray.origin.y), std::fabs(ray.origin.z)});
  const double times = std::max(1.0, from * (0.5 * (1 + 0x1p-50)));
  const double slope_off = 2 * bounds::kLocalRound * power * size_;
  const double origin_off = times * origin_off_ + 0x1p-48 * size_ * static_cast<double>(ray.reach);
  const double distance = origin.max_norm();
  if (!(distance <= bounds::kFarthestOrigin)) return Brought::Unknown;
  double shift = 0;
  if (distance > static_cast<double>(kNearOrigin)) {
    shift = -origin.dot(direction) / direction.dot(direction);
    for (std::size_t i = 0; i < 4; ++i) origin.of[i] += shift * direction.of[i];
  }
  // Moved, the origin is rounded twice: numbers of up to sqrt(3) of what it was, in length.
  const double blur =
      blur_ + origin_off + (std::fabs(shift) + 4) * slope_off + 0x1p-50 * distance + 0x1p-51;
  if (!(blur <= bounds::kLargestBlur)) return Brought::Unknown;
  const double size = origin.max_norm();
  if (!(size <= static_cast<double>(kNearOrigin))) return Brought::Misses;
  BlurredRay& local = out.ray;
  for (std::size_t i = 0; i < 4; ++i) {
    local.origin[i] = static_cast<float>(origin.of[i]);
    local.direction[i] = static_cast<float>(direction.of[i]);
  }
  local.reach = reach_of_origin(static_cast<float>(size * (1 + 0x1p-20)));
  local.exact = false;
  local.sides = Sides::Both;
  local.masked = false;
  local.tau_scale = 0;
  local.blur = static_cast<float>(blur * (1 + 0x1p-20));
  out.factor = 1 / power;
  out.shift = shift;
  const LocalRay::Ends wide = out.outward(ray.tau_min, ray.tau_max);
  const LocalRay::Ends narrow = out.inward(ray.tau_min, ray.tau_max);
  local.tau_min = wide.low;
  local.tau_max = wide.high;
  local.tau_first = narrow.low;
  local.tau_last = narrow.high;
  return Brought::There;
}

MiddleBox LocalSpace::to_local(const MiddleBox& box) const {
  const Vector middle = vector(box.middle), half = vector(box.half);
  const Vector there = image(to_local_, middle);
  Vector wide = half_image(to_local_, half);
  for (std::size_t i = 0; i < 3; ++i) {
    wide[i] += blur_ + kRoughly * (terms(to_local_[i], middle) + terms(to_local_[i], half) +
                                   std::fabs(to_local_[i][3]));
  }
  return {point(there), point(wide)};
}

MiddleBox LocalSpace::to_scene(const MiddleBox& box) const {
  const Vector middle = vector(box.middle), off = vector(off_);
  // A vertex is computed to within 2^-53, and so are the planes of boxes before they are rounded.
  const Vector half = {box.half.x + bounds::kPointPad, box.half.y + bounds::kPointPad,
                       box.half.z + bounds::kPointPad};
  const Vector there = image(to_scene_, middle);
  Vector wide = half_image(to_scene_, half);
  for (std::size_t i = 0; i < 3; ++i) {
    wide[i] += off[i] + kRoughly * (terms(to_scene_[i], middle) + terms(to_scene_[i], half) +
                                    std::fabs(to_scene_[i][3]));
  }
  return {point(there), point(wide)};
}

}  // namespace pierce::space
