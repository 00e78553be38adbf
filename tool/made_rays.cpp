// SPDX-License-Identifier: Apache-2.0
#include "made_rays.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <string_view>
#include <utility>

#include "pierce/vector.h"

namespace pierce::tool {
namespace {

using Vec = Vec3<double>;

// The i-th number of a sequence of its own for each ray: SplitMix64's finaliser over a counter.
std::uint64_t mixed(std::uint64_t x) {
  x = (x ^ (x >> 30)) * 0xBF58476D1CE4E5B9U;
  x = (x ^ (x >> 27)) * 0x94D049BB133111EBU;
  return x ^ (x >> 31);
}

class Counter {
 public:
  Counter(std::uint64_t seed, std::uint64_t ray) : state_(mixed(mixed(seed + kStep) ^ ray)) {}
  /// In [-1, 1), a multiple of 2^-53.
  double next() {
    state_ += kStep;
    const auto bits = static_cast<std::int64_t>(mixed(state_) >> 10) - (std::int64_t{1} << 53);
    return static_cast<double>(bits) * 0x1p-53;
  }

 private:
  static constexpr std::uint64_t kStep = 0x9E3779B97F4A7C15U;
  std::uint64_t state_;
};

// Uniform on the unit sphere, from a point of the unit disc.
Vec on_sphere(Counter& counter) {
  for (;;) {
    const double x = counter.next(), y = counter.next();
    const double s = x * x + y * y;
    if (s >= 1) continue;
    const double r = 2 * std::sqrt(1 - s);
    return {x * r, y * r, 1 - 2 * s};
  }
}

// Sine and cosine of a quarter turn's part in [0, 1], by their series: the library's own differ
// from one machine to the next.
std::pair<double, double> sine_cosine(double quarter) {
  const bool beyond = quarter > 0.5;
  const double x = (beyond ? 1 - quarter : quarter) * (std::numbers::pi / 2);
  const double xx = x * x;
  double sine = 0, cosine = 0;
  for (int n = 19; n >= 1; n -= 2) sine = 1 - sine * xx / ((n + 1) * (n + 2));
  for (int n = 18; n >= 0; n -= 2) cosine = 1 - cosine * xx / ((n + 1) * (n + 2));
  sine *= x;
  return beyond ? std::pair(cosine, sine) : std::pair(sine, cosine);
}

// The direction of a column: a part of a full turn, from x by way of y.
Vec turned(std::uint64_t column, std::uint64_t columns, const Vec& x, const Vec& y) {
  const std::uint64_t quadrant = 4 * column / columns;
  const double part =
      static_cast<double>(4 * column - quadrant * columns) / static_cast<double>(columns);
  const auto [sine, cosine] = sine_cosine(part);
  switch (quadrant) {
    case 0:
      return cosine * x + sine * y;
    case 1:
      return cosine * y - sine * x;
    case 2:
      return -cosine * x - sine * y;
    default:
      return sine * x - cosine * y;
  }
}

constexpr std::pair<std::string_view, RayKind> kMadeKinds[] = {{"camera", RayKind::Camera},
                                                               {"grid", RayKind::Grid},
                                                               {"lidar", RayKind::Lidar},
                                                               {"sphere", RayKind::Sphere}};

void write(io::JsonWriter& json, const char* key, const Vec& v) {
  json.values(key, std::vector<double>{v.x, v.y, v.z});
}

Vec read_vector(const io::JsonView& json) {
  return {json.at(std::uint64_t{0}).number(), json.at(1).number(), json.at(2).number()};
}

// Writes `make(s)` for columns `column`, ...: s is -1 at a row's left edge and 1 at its right.
template <class Real, class Make>
void across(std::uint64_t column, std::uint64_t columns, std::span<Ray<Real>> out,
            const Make& make) {
  constexpr int kAtOnce = 64;  // divisions: several go in one instruction
  const auto width = static_cast<double>(columns);
  for (double first = static_cast<double>(column); !out.empty(); first += kAtOnce) {
    double s[kAtOnce];
    for (int i = 0; i < kAtOnce; ++i) s[i] = (2 * (first + i) + 1) / width - 1;
    const std::size_t size = std::min<std::size_t>(kAtOnce, out.size());
    for (std::size_t i = 0; i < size; ++i) out[i] = make(s[i]);
    out = out.subspan(size);
  }
}

}  // namespace

const char* name_of(RayKind kind) {
  return kMadeKinds[static_cast<std::size_t>(kind)].first.data();
}

template <class Real>
void MadeRays::make(std::uint64_t first, std::span<Ray<Real>> out) const {
  if (kind == RayKind::Sphere) {
    for (std::size_t i = 0; i != out.size(); ++i) out[i] = chord<Real>(first + i);
    return;
  }
  std::uint64_t row = first / width, column = first % width;
  while (!out.empty()) {
    const auto size = static_cast<std::size_t>(std::min<std::uint64_t>(width - column, out.size()));
    make_in_row(row, column, out.first(size));
    out = out.subspan(size);
    column = 0;
    ++row;
  }
}

template <class Real>
void MadeRays::make_in_row(std::uint64_t row, std::uint64_t column,
                           std::span<Ray<Real>> out) const {
  // From -1 at the bottom to 1.
  const double t = 1 - (2 * static_cast<double>(row) + 1) / static_cast<double>(height);
  const Vec upward = t * up;
  switch (kind) {
    case RayKind::Camera:
      across(column, width, out,
             [&, eye = convert<Real>(origin), ahead = forward, aside = right](double s) {
               return Ray<Real>{eye, convert<Real>(ahead + s * aside + upward)};
             });
      break;
    case RayKind::Grid:
      across(column, width, out,
             [&, ahead = convert<Real>(forward), centre = origin, aside = right](double s) {
               return Ray<Real>{convert<Real>(centre + s * aside + upward), ahead};
             });
      break;
    case RayKind::Lidar: {
      const double part =
          height == 1 ? 0.5 : static_cast<double>(row) / static_cast<double>(height - 1);
      const double tangent = highest + (lowest - highest) * part;
      const Vec3<Real> place = convert<Real>(origin);
      for (Ray<Real>& ray : out) {
        ray = {place, convert<Real>(turned(column++, width, right, up) + tangent * forward)};
      }
      break;
    }
    case RayKind::Sphere:
      break;
  }
}

template <class Real>
Ray<Real> MadeRays::chord(std::uint64_t i) const {
  for (Counter counter(seed, i);;) {
    const Vec from = on_sphere(counter), to = on_sphere(counter);
    const Ray<Real> chord = {convert<Real>(origin + forward.x * from), convert<Real>(to - from)};
    if (chord.direction != Vec3<Real>{0, 0, 0}) return chord;
  }
}

void MadeRays::write(io::JsonWriter& json) const {
  json.open_object("rays");
  json.value("kind", name_of(kind));
  json.value("width", width);
  json.value("height", height);
  json.value("seed", seed);
  tool::write(json, "origin", origin);
  tool::write(json, "forward", forward);
  tool::write(json, "right", right);
  tool::write(json, "up", up);
  json.value("lowest", lowest);
  json.value("highest", highest);
  json.close_object();
}

MadeRays MadeRays::read(const io::JsonView& json) {
  MadeRays rays;
  const std::string& kind = json.at("kind").text();
  bool known = false;
  for (const auto& [name, value] : kMadeKinds) {
    if (name == kind) rays.kind = value, known = true;
  }
  if (!known) json.fail("its kind of rays is none that this pierce makes");
  constexpr std::uint64_t kMost = std::uint64_t{1} << 48;
  rays.width = json.at("width").whole(kMost);
  rays.height = json.at("height").whole(kMost);
  if (rays.width == 0 || rays.height == 0 || rays.height > kMost / rays.width)
    json.fail("there are no rays, or too many");
  rays.seed = json.at("seed").whole();
  rays.origin = read_vector(json.at("origin"));
  rays.forward = read_vector(json.at("forward"));
  rays.right = read_vector(json.at("right"));
  rays.up = read_vector(json.at("up"));
  rays.lowest = json.at("lowest").number();
  rays.highest = json.at("highest").number();
  return rays;
}

template void MadeRays::make(std::uint64_t, std::span<Ray<float>>) const;
template void MadeRays::make(std::uint64_t, std::span<Ray<double>>) const;

}  // namespace pierce::tool
