// SPDX-License-Identifier: Apache-2.0
#include "predicate/solid_angle.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "exact/wide_float.h"
#include "predicate/angle.h"
#include "predicate/passage.h"

namespace pierce::predicate {
namespace {

constexpr double kUnsureAngle = std::numeric_limits<double>::infinity();
// Squares of lengths within which nothing below overflows, or underflows to what matters.
constexpr double kShortest = 0x1p-400, kLongest = 0x1p400;
// The error of both parts of the complex number together, relative to the product of the lengths:
// 80 roundings (docs/algorithm.md, "Winding numbers").
constexpr double kAngleFactor = 0x1p-46;

Vec3<double> operator-(const Vec3<double>& p, const Vec3<double>& q) {
  return {p.x - q.x, p.y - q.y, p.z - q.z};
}
double dot(const Vec3<double>& p, const Vec3<double>& q) {
  return p.x * q.x + p.y * q.y + p.z * q.z;
}
Vec3<double> cross(const Vec3<double>& p, const Vec3<double>& q) {
  return {p.y * q.z - p.z * q.y, p.z * q.x - p.x * q.z, p.x * q.y - p.y * q.x};
}
bool in_window(double square) { return square >= kShortest && square <= kLongest; }

// The angle of a complex number whose parts are off by up to `error`.
Angle angle_within(double across, double up, double error) {
  const double larger = std::max(std::fabs(across), std::fabs(up));
  const bool sure = larger > 4 * error && (across > error || std::fabs(up) > error);
  if (!sure) return {0, kUnsureAngle};
  return {angle_of(across, up), 2 * (error / larger) + 0x1p-47};
}

// Whether the point lies right beside an end of the edge, on the line that bounds the strip.
bool is_in_line(const Vec3<double>& point, const Vec3<double>& end, AxisDirection along) {
  for (std::uint8_t axis = 0; axis < 3; ++axis) {
    if (axis != along.axis && component(point, axis) != component(end, axis)) return false;
  }
  const double at = component(point, along.axis), from = component(end, along.axis);
  return along.forward ? at < from : at > from;
}

// The axis along which the symbolic shift is felt first.
std::uint8_t shift_axis(AxisDirection along) { return along.axis == 0 ? 1 : 0; }

Angle certify_strip(const Vec3<double>& point, const Vec3<double>& from, const Vec3<double>& to,
                    AxisDirection along) {
  const Vec3<double> a = from - point, b = to - point;
  const double aa = dot(a, a), bb = dot(b, b);
  if (!in_window(aa) || !in_window(bb)) return {0, kUnsureAngle};
  const double la = std::sqrt(aa), lb = std::sqrt(bb);
  const double away = along.forward ? -1 : 1;
  const double up = away * component(cross(a, b), along.axis);
  const double across =
      la * lb + dot(a, b) + away * (component(a, along.axis) * lb + component(b, along.axis) * la);
  return angle_within(across, up, kAngleFactor * (la * lb));
}

using exact::WideFloat;

// p - q
template <unsigned Bits>
struct WideVector {
  using T = WideFloat<Bits>;
  T x, y, z;

  WideVector(const Vec3<double>& p, const Vec3<double>& q)
      : x(less(p.x, q.x)), y(less(p.y, q.y)), z(less(p.z, q.z)) {}
  [[nodiscard]] const T& at(std::uint8_t axis) const { return axis == 0 ? x : axis == 1 ? y : z; }

