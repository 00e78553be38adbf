// SPDX-License-Identifier: Apache-2.0
//
// What one ray and one triangle cost on each rung of the ladder, beside a plain double
// Moeller-Trumbore, GMP rationals and CGAL's do_intersect on the same cases. Time is per case.
// First every answer is compared with that of the rationals: `wrong` says how many of `cases`
// differ, `unsure` of how many the double rung says that it does not know.
//
//   bench/micro_predicate --benchmark_repetitions=9 --benchmark_report_aggregates_only=true
//
// scripts/ladder_figures.py makes the table of docs/decisions/0002-ladder.md from it.
#include <benchmark/benchmark.h>
#include <gmpxx.h>

#include <stdexcept>

#include "kernels/kernel.h"
#include "micro/micro_cases.h"
#include "micro/peers.h"
#include "pierce/textbook/moller_trumbore.h"
#include "predicate/decide.h"
#include "predicate/settle.h"
#include "scene/rays/hit_rounding.h"

namespace pierce::bench {
namespace {

using predicate::Certified;

using Cases = std::vector<Case>;
using Make = Cases (*)();

Ray<double> plain_ray(const Case& c) { return {c.ray.origin, c.ray.direction}; }

bool rational_hit(const Case& c) {
  const Ray<mpq_class> ray{convert<mpq_class>(c.ray.origin), convert<mpq_class>(c.ray.direction)};
  const auto corner = [](const Double3& p) { return convert<mpq_class>(p); };
  return textbook::moller_trumbore(ray, corner(c.triangle.a), corner(c.triangle.b),
                                   corner(c.triangle.c), 0)
      .has_value();
}

// Runs `answer(i)` on case after case.
template <class Answer>
void time_cases(benchmark::State& state, const Cases& cases, const Answer& answer) {
  state.counters["cases"] = static_cast<double>(cases.size());
  std::size_t i = 0;
  for (auto _ : state) {
    benchmark::DoNotOptimize(answer(i));
    if (++i == cases.size()) i = 0;
  }
}

// The same for a method that says whether a case is a hit, true or not.
template <class Answer>
void time_hits(benchmark::State& state, const Cases& cases, const Answer& answer) {
  std::size_t wrong = 0;
  for (std::size_t i = 0; i < cases.size(); ++i) wrong += answer(i) != rational_hit(cases[i]);
  state.counters["wrong"] = static_cast<double>(wrong);
  time_cases(state, cases, answer);
}

// Only those that hit: no method can leave early.
template <class Real>
Cases hits() {
  Cases cases = ordinary_cases<Real>();
  std::erase_if(cases, [](const Case& c) { return !settle_hit(c.ray, c.triangle).hit; });
  return cases;
}

void plain_moller_trumbore(benchmark::State& state, Make make) {
  const Cases cases = make();
  time_hits(state, cases, [&](std::size_t i) {
    const predicate::TriangleD& t = cases[i].triangle;
    return textbook::moller_trumbore(plain_ray(cases[i]), t.a, t.b, t.c, 0).has_value();
  });
}

void certify(benchmark::State& state, Make make) {
  const Cases cases = make();
  const auto answer = [&](std::size_t i) {
    return certify_hit(filter_determinants(cases[i].ray, cases[i].triangle), cases[i].ray);
  };
  std::size_t unsure = 0, wrong = 0;
  for (std::size_t i = 0; i < cases.size(); ++i) {
    const Certified said = answer(i);
    unsure += said == Certified::Unsure;
    wrong += said != Certified::Unsure && said != predicate::certified(rational_hit(cases[i]));
  }
  state.counters["unsure"] = static_cast<double>(unsure);
  state.counters["wrong"] = static_cast<double>(wrong);
  time_cases(state, cases, answer);
}

// Cases that certify leaves open, so that this is what the exact rung really meets.
template <class Real>
Cases unsure_cases() {
  Cases cases;
  for (const Case& c : hard_cases<Real>())
    if (certify_hit(filter_determinants(c.ray, c.triangle), c.ray) == Certified::Unsure)
      cases.push_back(c);
  if (cases.size() < kCases / 4) throw std::logic_error("hard cases are not hard");
  return cases;
}

void settle(benchmark::State& state, Make make) {
  const Cases cases = make();
  time_hits(state, cases,
            [&](std::size_t i) { return settle_hit(cases[i].ray, cases[i].triangle).hit; });
}

void gmp_rational(benchmark::State& state, Make make) {
  const Cases cases = make();
  time_cases(state, cases, [&](std::size_t i) { return rational_hit(cases[i]); });
}

// `answer` gives a hit's numbers, which must be those of exact arithmetic.
template <class Real, class Answer>
void time_rounding(benchmark::State& state, const Cases& cases, const Answer& answer) {
  std::size_t wrong = 0;
  for (std::size_t i = 0; i < cases.size(); ++i) {
    const Hit<Real> hit = answer(i);
    const auto truth = predicate::settle_numbers<Real>(cases[i].ray, cases[i].triangle);
    wrong += hit.t != truth.t || hit.u != truth.u || hit.v != truth.v || hit.w != truth.w;
  }
  state.counters["wrong"] = static_cast<double>(wrong);
  time_cases(state, cases, answer);
}

template <class Real>
void round(benchmark::State& state) {
  predicate::LadderCounts counts;
  const kernels::Kernel& kernel = kernels::active_kernel();
  const Cases cases = hits<Real>();
  time_rounding<Real>(state, cases, [&](std::size_t i) {
    return scene::round_one<Real>(kernel, cases[i].ray, cases[i].triangle, 0, counts);
  });
}

// The same in batches; the time is that of one hit.
template <class Real>
void round_batch(benchmark::State& state) {
  const Cases cases = hits<Real>();
  const kernels::Kernel& kernel = kernels::active_kernel();
  kernels::HitColumns columns;
  kernels::RoundedColumns<Real> out;
  std::size_t next = 0;
  const auto put = [&](std::size_t row, std::size_t i, const Vec3<double>& p) {
    columns.number[row][i] = p.x;
    columns.number[row + 1][i] = p.y;
    columns.number[row + 2][i] = p.z;
  };
  while (state.KeepRunningBatch(kernels::kRoundBatch)) {
    for (std::size_t i = 0; i < kernels::kRoundBatch; ++i, next = (next + 1) % cases.size()) {
      const Case& c = cases[next];
      put(0, i, c.triangle.a);
      put(3, i, c.triangle.b);
      put(6, i, c.triangle.c);
      put(9, i, c.ray.origin);
      put(12, i, c.ray.direction);
    }
    kernel.of<Real>().round(columns, kernels::kRoundBatch, out);
    benchmark::DoNotOptimize(out);
  }
}

template <class Real>
void decide_and_round(benchmark::State& state) {
  predicate::LadderCounts counts;
  const kernels::Kernel& kernel = kernels::active_kernel();
  const Cases cases = hits<Real>();
  time_rounding<Real>(state, cases, [&](std::size_t i) {
    const Case& c = cases[i];
    predicate::DecidedHit hit;
    decide_hit(c.ray, c.triangle, hit, counts);
    return scene::round_one<Real>(kernel, c.ray, c.triangle, hit.zeros, counts);
  });
}

BENCHMARK_CAPTURE(plain_moller_trumbore, mixed, ordinary_cases<float>);
BENCHMARK_CAPTURE(certify, mixed, ordinary_cases<float>);
BENCHMARK_CAPTURE(plain_moller_trumbore, hits, hits<float>);
BENCHMARK_CAPTURE(plain_moller_trumbore, hard_float, unsure_cases<float>);
BENCHMARK_CAPTURE(plain_moller_trumbore, hard_double, unsure_cases<double>);
BENCHMARK_CAPTURE(certify, hits, hits<float>);
BENCHMARK_CAPTURE(settle, hard_float, unsure_cases<float>);
BENCHMARK_CAPTURE(settle, hard_double, unsure_cases<double>);
BENCHMARK_CAPTURE(settle, ordinary_double, ordinary_cases<double>);
BENCHMARK_CAPTURE(settle, wild_double, wild_cases);
BENCHMARK(round<float>);
BENCHMARK(round<double>);
BENCHMARK(round_batch<float>);
BENCHMARK(round_batch<double>);
BENCHMARK(decide_and_round<float>);
BENCHMARK(decide_and_round<double>);
BENCHMARK_CAPTURE(gmp_rational, ordinary, ordinary_cases<float>);
BENCHMARK_CAPTURE(gmp_rational, hard_float, unsure_cases<float>);
BENCHMARK_CAPTURE(gmp_rational, hard_double, unsure_cases<double>);
BENCHMARK_CAPTURE(gmp_rational, wild_double, wild_cases);

#ifdef PIERCE_BENCH_CGAL
void cgal_do_intersect(benchmark::State& state, Make make) {
  const Cases cases = make();
  const CgalCases ready(cases);
  time_hits(state, cases, [&](std::size_t i) { return ready.intersects(i); });
}
BENCHMARK_CAPTURE(cgal_do_intersect, ordinary, ordinary_cases<float>);
BENCHMARK_CAPTURE(cgal_do_intersect, hard_float, unsure_cases<float>);
BENCHMARK_CAPTURE(cgal_do_intersect, hard_double, unsure_cases<double>);
BENCHMARK_CAPTURE(cgal_do_intersect, wild_double, wild_cases);
#endif

}  // namespace
}  // namespace pierce::bench

BENCHMARK_MAIN();
