// SPDX-License-Identifier: Apache-2.0
//
// The tables on stdout.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "suite/ratios.h"
#include "suite/report.h"
#include "suite/samples.h"

namespace pierce::bench {
namespace {

// Wide enough for its name and for "123.45".
std::size_t column_of(const std::string& name) { return std::max<std::size_t>(name.size(), 6) + 2; }

// "+- x %": half the distance of the quartiles in percent of the median.
double spread(const std::vector<double>& samples) {
  const double middle = median(samples);
  return middle == 0 ? 0 : 50 * (quantile(samples, 0.75) - quantile(samples, 0.25)) / middle;
}

bool counts(const Promise& promise, const Cell& cell) {
  return promise.sets.empty() ||
         std::find(promise.sets.begin(), promise.sets.end(), cell.set) != promise.sets.end();
}

std::string label(const Promise& promise) {
  std::string sets;
  for (const std::string& set : promise.sets) sets.append(sets.empty() ? " on " : ", ").append(set);
  return fmt::format("{} / {}{}", promise.one, promise.other, sets);
}

std::string promise_text(const SuiteResult& result, const Promise& promise) {
  std::string cells, worst;
  double logs = 0;
  double least = 0;
  int count = 0;
  for (const MeshResult& mesh : result.meshes) {
    std::string line;
    for (const Cell& cell : mesh.cells) {
      const Timing* one = cell.find(promise.one);
      const Timing* other = cell.find(promise.other);
      if (one == nullptr || other == nullptr || !counts(promise, cell)) continue;
      // Threads are timed by the wall, so beside the CPU's clock they say nothing.
      if (result.options.clock == Clock::Cpu && one->threads != other->threads) continue;
      const std::vector<double> ratios = paired_ratios(*one, *other);
      if (ratios.empty()) continue;
      const double ratio = median(ratios);
      line += fmt::format("  {}/{} {:.2f}+-{:.0f}%", cell.set, name_of(cell.query), ratio,
                          spread(ratios));
      if (count == 0 || ratio < least) {
        least = ratio;
        worst = fmt::format("{} {}/{}", mesh.mesh, cell.set, name_of(cell.query));
      }
      logs += std::log(ratio);
      ++count;
    }
    if (!line.empty()) cells += fmt::format("    {:<12}{}\n", mesh.mesh, line);
  }
  if (count == 0) return "";
  const double mean = std::exp(logs / count);
  std::string verdict;
  if (promise.must > 0) {
    verdict = fmt::format("   must {:.2f}: {}, aim {:.2f}: {}", promise.must,
                          least >= promise.must ? "kept" : "MISSED", promise.aim,
                          mean >= promise.aim ? "kept" : "missed");
  }
  return fmt::format("  {}: geometric mean {:.2f}, least {:.2f} ({}){}\n{}", label(promise), mean,
                     least, worst, verdict, cells);
}

// The kernels that contenders name, "@avx2"; first "", of those that name none.
std::vector<std::string> kernels_of(const SuiteResult& result) {
  std::vector<std::string> kernels{""};
  for (const std::string& name : result.options.contenders) {
    const std::size_t at = name.find('@');
    if (at == std::string::npos) continue;
    const std::string kernel = name.substr(at);
    if (std::find(kernels.begin(), kernels.end(), kernel) == kernels.end())
      kernels.push_back(kernel);
  }
  return kernels;
}

Promise with_kernel(Promise promise, const std::string& kernel) {
  promise.one += kernel;
  if (promise.other.starts_with("pierce")) promise.other += kernel;
  return promise;
}

}  // namespace

std::string builds_text(const MeshResult& mesh) {
  std::string text;
  for (const BuildResult& build : mesh.builds) {
    if (build.bytes == 0) continue;  // nothing was built: the textbook
    const double triangles = static_cast<double>(mesh.triangles);
    const double seconds = median(build.seconds);
    text += fmt::format("  build {:<15} {:8.2f} Mtri/s {:9.3f} s {:8.1f} bytes/triangle",
                        build.engine, 1e-6 * triangles / seconds, seconds,
                        static_cast<double>(build.bytes) / triangles);
    if (build.sah_cost > 0) text += fmt::format("   SAH {:.2f}", build.sah_cost);
    text += "\n";
  }
  return text;
}

std::string cells_header(const MeshResult& mesh, const SuiteOptions& options) {
  std::string text = fmt::format("  {:<18}{:>7}", "Mrays/s", "hits");
  for (const std::string& name : options.contenders)
    text += fmt::format("{:>{}}", name, column_of(name));
  return fmt::format("{}: {} triangles, {} vertices\n{}", mesh.mesh, mesh.triangles, mesh.vertices,
                     builds_text(mesh)) +
         text + "\n";
}

std::string cell_text(const Cell& cell) {
  std::string text =
      fmt::format("  {:<18}{:>6.1f}%", cell.set + "/" + name_of(cell.query),
                  100 * static_cast<double>(cell.hits) / static_cast<double>(cell.rays));
  for (const Timing& timing : cell.timings) {
    text += fmt::format("{:>{}.{}f}", 1e-6 * median(timing.speeds()), column_of(timing.contender),
                        median(timing.speeds()) < 1e6 ? 4 : 2);
  }
  return text + "\n";
}

std::string differences_text(const Cell& cell) {
  std::string text;
  for (const Timing& timing : cell.timings) {
    const Differences& d = timing.differences;
    if (d.wrong() == 0) continue;
    text += fmt::format("    {}: {} of {} wrong ({} missed, {} invented, {} another triangle)\n",
                        timing.contender, d.wrong(), d.compared, d.missed, d.invented,
                        d.other_triangle);
  }
  return text;
}

std::string ratios_text(const SuiteResult& result) {
  std::string text;
  for (const std::string& kernel : kernels_of(result)) {
    for (const Promise& promise : promises()) {
      text += promise_text(result, with_kernel(promise, kernel));
    }
  }
  return text.empty() ? ""
                      : "ratios (median of the rounds +- half the quartile distance):\n" + text;
}

std::string ladder_text(const SuiteResult& result) {
  std::string text;
  for (const MeshResult& mesh : result.meshes) {
    Statistics sum;
    for (const Cell& cell : mesh.cells)
      if (cell.ladder) sum += *cell.ladder;
    if (sum.rays == 0) continue;
    const auto per_ray = [&](std::uint64_t n) {
      return static_cast<double>(n) / static_cast<double>(sum.rays);
    };
    text += fmt::format(
        "  {:<12} a ray: {:.2f} nodes, {:.2f} leaves, {:.3f} candidates; in all: {} certified, {} "
        "settled, {} settled big, orders {} certified {} settled, {} hits, {} rounded exactly\n",
        mesh.mesh, per_ray(sum.nodes), per_ray(sum.leaves), per_ray(sum.candidates), sum.certified,
        sum.settled, sum.settled_big, sum.orders_certified, sum.orders_settled, sum.hits,
        sum.rounded_exactly);
  }
  return text.empty() ? "" : "ladder:\n" + text;
}

}  // namespace pierce::bench