 private:
  static T less(double p, double q) { return exact::widen<Bits>(p) - exact::widen<Bits>(q); }
};
template <unsigned Bits>
WideFloat<Bits> dot(const WideVector<Bits>& p, const WideVector<Bits>& q) {
  return p.x * q.x + p.y * q.y + p.z * q.z;
}
template <unsigned Bits>
WideFloat<Bits> cross_at(const WideVector<Bits>& p, const WideVector<Bits>& q, std::uint8_t axis) {
  const auto i = static_cast<std::uint8_t>((axis + 1) % 3);
  const auto j = static_cast<std::uint8_t>((axis + 2) % 3);
  return p.at(i) * q.at(j) - p.at(j) * q.at(i);
}

// Whether differences of such coordinates have no more bits than this.
template <class... Points>
bool differences_fit(int bits, const Points&... points) {
  int low = std::numeric_limits<int>::max(), high = std::numeric_limits<int>::min();
  const auto include = [&](double x) {
    if (x == 0) return;
    int exponent = 0;
    std::frexp(x, &exponent);
    low = std::min(low, exponent - std::numeric_limits<double>::digits);
    high = std::max(high, exponent);
  };
  const auto include_all = [&](const Vec3<double>& p) {
    include(p.x);
    include(p.y);
    include(p.z);
  };
  (include_all(points), ...);
  return low > high || high - low < bits;
}

// A complex number of magnitude about 1 or less, its parts off by up to `error`.
template <class T>
struct Complex {
  T across, up, error;
};

template <unsigned Bits>
WideFloat<Bits> wide_error() {
  return ldexp(WideFloat<Bits>(1), 16 - static_cast<int>(Bits));
}

template <unsigned Bits>
Complex<WideFloat<Bits>> wide_triangle(const Vec3<double>& point, const TriangleD& t,
                                       LadderCounts& counts) {
  using T = WideFloat<Bits>;
  const WideVector<Bits> a(t.a, point), b(t.b, point), c(t.c, point);
  const T la = sqrt(dot(a, a)), lb = sqrt(dot(b, b)), lc = sqrt(dot(c, c));
  const T size = la * lb * lc;
  if (size == 0) return {T(1), T(0), 0};  // at a corner
  const T up = a.x * cross_at(b, c, 0) + a.y * cross_at(b, c, 1) + a.z * cross_at(b, c, 2);
  const T across = size + dot(a, b) * lc + dot(b, c) * la + dot(c, a) * lb;
  Complex<T> number{across / size, up / size, wide_error<Bits>()};
  if (abs(number.up) <= number.error) {  // its sign matters where it is small
    number.up = decide_side_of_plane(point, t, counts) * number.error / 2;
  }
  return number;
}

// Of a point on the line that bounds the strip at one end both parts are 0. Shifted by s it is seen
// at the angle between s and the other end, p, about that line: to the first order in s the complex
// number is  -s . p - i away . (s x p),  turned round if that end comes first.
template <unsigned Bits>
Complex<WideFloat<Bits>> strip_in_line(const Vec3<double>& point, const Vec3<double>& other,
                                       bool other_first, AxisDirection along) {
  using T = WideFloat<Bits>;
  const WideVector<Bits> p(other, point);
  const std::uint8_t s = shift_axis(along);
  const auto third = static_cast<std::uint8_t>(3 - along.axis - s);
  const T across = -p.at(s), beside = p.at(third);
  // Component `axis` of s x p.
  const bool in_turn = (s + 1) % 3 == third;
  const int away = along.forward ? -1 : 1;
  const T up = (in_turn ? -away : away) * beside;
  const T size = abs(across) + abs(up);
  return {across / size, (other_first ? T(-up) : up) / size, T(ldexp(T(1), -304))};
}

template <unsigned Bits>
Complex<WideFloat<Bits>> wide_strip(const Vec3<double>& point, const Vec3<double>& from,
                                    const Vec3<double>& to, AxisDirection along,
                                    LadderCounts& counts) {
  using T = WideFloat<Bits>;
  const int away_sign = along.forward ? -1 : 1;
  const auto with_sign = [&](Complex<T> number) {  // of what is nearly 0
    if (abs(number.up) <= 2 * number.error) {
      const int side = decide_shifted_side(point, along.axis, from, to, counts);
      number.up = away_sign * side * number.error / 2;
    }
    return number;
  };
  if (is_in_line(point, from, along)) {
    return with_sign(strip_in_line<Bits>(point, to, false, along));
  }
  if (is_in_line(point, to, along)) return with_sign(strip_in_line<Bits>(point, from, true, along));
  const WideVector<Bits> a(from, point), b(to, point);
  const T la = sqrt(dot(a, a)), lb = sqrt(dot(b, b));
  const T size = la * lb;
  if (size == 0) return {T(1), T(0), 0};
  const T up = away_sign * cross_at(a, b, along.axis);
  const T across = size + dot(a, b) + away_sign * (a.at(along.axis) * lb + b.at(along.axis) * la);
  return with_sign({across / size, up / size, wide_error<Bits>()});
}

template <unsigned Bits>
Angle angle_of_wide(const Complex<WideFloat<Bits>>& number) {
  using T = WideFloat<Bits>;
  const T larger = std::max(T(abs(number.across)), T(abs(number.up)));
  if (larger <= 4 * number.error) {  // it may be any angle
    return {0, number.error == 0 ? 0 : std::numbers::pi};
  }
  const double relative = exact::narrow<Bits>(number.error / larger);
  double up = exact::narrow<Bits>(number.up / larger);
  if (up == 0 && number.up != 0)  // its sign tells half a turn from the other half
    up = std::copysign(std::numeric_limits<double>::denorm_min(), number.up < 0 ? -1.0 : 1.0);
  return {angle_of(exact::narrow<Bits>(number.across / larger), up), 4 * relative + 0x1p-46};
}

// Up to 2560 bits, if 320 will not do. `compute.operator()<Bits>()`.
template <class Compute>
Angle settle_angle(bool narrow, const Compute& compute, LadderCounts& counts) {
  ++counts.settled_big;
  if (narrow) {
    const Angle angle = angle_of_wide<320>(compute.template operator()<320>());
    if (angle.error <= kAngleGoodEnough) return angle;
  }
  return angle_of_wide<2560>(compute.template operator()<2560>());
}

// Whether the strip's angle is 0 because the edge is seen as a point, or holds the point.
bool no_strip(const Vec3<double>& point, const Vec3<double>& from, const Vec3<double>& to,
              AxisDirection along) {
  const auto i = static_cast<std::uint8_t>((along.axis + 1) % 3);
  const auto j = static_cast<std::uint8_t>((along.axis + 2) % 3);
  if (component(from, i) == component(to, i) && component(from, j) == component(to, j)) return true;
  return decide_on_triangle(point, {from, to, to});
}

template <unsigned Bits>
class WideProduct final : public detail::AngleProduct {
 public:
  WideProduct(const Vec3<double>& point, AxisDirection along, LadderCounts& counts)
      : point_(point), along_(along), counts_(counts) {}

