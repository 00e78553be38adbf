// SPDX-License-Identifier: Apache-2.0
//
// What one ray and one triangle cost on each rung of the ladder, beside a plain double
// Moeller-Trumbore, GMP rationals and CGAL's do_intersect on the same cases. Time is per case.
//
//   bench/micro_predicate --benchmark_repetitions=9 --benchmark_report_aggregates_only=true
#include <benchmark/benchmark.h>
#include <gmpxx.h>

#include <stdexcept>

#include "kernels/kernel.h"
#include "micro/micro_cases.h"
#include "micro/peers.h"
#include "pierce/textbook/moller_trumbore.h"
#include "predicate/decide.h"
#include "predicate/settle.h"

namespace pierce::bench {
namespace {

using predicate::Certified;

Ray<double> plain_ray(const Case& c) { return {c.ray.origin, c.ray.direction}; }

// Runs `work` on case after case.
template <class Work>
void each_case(benchmark::State& state, const std::vector<Case>& cases, const Work& work) {
  std::size_t i = 0;
  for (auto _ : state) {
    benchmark::DoNotOptimize(work(cases[i]));
    i = (i + 1) % cases.size();
  }
}

// Only those that hit: no method can leave early.
template <class Real>
std::vector<Case> hits() {
  std::vector<Case> cases = ordinary_cases<Real>();
  std::erase_if(cases, [](const Case& c) { return !settle_hit(c.ray, c.triangle).hit; });
  return cases;
}

using Cases = std::vector<Case> (*)();

void plain_moller_trumbore(benchmark::State& state, Cases cases) {
  each_case(state, cases(), [](const Case& c) {
    return textbook::moller_trumbore(plain_ray(c), c.triangle.a, c.triangle.b, c.triangle.c, 0)
        .has_value();
  });
}

void certify(benchmark::State& state, Cases cases) {
  each_case(state, cases(), [](const Case& c) {
    return certify_hit(filter_determinants(c.ray, c.triangle), c.ray);
  });
}

// Cases that certify leaves open, so that this is what the exact rung really meets.
template <class Real>
std::vector<Case> unsure_cases() {
  std::vector<Case> cases;
  for (const Case& c : hard_cases<Real>())
    if (certify_hit(filter_determinants(c.ray, c.triangle), c.ray) == Certified::Unsure)
      cases.push_back(c);
  if (cases.size() < kCases / 4) throw std::logic_error("hard cases are not hard");
  return cases;
}

void settle(benchmark::State& state, Cases cases) {
  each_case(state, cases(), [](const Case& c) { return settle_hit(c.ray, c.triangle).hit; });
}

// A hit's numbers as a scene computes them: by the kernel, and without it where that is not sure.
template <class Real>
Hit<Real> rounded(const kernels::Kernel& kernel, const Case& c, std::uint8_t zeros,
                  predicate::LadderCounts& counts) {
  Hit<Real> hit;
  if (kernel.round_one(c.ray, c.triangle, hit)) return hit;
  return predicate::round_hit<Real>(c.ray, c.triangle, zeros, counts);
}

template <class Real>
void round(benchmark::State& state) {
  predicate::LadderCounts counts;
  const kernels::Kernel& kernel = kernels::active_kernel();
  each_case(state, hits<Real>(),
            [&](const Case& c) { return rounded<Real>(kernel, c, 0, counts); });
}

// The same in batches; the time is that of one hit.
template <class Real>
void round_batch(benchmark::State& state) {
  const std::vector<Case> cases = hits<Real>();
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
    kernel.round(columns, kernels::kRoundBatch, out);
    benchmark::DoNotOptimize(out);
  }
}

template <class Real>
void decide_and_round(benchmark::State& state) {
  predicate::LadderCounts counts;
  const kernels::Kernel& kernel = kernels::active_kernel();
  each_case(state, hits<Real>(), [&](const Case& c) {
    predicate::DecidedHit hit;
    decide_hit(c.ray, c.triangle, hit, counts);
    return rounded<Real>(kernel, c, hit.zeros, counts);
  });
}

void gmp_rational(benchmark::State& state, Cases cases) {
  each_case(state, cases(), [](const Case& c) {
    const Ray<mpq_class> ray{convert<mpq_class>(c.ray.origin), convert<mpq_class>(c.ray.direction)};
    return textbook::moller_trumbore(ray, convert<mpq_class>(c.triangle.a),
                                     convert<mpq_class>(c.triangle.b),
                                     convert<mpq_class>(c.triangle.c), 0)
        .has_value();
  });
}

BENCHMARK_CAPTURE(plain_moller_trumbore, mixed, ordinary_cases<float>);
BENCHMARK_CAPTURE(certify, mixed, ordinary_cases<float>);
BENCHMARK_CAPTURE(plain_moller_trumbore, hits, hits<float>);
BENCHMARK_CAPTURE(certify, hits, hits<float>);
BENCHMARK_CAPTURE(settle, hard_float, unsure_cases<float>);
BENCHMARK_CAPTURE(settle, hard_double, unsure_cases<double>);
BENCHMARK_CAPTURE(settle, ordinary_double, ordinary_cases<double>);
BENCHMARK(round<float>);
BENCHMARK(round<double>);
BENCHMARK(round_batch<float>);
BENCHMARK(round_batch<double>);
BENCHMARK(decide_and_round<float>);
BENCHMARK(decide_and_round<double>);
BENCHMARK_CAPTURE(gmp_rational, ordinary, ordinary_cases<float>);
BENCHMARK_CAPTURE(gmp_rational, hard_float, unsure_cases<float>);
BENCHMARK_CAPTURE(gmp_rational, hard_double, unsure_cases<double>);

#ifdef PIERCE_BENCH_CGAL
void cgal_do_intersect(benchmark::State& state, Cases make_cases) {
  const std::vector<Case> cases = make_cases();
  const CgalCases ready(cases);
  std::size_t i = 0;
  for (auto _ : state) {
    benchmark::DoNotOptimize(ready.intersects(i));
    i = (i + 1) % cases.size();
  }
}
BENCHMARK_CAPTURE(cgal_do_intersect, ordinary, ordinary_cases<float>);
BENCHMARK_CAPTURE(cgal_do_intersect, hard_float, unsure_cases<float>);
BENCHMARK_CAPTURE(cgal_do_intersect, hard_double, unsure_cases<double>);
#endif

}  // namespace
}  // namespace pierce::bench

BENCHMARK_MAIN();
