// SPDX-License-Identifier: Apache-2.0
//
// Half the solid angle of a triangle, as seen from a point: the angle of the complex number
//   |a| |b| |c| + (a . b) |c| + (b . c) |a| + (c . a) |b|  +  i a . (b x c),
// a, b, c being the corners less the point (van Oosterom and Strackee 1983). It is positive where
// the triangle's back faces the point, in (-pi, pi), and 0 in its plane.
//
// And of a strip: all that lies from an edge on, against the direction of a ray along an axis. A
// surface that ends at the edge is closed by the strip, and the ray passes the surface alone. The
// point is shifted symbolically, as for passages (passage.h), so that it lies on no strip.
#pragma once

#include "predicate/axis_passage.h"
#include "predicate/ladder_counts.h"
#include "predicate/types.h"

namespace pierce::predicate {

/// In radians. The true one is no farther from `value` than `error`.
struct Angle {
  double value = 0;
  double error = 0;
};

/// Above this error of one angle it is worth more bits.
inline constexpr double kAngleGoodEnough = 0x1p-36;

/// In double alone; the error is infinite where that will not do.
Angle certify_half_angle(const Vec3<double>& point, const TriangleD& triangle);

/// In double, or in many more bits where the error would be above kAngleGoodEnough. Not for a point
/// on the triangle.
Angle half_angle(const Vec3<double>& point, const TriangleD& triangle, LadderCounts& counts);

/// Of the strip of the edge from `from` to `to`, facing as a triangle (infinitely far, from, to).
/// 0 if the edge holds the point.
Angle half_angle_of_strip(const Vec3<double>& point, const Vec3<double>& from,
                          const Vec3<double>& to, AxisDirection along, LadderCounts& counts);

/// Takes what is to be added up.
class AngleSink {
 public:
  virtual ~AngleSink() = default;
  virtual void triangle(const TriangleD& triangle) = 0;
  virtual void strip(const Vec3<double>& from, const Vec3<double>& to, bool reversed) = 0;
};

/// Of half angles whose sum is within 1 of an odd multiple of pi: the sign of the difference, found
/// with up to 2560 bits; 0 if these cannot tell. `tell(sink)` says what is to be summed, and is
/// called up to twice.
template <class Tell>
int compare_with_half_turn(const Vec3<double>& point, AxisDirection along, const Tell& tell,
                           LadderCounts& counts);

namespace detail {

class AngleProduct : public AngleSink {
 public:
  /// 1, -1, or 0 for unsure.
  [[nodiscard]] virtual int sign() const = 0;
};
/// Calls `use(product, data)` with a product of 320 bits, or of 2560 (`finest`).
void use_angle_product(const Vec3<double>& point, AxisDirection along, bool finest,
                       LadderCounts& counts, void (*use)(AngleProduct&, void*), void* data);

}  // namespace detail

template <class Tell>
int compare_with_half_turn(const Vec3<double>& point, AxisDirection along, const Tell& tell,
                           LadderCounts& counts) {
  struct Asked {
    const Tell& tell;
    int sign;
  } asked{tell, 0};
  const auto use = [](detail::AngleProduct& product, void* data) {
    auto& wanted = *static_cast<Asked*>(data);
    wanted.tell(product);
    wanted.sign = product.sign();
  };
  detail::use_angle_product(point, along, false, counts, use, &asked);
  if (asked.sign == 0) detail::use_angle_product(point, along, true, counts, use, &asked);
  return asked.sign;
}

}  // namespace pierce::predicate
