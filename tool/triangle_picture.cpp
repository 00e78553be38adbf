// SPDX-License-Identifier: Apache-2.0
//
// pierce triangle --svg: the ray and the triangle in a drawing, obliquely: x to the right, z
// upwards, y away from the reader.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "pierce/vector.h"
#include "textbook/report.h"

namespace pierce::tool {
namespace drawn {  // a name of its own: sources are also compiled several in one run
namespace {

using Vec = Vec3<double>;

constexpr double kWidth = 560, kHeight = 380, kMargin = 40;
constexpr double kRight = 0.42, kUp = 0.3;  // what one unit of depth is in the picture

double length(const Vec& p) { return std::hypot(p.x, p.y, p.z); }

double largest(const Vec& p) { return std::max({std::abs(p.x), std::abs(p.y), std::abs(p.z)}); }

bool is_finite(const Vec& p) { return std::isfinite(length(p)); }

struct Scene {
  Vec a, b, c, o, end;
  std::optional<Vec> p;  // where the ray meets the plane, unless that is far away or behind it
};

// Of a size near 1, so that nothing is beyond the doubles.
Scene scene_of(const TriangleQuestion& question) {
  const auto& [a, b, c, ray] = question;
  const double size = std::max({largest(a), largest(b), largest(c), largest(ray.origin)});
  const double scale = size > 0 ? size : 1;
  const auto scaled = [](const Vec& v, double by) { return Vec{v.x / by, v.y / by, v.z / by}; };
  Scene scene = {
      scaled(a, scale), scaled(b, scale), scaled(c, scale), scaled(ray.origin, scale), {}, {}};
  Vec direction = scaled(ray.direction, largest(ray.direction));
  direction = scaled(direction, length(direction));
  const Vec n = cross(scene.b - scene.a, scene.c - scene.a);
  const double t = dot(n, scene.a - scene.o) / dot(n, direction);
  const Vec p = scene.o + t * direction;
  const double extent = std::max({length(scene.b - scene.a), length(scene.c - scene.a),
                                  length(scene.c - scene.b), length(scene.a - scene.o), 1e-3});
  if (is_finite(p) && t >= 0 && t <= 4 * extent) scene.p = p;
  scene.end = scene.o + (scene.p ? 1.3 * t + 0.2 * extent : 1.5 * extent) * direction;
  return scene;
}

class Drawing {
 public:
  explicit Drawing(const std::vector<Vec>& all) {
    constexpr double kInfinity = std::numeric_limits<double>::infinity();
    double low_x = kInfinity, low_y = kInfinity, high_x = -kInfinity, high_y = -kInfinity;
    for (const Vec& p : all) {
      const auto [x, y] = flat(p);
      low_x = std::min(low_x, x), high_x = std::max(high_x, x);
      low_y = std::min(low_y, y), high_y = std::max(high_y, y);
    }
    scale_ = std::min((kWidth - 2 * kMargin) / std::max(high_x - low_x, 1e-300),
                      (kHeight - 2 * kMargin) / std::max(high_y - low_y, 1e-300));
    middle_x_ = low_x / 2 + high_x / 2, middle_y_ = low_y / 2 + high_y / 2;
  }

  [[nodiscard]] std::string at(const Vec& p) const {
    const auto [x, y] = place(p);
    return fmt::format("{:.1f},{:.1f}", x, y);
  }
  void line(const Vec& from, const Vec& to, const char* style) {
    svg_ += fmt::format("  <polyline points=\"{} {}\" style=\"fill: none; {}\"/>\n", at(from),
                        at(to), style);
  }
  void triangle(const Vec& a, const Vec& b, const Vec& c) {
    svg_ += fmt::format(
        "  <polygon points=\"{} {} {}\" style=\"fill: #f0c36d; fill-opacity: 0.6; "
        "stroke: #1c1c1a; stroke-width: 1.5\"/>\n",
        at(a), at(b), at(c));
  }
  void dot(const Vec& p, const char* colour, const std::string& name, bool below = false) {
    const auto [x, y] = place(p);
    svg_ += fmt::format(
        "  <circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"5\" style=\"fill: {}\"/>\n"
        "  <text x=\"{:.1f}\" y=\"{:.1f}\">{}</text>\n",
        x, y, colour, below ? x - 18 : x + 9, below ? y + 20 : y - 8, name);
  }
  [[nodiscard]] const std::string& svg() const { return svg_; }

 private:
  static std::pair<double, double> flat(const Vec& p) {
    return {p.x + kRight * p.y, p.z + kUp * p.y};
  }
  [[nodiscard]] std::pair<double, double> place(const Vec& p) const {
    const auto [x, y] = flat(p);
    return {kWidth / 2 + (x - middle_x_) * scale_, kHeight / 2 - (y - middle_y_) * scale_};
  }

  double scale_ = 1, middle_x_ = 0, middle_y_ = 0;
  std::string svg_;
};

std::string picture(const TriangleQuestion& question) {
  const Scene scene = scene_of(question);
  std::vector<Vec> all = {scene.a, scene.b, scene.c, scene.o, scene.end};
  Drawing drawing(all);
  const std::string verdict = exact_verdict(question);
  const bool hit = verdict.starts_with("hit");
  constexpr const char* kRay = "stroke: #0b57a4; stroke-width: 2.5";
  constexpr const char* kBeyond = "stroke: #0b57a4; stroke-width: 2; stroke-dasharray: 5 4";
  if (scene.p) drawing.line(*scene.p, scene.end, kBeyond);
  drawing.triangle(scene.a, scene.b, scene.c);
  drawing.line(scene.o, scene.p ? *scene.p : scene.end, kRay);
  drawing.dot(scene.a, "#1c1c1a", "A");
  drawing.dot(scene.b, "#1c1c1a", "B");
  drawing.dot(scene.c, "#1c1c1a", "C");
  drawing.dot(scene.o, "#0b57a4", "O");
  if (scene.p) drawing.dot(*scene.p, hit ? "#1b6e36" : "#b3261e", "P", true);
  std::string words = verdict;
  for (std::size_t i; (i = words.find('<')) != std::string::npos;) words.replace(i, 1, "&lt;");
  for (std::size_t i; (i = words.find('>')) != std::string::npos;) words.replace(i, 1, "&gt;");
  return fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {0} {1}\" role=\"img\" "
      "font-family=\"sans-serif\" font-size=\"15\">\n"
      "  <title>{2}</title>\n"
      "  <rect width=\"{0}\" height=\"{1}\" style=\"fill: #fdfcf9\"/>\n{3}"
      "  <text x=\"12\" y=\"{4}\">{2}</text>\n</svg>\n",
      kWidth, kHeight, words, drawing.svg(), kHeight - 12);
}

}  // namespace
}  // namespace drawn

std::string triangle_picture(const TriangleQuestion& question) { return drawn::picture(question); }

}  // namespace pierce::tool
