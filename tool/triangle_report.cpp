// SPDX-License-Identifier: Apache-2.0
//
// pierce triangle: one ray, one triangle, every textbook method beside the exact answer.
#include <fmt/format.h>
#include <fmt/ostream.h>

#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <ostream>
#include <sstream>
#include <string>
#include <string_view>
#include <type_traits>

#include "failure.h"
#include "fractions.h"
#include "pierce/barycentric.h"
#include "pierce/intersect.h"
#include "pierce/textbook.h"
#include "textbook/report.h"
#include "textbook/times.h"

namespace pierce::tool {
namespace {

constexpr int kDigits = 20;  // of the decimals beside the fractions

// All that is true of a pair. t, u, v exist unless the ray is parallel to the plane.
struct Truth {
  std::optional<TextbookHit<Fraction>> at;
  bool hit = false;
  bool front = false;
  std::string verdict;
};

std::string place(const TextbookHit<Fraction>& at) {
  const std::array<Fraction, 3> weights = {1 - at.u - at.v, at.u, at.v};
  const auto corners = *carrier(weights);
  std::string names;
  for (std::size_t i = 0; i < 3; ++i) {
    if (corners[i]) names += "abc"[i];
  }
  switch (corners.count()) {
    case 1:
      return "exactly at the vertex " + names;
    case 2:
      return "exactly on the edge " + names;
    default:
      return "inside";
  }
}

std::string outside(const TextbookHit<Fraction>& at, const Ray<Fraction>& ray) {
  std::string why;
  const auto add = [&why](bool fails, std::string_view text) {
    if (fails) why += (why.empty() ? "" : ", ") + std::string(text);
  };
  add(at.u < 0, "u < 0");
  add(at.v < 0, "v < 0");
  add(at.u + at.v > 1, "w < 0");
  add(!(ray.t_min <= at.t), "t < t_min");
  add(!(at.t <= ray.t_max), "t > t_max");
  return why;
}

template <class Real>
Truth truth_of(const Pair<Real>& pair) {
  const Ray<Fraction> ray = convert<Fraction>(pair.ray);
  const auto a = convert<Fraction>(pair.a), b = convert<Fraction>(pair.b),
             c = convert<Fraction>(pair.c);
  const Vec3<Fraction> n = cross(b - a, c - a);
  const Fraction n_d = dot(n, ray.direction);
  Truth truth;
  truth.front = n_d < 0;
  if (n_d == 0) {
    truth.verdict = dot(n, n) == 0 ? "miss: the triangle has no area"
                    : dot(n, ray.origin - a) == 0
                        ? "miss: the ray lies in the plane of the triangle (N.d = 0)"
                        : "miss: the ray is parallel to the plane (N.d = 0)";
    return truth;
  }
  const Vec3<Fraction> s = ray.origin - a, m = cross(s, ray.direction);
  truth.at = {-dot(n, s) / n_d, -dot(m, c - a) / n_d, dot(m, b - a) / n_d};
  truth.hit = textbook::cramer(ray, a, b, c).has_value();
  truth.verdict = truth.hit ? fmt::format("hit, {}, {}", place(*truth.at),
                                          truth.front ? "from the front" : "from the back")
                            : "miss: " + outside(*truth.at, ray);
  return truth;
}

void print_truth(const Truth& truth, std::string_view title, std::ostream& out) {
  fmt::print(out, "{}: {}\n", title, truth.verdict);
  if (!truth.at) return;
  const Fraction w = 1 - truth.at->u - truth.at->v;
  const std::pair<char, const Fraction*> rows[] = {
      {'t', &truth.at->t}, {'u', &truth.at->u}, {'v', &truth.at->v}, {'w', &w}};
  for (const auto& [name, x] : rows) {
    fmt::print(out, "  {} = {}\n", name, as_fraction(*x));
    if (denominator(*x) == 1) continue;
    fmt::print(out, "    {} {}   nearest double {}, nearest float {}\n",
               is_decimal(*x, kDigits) ? '=' : '~', as_decimal(*x, kDigits), nearest<double>(*x),
               nearest<float>(*x));
  }
}

std::string_view verdict_of(bool hit, bool expected, bool culled) {
  if (hit == expected) return culled ? "right (the back is culled)" : "right";
  return expected ? "WRONG: misses it" : "WRONG: a false hit";
}

struct Score {
  int wrong = 0, total = 0;
};

template <class AnyHit>  // a TextbookHit or a Hit
void print_row(std::string_view method, std::string_view type, const std::optional<AnyHit>& hit,
               const Truth& truth, bool culled, Score& score, std::ostream& out) {
  const bool expected = truth.hit && !culled;
  ++score.total;
  if (hit.has_value() != expected) ++score.wrong;

  std::string numbers = fmt::format("{:<46}", "miss");
  if (hit) {
    const auto plain = [](auto x) { return std::isnan(x) ? std::abs(x) : x; };  // nan, not -nan
    numbers =
        fmt::format("{:<16.10g}{:<15.9g}{:<15.9g}", plain(hit->t), plain(hit->u), plain(hit->v));
  }
  std::string errors;
  if (hit && expected) {
    errors = fmt::format("{:.3g}, {:.3g}, {:.3g}", error_in_ulp(hit->t, reference(truth.at->t)),
                         error_in_ulp(hit->u, reference(truth.at->u)),
                         error_in_ulp(hit->v, reference(truth.at->v)));
  }
  fmt::print(out, "{:<35}{:<12}{}{:<26}{}\n", method, type, numbers, errors,
             verdict_of(hit.has_value(), expected, culled));
}

template <class Real, class Input>
void print_rows(const Pair<Input>& pair, const Truth& truth, std::string_view type, Score& score,
                std::ostream& out) {
  const auto ray = convert<Real>(pair.ray);
  const auto a = convert<Real>(pair.a), b = convert<Real>(pair.b), c = convert<Real>(pair.c);
  for (const textbook::Method<Real>& method : textbook::methods<Real>()) {
    const bool culled = method.front_only && truth.hit && !truth.front;
    print_row(method.name, type, method.test(ray, a, b, c), truth, culled, score, out);
  }
  if constexpr (!std::is_same_v<Real, long double>) {
    print_row("pierce::intersect", type, intersect(ray, a, b, c), truth, false, score, out);
  }
}

void require_finite(const Vec3<double>& p, ErrorCode code, const char* what) {
  if (std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z)) return;
  throw Error(
      code, fmt::format("{} ({}, {}, {}) is not finite; give finite numbers", what, p.x, p.y, p.z));
}

// The numbers rounded to float, if they still make a ray and a triangle.
std::optional<Pair<float>> rounded(const Pair<double>& pair) {
  const Pair<float> result = {convert<float>(pair.ray), convert<float>(pair.a),
                              convert<float>(pair.b), convert<float>(pair.c)};
  const auto finite = [](const Vec3<float>& p) {
    return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z);
  };
  const Vec3<float>& d = result.ray.direction;
  if (finite(result.a) && finite(result.b) && finite(result.c) && finite(result.ray.origin) &&
      finite(d) && d != Vec3<float>{0, 0, 0}) {
    return result;
  }
  return std::nullopt;
}

