// SPDX-License-Identifier: Apache-2.0
//
// libFuzzer target: bytes become one ray and one triangle, the public intersect must say what the
// exact oracle says, to the bit. The first byte chooses the type, the range and whether numbers are
// taken as raw bits or as small integers, where exact coincidences are dense.
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <optional>

#include "pierce/intersect.h"
#include "support/hard_cases.h"
#include "support/quick_oracle.h"
#include "support/show.h"

namespace pierce {
namespace {

/// Takes numbers off the input; zeros when it is used up.
class Bytes {
 public:
  Bytes(const std::uint8_t* data, std::size_t size) : data_(data), size_(size) {}

  template <class T>
  T take() {
    T value{};
    const std::size_t count = std::min(sizeof(T), size_);
    std::memcpy(&value, data_, count);
    data_ += count;
    size_ -= count;
    return value;
  }

 private:
  const std::uint8_t* data_;
  std::size_t size_;
};

template <class Real>
void check(Bytes bytes, std::uint8_t mode) {
  const auto number = [&]() -> Real {
    if ((mode & 4) != 0) return static_cast<Real>(bytes.take<std::int8_t>());
    return bytes.take<Real>();
  };
  const auto vec = [&] {
    const Real x = number(), y = number();
    return Vec3<Real>{x, y, number()};
  };
  hard::Case<Real> c;
  c.ray.origin = vec();
  c.ray.direction = vec();
  c.a = vec();
  c.b = vec();
  c.c = vec();
  if ((mode & 8) != 0) c.ray.t_min = number();
  if ((mode & 16) != 0) c.ray.t_max = number();
  if ((mode & 2) != 0) c.range = Range::OpenStart;
  if (!hard::is_valid(c.ray) || !hard::is_finite(c.a) || !hard::is_finite(c.b) ||
      !hard::is_finite(c.c) || std::isnan(c.ray.t_min) || std::isnan(c.ray.t_max)) {
    return;
  }
  const auto found = intersect(c.ray, c.a, c.b, c.c, c.range).value_or(Hit<Real>{});
  const auto exact = oracle::LineAndTriangle(c.ray, c.a, c.b, c.c).hit(c.ray, c.range);
  const auto expected = exact ? oracle::rounded<Real>(*exact, 0, 0) : Hit<Real>{};
  if (show::same_bits(found, expected)) return;
  std::fprintf(stderr, "%s\nfound:    %s\nexpected: %s\n", show::text(c).c_str(),
               show::text(found).c_str(), show::text(expected).c_str());
  std::abort();
}

}  // namespace
}  // namespace pierce

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  pierce::Bytes bytes(data, size);
  const auto mode = bytes.take<std::uint8_t>();
  if ((mode & 1) != 0) {
    pierce::check<float>(bytes, mode);
  } else {
    pierce::check<double>(bytes, mode);
  }
  return 0;
}
