// SPDX-License-Identifier: Apache-2.0
#include "textbook/steps.h"

#include <fmt/format.h>
#include <fmt/ostream.h>

#include <algorithm>
#include <ostream>
#include <type_traits>

#include "failure.h"
#include "pierce/textbook/baldwin_weber.h"
#include "pierce/textbook/determinants.h"
#include "pierce/textbook/watertight.h"

namespace pierce::tool {
namespace walks {  // a name of its own: sources are also compiled several in one run
namespace {

constexpr std::size_t kWidest = 26;  // of a fraction in the table; else a decimal
constexpr int kDigits = 20;          // of that decimal

template <class Real>
struct Recorder {
  using Vec = Vec3<Real>;
  const Ray<Real>& ray;
  const Vec &a, &b, &c;
  Steps<Real> steps = {};

  Real keep(std::string name, Real value) {
    steps.values.emplace_back(std::move(name), value);
    return value;
  }
  Vec keep(const std::string& name, Vec p) {
    keep(name + " x", p.x), keep(name + " y", p.y), keep(name + " z", p.z);
    return p;
  }
  // All that follow: whether the method leaves here, with a miss.
  bool rejects(bool when, std::string why) {
    if (when) steps.rejected = std::move(why);
    return when;
  }
  bool rejects_t(const Real& t) {
    keep("t", t);
    return rejects(!(ray.t_min <= t), "t < t_min") || rejects(!(t <= ray.t_max), "t > t_max");
  }
  bool rejects_u(const Real& u) {
    keep("u", u);
    return rejects(u < 0, "u < 0") || rejects(u > 1, "u > 1");
  }
  bool rejects_v(const Real& u, const Real& v) {
    keep("v", v);
    return rejects(v < 0, "v < 0") || rejects(u + v > 1, "u + v > 1");
  }
  void hits(Real t, Real u, Real v) { steps.hit = {t, u, v}; }
};

template <class Real>
void cramer(Recorder<Real>& r) {
  const auto [a, b, c] = r.keep("A - B", r.a - r.b);
  const auto [d, e, f] = r.keep("A - C", r.a - r.c);
  const auto& [g, h, i] = r.ray.direction;
  const auto [j, k, l] = r.keep("A - O", r.a - r.ray.origin);
  const Real ei_hf = r.keep("ei - hf", Real(e * i - h * f));
  const Real gf_di = r.keep("gf - di", Real(g * f - d * i));
  const Real dh_eg = r.keep("dh - eg", Real(d * h - e * g));
  const Real m = r.keep("M", Real(a * ei_hf + b * gf_di + c * dh_eg));
  if (r.rejects(m == 0, "M = 0")) return;
  const Real ak_jb = r.keep("ak - jb", Real(a * k - j * b));
  const Real jc_al = r.keep("jc - al", Real(j * c - a * l));
  const Real bl_kc = r.keep("bl - kc", Real(b * l - k * c));
  const Real t = -(f * ak_jb + e * jc_al + d * bl_kc) / m;
  if (r.rejects_t(t)) return;
  const Real gamma = r.keep("gamma", Real((i * ak_jb + h * jc_al + g * bl_kc) / m));
  if (r.rejects(gamma < 0, "gamma < 0") || r.rejects(gamma > 1, "gamma > 1")) return;
  const Real beta = r.keep("beta", Real((j * ei_hf + k * gf_di + l * dh_eg) / m));
  if (r.rejects(beta < 0, "beta < 0") || r.rejects(beta > 1 - gamma, "beta > 1 - gamma")) return;
  r.hits(t, beta, gamma);
}

template <class Real>
void determinants(Recorder<Real>& r) {
  using textbook::determinant;
  const auto a = r.keep("A = -Q", -r.ray.direction), b = r.keep("B = P1 - P0", r.b - r.a),
             c = r.keep("C = P2 - P0", r.c - r.a), d = r.keep("D = S - P0", r.ray.origin - r.a);
  const Real d0 = r.keep("D0", determinant(a, b, c));
  if (r.rejects(d0 == 0, "D0 = 0")) return;
  const Real t = r.keep("Dt", determinant(d, b, c)) / d0;
  if (r.rejects_t(t)) return;
  const Real u = r.keep("Du", determinant(a, d, c)) / d0;
  if (r.rejects_u(u)) return;
  const Real v = r.keep("Dv", determinant(a, b, d)) / d0;
  if (r.rejects_v(u, v)) return;
  r.hits(t, u, v);
}

template <class Real>
void plane_then_edges(Recorder<Real>& r) {
  const auto n = r.keep("N", cross(r.b - r.a, r.c - r.a));
  const Real n_d = r.keep("N.D", dot(n, r.ray.direction));
  if (r.rejects(n_d == 0, "N.D = 0")) return;
  const Real t = r.keep("N.(A - O)", dot(n, r.a - r.ray.origin)) / n_d;
  if (r.rejects_t(t)) return;
  const auto p = r.keep("P", r.ray.origin + t * r.ray.direction);
  const auto rejects_side = [&](const char* edge, Real side) {
    return r.rejects(r.keep(fmt::format("side of {}", edge), side) < 0,
                     fmt::format("side of {} < 0", edge));
  };
  const Real ab = dot(n, cross(r.b - r.a, p - r.a));
  if (rejects_side("AB", ab)) return;
  if (rejects_side("BC", dot(n, cross(r.c - r.b, p - r.b)))) return;
  const Real ca = dot(n, cross(r.a - r.c, p - r.c));
  if (rejects_side("CA", ca)) return;
  const Real n_n = r.keep("N.N", dot(n, n));
  const Real u = r.keep("u", Real(ca / n_n)), v = r.keep("v", Real(ab / n_n));
  r.hits(t, u, v);
}

template <class Real>
void plane_then_barycentric(Recorder<Real>& r) {
  const auto e1 = r.keep("E1", r.b - r.a), e2 = r.keep("E2", r.c - r.a);
  const auto n = r.keep("N", cross(e1, e2));
  const Real n_d = r.keep("N.D", dot(n, r.ray.direction));
  if (r.rejects(n_d == 0, "N.D = 0")) return;
  const Real t = r.keep("N.(A - O)", dot(n, r.a - r.ray.origin)) / n_d;
  if (r.rejects_t(t)) return;
  const auto p = r.keep("P - A", r.ray.origin + t * r.ray.direction - r.a);
  const int dropped = longest_axis(n);
  const int x = (dropped + 1) % 3, y = (dropped + 2) % 3;
  const auto flat = [x, y](const Vec3<Real>& q, const Vec3<Real>& s) -> Real {
    return component(q, x) * component(s, y) - component(q, y) * component(s, x);
  };
  const Real area = component(n, dropped);
  const Real u = r.keep("u", Real(flat(p, e2) / area));
  if (r.rejects(u < 0, "u < 0")) return;
  const Real v = flat(e1, p) / area;
  if (r.rejects_v(u, v)) return;
  r.hits(t, u, v);
}

template <class Real>
void moller_trumbore(Recorder<Real>& r) {
  const auto e1 = r.keep("e1 = B - A", r.b - r.a), e2 = r.keep("e2 = C - A", r.c - r.a);
  const auto q = r.keep("q = D x e2", cross(r.ray.direction, e2));
  const Real det = r.keep("e1.q", dot(e1, q));
  const Real limit = static_cast<Real>(1e-5);
  if (r.rejects(det == 0, "e1.q = 0")) return;
  if (r.rejects(-limit < det && det < limit, "|e1.q| < epsilon = 1e-5")) return;
  const Real f = r.keep("f = 1 / e1.q", Real(1 / det));
  const auto s = r.keep("s = O - A", r.ray.origin - r.a);
  const Real u = f * dot(s, q);
  if (r.rejects_u(u)) return;
  const auto w = r.keep("r = s x e1", cross(s, e1));
  const Real v = f * dot(w, r.ray.direction);
  if (r.rejects_v(u, v)) return;
  const Real t = f * dot(w, e2);
  if (r.rejects_t(t)) return;
  r.hits(t, u, v);
}

template <class Real>
void precomputed_normal(Recorder<Real>& r) {
  const auto e1 = r.keep("e1", r.b - r.a), e2 = r.keep("e2", r.c - r.a);
  const auto n = r.keep("n = e1 x e2", cross(e1, e2));
  const Real minus_n_d = r.keep("-n.D", Real(-dot(n, r.ray.direction)));
  if (r.rejects(minus_n_d == 0, "-n.D = 0")) return;
  const auto s = r.keep("s = O - A", r.ray.origin - r.a);
  const Real t = dot(n, s) / minus_n_d;
  if (r.rejects_t(t)) return;
  const auto m = r.keep("m = s x D", cross(s, r.ray.direction));
  const Real u = dot(m, e2) / minus_n_d;
  if (r.rejects_u(u)) return;
  const Real v = -dot(m, e1) / minus_n_d;
  if (r.rejects_v(u, v)) return;
  r.hits(t, u, v);
}

template <class Real>
void watertight(Recorder<Real>& r) {
  const textbook::ShearedRay<Real> sheared(r.ray);
  const auto& [ray, kx, ky, kz, ray_x, ray_y, ray_z] = sheared;
  const Real sx = r.keep("Sx", ray_x), sy = r.keep("Sy", ray_y), sz = r.keep("Sz", ray_z);
  const int x = kx, y = ky, z = kz;
  const auto shear = [&](const char* name, const Vec3<Real>& corner) {
    const Vec3<Real> p = corner - r.ray.origin;
    return Vec3<Real>{
        r.keep(fmt::format("{}x", name), Real(component(p, x) - sx * component(p, z))),
        r.keep(fmt::format("{}y", name), Real(component(p, y) - sy * component(p, z))),
        Real(sz * component(p, z))};
  };
  const Vec3<Real> a = shear("A", r.a), b = shear("B", r.b), c = shear("C", r.c);
  const auto edge = [](const Vec3<Real>& p, const Vec3<Real>& q, auto wide) {
    using Wide = decltype(wide);
    return static_cast<Real>(Wide(p.x) * Wide(q.y) - Wide(p.y) * Wide(q.x));
  };
  Real u = edge(c, b, Real()), v = edge(a, c, Real()), w = edge(b, a, Real());
  if (u == 0 || v == 0 || w == 0) {
    using Wide = textbook::Wider<Real>;
    u = edge(c, b, Wide()), v = edge(a, c, Wide()), w = edge(b, a, Wide());
  }
  r.keep("U", u), r.keep("V", v), r.keep("W", w);
  const bool any_below = u < 0 || v < 0 || w<0, any_above = u> 0 || v > 0 || w > 0;
  if (r.rejects(any_below && any_above, "the signs of U, V, W differ")) return;
  const Real det = r.keep("U + V + W", Real(u + v + w));
  if (r.rejects(det == 0, "U + V + W = 0")) return;
  const Real f = 1 / det;
  const Real t = (u * a.z + v * b.z + w * c.z) * f;
  if (r.rejects_t(t)) return;
  const Real hit_u = r.keep("u", Real(v * f)), hit_v = r.keep("v", Real(w * f));
  r.hits(t, hit_u, hit_v);
}

template <class Real>
void baldwin_weber(Recorder<Real>& r) {
  const textbook::AffineTriangle<Real> triangle(r.a, r.b, r.c);
  if (r.rejects(triangle.k < 0, "N = 0")) return;
  const int k = triangle.k, i = triangle.next(k), j = triangle.next(i);
  const auto row = [&r](const char* name, const std::array<Real, 3>& map) {
    for (std::size_t n = 0; n < 3; ++n) r.keep(fmt::format("map to {}, {}", name, n + 1), map[n]);
    return map;
  };
  const auto to_u = row("u", triangle.u), to_v = row("v", triangle.v), to_z = row("z", triangle.z);
  const Vec3<Real>&o = r.ray.origin, &d = r.ray.direction;
  const Real z_d =
      r.keep("z(D)", Real(component(d, k) + to_z[0] * component(d, i) + to_z[1] * component(d, j)));
  if (r.rejects(z_d == 0, "z(D) = 0")) return;
  const Real z_o = r.keep("z(O)", Real(component(o, k) + to_z[0] * component(o, i) +
                                       to_z[1] * component(o, j) + to_z[2]));
  const Real t = -z_o / z_d;
  if (r.rejects_t(t)) return;
  const Real pi = component(o, i) + t * component(d, i), pj = component(o, j) + t * component(d, j);
  const Real u = to_u[0] * pi + to_u[1] * pj + to_u[2];
  if (r.rejects_u(u)) return;
  const Real v = to_v[0] * pi + to_v[1] * pj + to_v[2];
  if (r.rejects_v(u, v)) return;
  r.hits(t, u, v);
}

template <class Real>
std::string shown(const Steps<Real>& steps, std::size_t row) {
  if (row >= steps.values.size()) return "";
  const Real& x = steps.values[row].second;
  if constexpr (std::is_same_v<Real, Fraction>) {
    const std::string text = as_fraction(x);
    return text.size() <= kWidest ? text : "~ " + as_decimal(x, kDigits);
  } else {
    return fmt::format("{}", x);
  }
}

template <class Real>
void print_end(const char* type, const Steps<Real>& steps, std::ostream& out) {
  fmt::print(out, "{}: {}\n", type,
             steps.hit ? std::string("hit") : fmt::format("miss, since {}", steps.rejected));
}

template <class Real>
Steps<Real> walk(std::string_view method, const Pair<Real>& pair) {
  using Walk = void (*)(Recorder<Real>&);
  constexpr std::array<Walk, kStepMethods.size()> kWalks = {
      &cramer,          &determinants,       &plane_then_edges, &plane_then_barycentric,
      &moller_trumbore, &precomputed_normal, &watertight,       &baldwin_weber};
  Recorder<Real> recorder = {pair.ray, pair.a, pair.b, pair.c};
  const auto at = std::find(kStepMethods.begin(), kStepMethods.end(), method);
  kWalks.at(static_cast<std::size_t>(at - kStepMethods.begin()))(recorder);
  return recorder.steps;
}

}  // namespace
}  // namespace walks

template <class Real>
Steps<Real> steps_of(std::string_view method, const Pair<Real>& pair) {
  return walks::walk(method, pair);
}

void run_steps(std::string_view method, const TriangleQuestion& question, std::ostream& out) {
  if (std::find(kStepMethods.begin(), kStepMethods.end(), method) == kStepMethods.end()) {
    throw UsageError(fmt::format("--steps: '{}' is no method that has steps; give one of {}",
                                 method, fmt::join(kStepMethods, ", ")));
  }
  const auto over = [&]<class Real>(Real) {
    const auto& [a, b, c, ray] = question;
    return steps_of<Real>(
        method, {convert<Real>(ray), convert<Real>(a), convert<Real>(b), convert<Real>(c)});
  };
  const auto floats = over(0.0f);
  const auto doubles = over(0.0);
  const auto fractions = over(Fraction(0));
  fmt::print(out, "\n{}, step by step:\n{:<16}{:<20}{:<26}{}\n", method, "value", "in float",
             "in double", "exactly");
  const std::size_t rows =
      std::max({floats.values.size(), doubles.values.size(), fractions.values.size()});
  for (std::size_t i = 0; i < rows; ++i) {
    const std::string& name = i < fractions.values.size() ? fractions.values[i].first
                              : i < doubles.values.size() ? doubles.values[i].first
                                                          : floats.values[i].first;
    std::string line = fmt::format("{:<16}{:<20}{:<26}{}", name, walks::shown(floats, i),
                                   walks::shown(doubles, i), walks::shown(fractions, i));
    line.erase(line.find_last_not_of(' ') + 1);
    fmt::print(out, "{}\n", line);
  }
  walks::print_end("in float", floats, out);
  walks::print_end("in double", doubles, out);
  walks::print_end("exactly", fractions, out);
}

template Steps<float> steps_of(std::string_view, const Pair<float>&);
template Steps<double> steps_of(std::string_view, const Pair<double>&);
template Steps<Fraction> steps_of(std::string_view, const Pair<Fraction>&);

}  // namespace pierce::tool