bool is_same(const Pair<float>& x, const Pair<double>& y) {
  const auto same = [](const Vec3<float>& p, const Vec3<double>& q) {
    return convert<double>(p) == q;
  };
  const Ray<double> ray = convert<double>(x.ray);
  return same(x.a, y.a) && same(x.b, y.b) && same(x.c, y.c) && ray.origin == y.ray.origin &&
         ray.direction == y.ray.direction && ray.t_min == y.ray.t_min && ray.t_max == y.ray.t_max;
}

}  // namespace

TriangleQuestion triangle_question(std::span<const double> triangle, std::span<const double> ray) {
  if (triangle.size() != 9) {
    throw UsageError(fmt::format("--triangle: needs 9 numbers, has {}", triangle.size()));
  }
  if (ray.size() != 6 && ray.size() != 8) {
    throw UsageError(
        fmt::format("--ray: needs 6 numbers, or 8 with t_min and t_max; has {}", ray.size()));
  }
  const auto vec = [](std::span<const double> x) { return Vec3<double>{x[0], x[1], x[2]}; };
  TriangleQuestion question = {vec(triangle),
                               vec(triangle.subspan(3)),
                               vec(triangle.subspan(6)),
                               {vec(ray), vec(ray.subspan(3))}};
  if (ray.size() == 8) {
    question.ray.t_min = ray[6];
    question.ray.t_max = ray[7];
  }
  require_finite(question.a, ErrorCode::NonFiniteVertex, "--triangle: vertex a");
  require_finite(question.b, ErrorCode::NonFiniteVertex, "--triangle: vertex b");
  require_finite(question.c, ErrorCode::NonFiniteVertex, "--triangle: vertex c");
  require_finite(question.ray.origin, ErrorCode::InvalidRay, "--ray: the origin");
  require_finite(question.ray.direction, ErrorCode::InvalidRay, "--ray: the direction");
  if (question.ray.direction == Vec3<double>{0, 0, 0}) {
    throw Error(ErrorCode::InvalidRay, "--ray: the direction is zero; give one that is not");
  }
  if (std::isnan(question.ray.t_min) || std::isnan(question.ray.t_max)) {
    throw Error(ErrorCode::InvalidRay, "--ray: t_min or t_max is NaN; give numbers");
  }
  return question;
}

void run_triangle(const TriangleQuestion& question, std::ostream& out) {
  const auto& [a, b, c, ray] = question;
  const auto text = [](const Vec3<double>& p) {
    return fmt::format("({}, {}, {})", p.x, p.y, p.z);
  };
  fmt::print(out, "triangle: a = {}, b = {}, c = {}\n", text(a), text(b), text(c));
  fmt::print(out, "ray: {} + t {}, {} <= t <= {}\n\n", text(ray.origin), text(ray.direction),
             ray.t_min, ray.t_max);

  const Pair<double> pair = {ray, a, b, c};
  const Truth truth = truth_of(pair);
  print_truth(truth, "exact", out);

  const std::optional<Pair<float>> float_pair = rounded(pair);
  Truth float_truth = truth;
  if (!float_pair) {
    fmt::print(out, "\nSome of these numbers are beyond the range of float: no float rows.\n");
  } else if (!is_same(*float_pair, pair)) {
    float_truth = truth_of(*float_pair);
    fmt::print(out,
               "\nNot all of these numbers are floats. The float rows answer for the numbers "
               "rounded to float:\n");
    print_truth(float_truth, "exact, of the rounded numbers", out);
  }

  Score score;
  std::ostringstream rows;
  if (float_pair) print_rows<float>(*float_pair, float_truth, "float", score, rows);
  print_rows<double>(pair, truth, "double", score, rows);
  print_rows<long double>(pair, truth, "long double", score, rows);
  fmt::print(out, "\n{} of {} decisions are wrong:\n", score.wrong, score.total);
  fmt::print(out, "{:<35}{:<12}{:<16}{:<15}{:<15}{:<26}{}\n", "method", "type", "t", "u", "v",
             "off by (ulp of t, u, v)", "decision");
  out << rows.str();
}

std::string exact_verdict(const TriangleQuestion& question) {
  const auto& [a, b, c, ray] = question;
  return truth_of<double>({ray, a, b, c}).verdict;
}

}  // namespace pierce::tool