  void triangle(const TriangleD& t) override {
    exact_ &= differences_fit(Bits - 8, point_, t.a, t.b, t.c);
    multiply(wide_triangle<Bits>(point_, t, counts_), false);
  }
  void strip(const Vec3<double>& from, const Vec3<double>& to, bool reversed) override {
    if (no_strip(point_, from, to, along_)) return;
    exact_ &= differences_fit(Bits - 8, point_, from, to);
    multiply(wide_strip<Bits>(point_, from, to, along_, counts_), reversed);
  }
  [[nodiscard]] int sign() const override {
    // Beyond an odd half turn the imaginary part is negative.
    if (!exact_ || !(abs(im_) > 4 * error_)) return 0;
    return im_ < 0 ? 1 : -1;
  }

 private:
  void multiply(Complex<WideFloat<Bits>> number, bool reversed) {
    const WideFloat<Bits> larger =
        std::max(WideFloat<Bits>(abs(number.across)), WideFloat<Bits>(abs(number.up)));
    if (number.up == 0 && number.across > 0) return;
    if (larger <= 4 * number.error) {
      exact_ = false;
      return;
    }
    if (reversed) number.up = -number.up;
    const WideFloat<Bits> re = re_ * number.across - im_ * number.up;
    im_ = re_ * number.up + im_ * number.across;
    re_ = re;
    const WideFloat<Bits> size = std::max(WideFloat<Bits>(abs(re_)), WideFloat<Bits>(abs(im_)));
    re_ /= size;
    im_ /= size;
    error_ += 4 * (number.error / larger + wide_error<Bits>());
  }

  const Vec3<double>& point_;
  AxisDirection along_;
  LadderCounts& counts_;
  WideFloat<Bits> re_ = 1, im_ = 0;
  WideFloat<Bits> error_ = 0;
  bool exact_ = true;
};

}  // namespace

Angle certify_half_angle(const Vec3<double>& point, const TriangleD& triangle) {
  const Vec3<double> a = triangle.a - point, b = triangle.b - point, c = triangle.c - point;
  const double aa = dot(a, a), bb = dot(b, b), cc = dot(c, c);
  if (!in_window(aa) || !in_window(bb) || !in_window(cc)) return {0, kUnsureAngle};
  const double la = std::sqrt(aa), lb = std::sqrt(bb), lc = std::sqrt(cc);
  const double size = la * lb * lc;
  const double up = dot(a, cross(b, c));
  const double across = size + dot(a, b) * lc + dot(b, c) * la + dot(c, a) * lb;
  return angle_within(across, up, kAngleFactor * size);
}

Angle half_angle(const Vec3<double>& point, const TriangleD& triangle, LadderCounts& counts) {
  const Angle angle = certify_half_angle(point, triangle);
  if (angle.error <= kAngleGoodEnough) {
    ++counts.certified;
    return angle;
  }
  const auto compute = [&]<unsigned Bits>() {
    return wide_triangle<Bits>(point, triangle, counts);
  };
  return settle_angle(differences_fit(312, point, triangle.a, triangle.b, triangle.c), compute,
                      counts);
}

Angle half_angle_of_strip(const Vec3<double>& point, const Vec3<double>& from,
                          const Vec3<double>& to, AxisDirection along, LadderCounts& counts) {
  if (no_strip(point, from, to, along)) return {};
  const Angle angle = certify_strip(point, from, to, along);
  if (angle.error <= kAngleGoodEnough) {
    ++counts.certified;
    return angle;
  }
  const auto compute = [&]<unsigned Bits>() {
    return wide_strip<Bits>(point, from, to, along, counts);
  };
  return settle_angle(differences_fit(312, point, from, to), compute, counts);
}

namespace detail {

void use_angle_product(const Vec3<double>& point, AxisDirection along, bool finest,
                       LadderCounts& counts, void (*use)(AngleProduct&, void*), void* data) {
  if (finest) {
    WideProduct<2560> product(point, along, counts);
    use(product, data);
  } else {
    WideProduct<320> product(point, along, counts);
    use(product, data);
  }
}

}  // namespace detail
}  // namespace pierce::predicate
