// SPDX-License-Identifier: Apache-2.0
//
// Nearest points, pierce beside CGAL, one thread, processor time:
//
//   bench_nearest MESH POINTS.npy [TRIANGLES]
//
// The mesh and the points are taken as floats. Prints one line of JSON: seconds of each contender
// and round (CGAL takes only the first 20,000 points), and how many triangles are not nearest,
// decided exactly. TRIANGLES holds the answers of another contender, a 32-bit number a point, to be
// judged too; scripts/nearest_figures.py writes it.
#include <fmt/format.h>

#include <algorithm>
#include <ctime>
#include <exception>
#include <fstream>
#include <functional>
#include <stdexcept>
#include <string>
#include <vector>

#include "io/mesh.h"
#include "io/rays.h"
#include "io/read_mesh.h"
#include "nearest/cgal_nearest.h"
#include "pierce/scene.h"
#include "predicate/nearest.h"

namespace pierce::bench {
namespace {

constexpr std::size_t kCgalPoints = 20'000;
constexpr int kRounds = 5;

double processor_time() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

double seconds_of(const std::function<void()>& work) {
  const double start = processor_time();
  work();
  return processor_time() - start;
}

// How many of the triangles are farther away than the ones that pierce names.
std::size_t count_wrong(MeshView<float> mesh, const std::vector<Vec3<float>>& points,
                        const std::vector<NearestPoint<float>>& nearest,
                        const std::vector<std::uint32_t>& triangles) {
  predicate::LadderCounts counts;
  const auto near = [&](const Vec3<double>& p, std::uint32_t number) {
    const Triangle& t = mesh.triangles[number];
    const auto corner = [&](std::size_t i) { return predicate::to_double(mesh.vertices[t[i]]); };
    return predicate::decide_near(p, {corner(0), corner(1), corner(2)}, counts);
  };
  std::size_t wrong = 0;
  for (std::size_t i = 0; i < triangles.size(); ++i) {
    const Vec3<double> p = predicate::to_double(points[i]);
    const auto ours = near(p, nearest[i].triangle);
    const auto theirs = near(p, triangles[i]);
    wrong += predicate::decide_nearer(p, ours, theirs, counts) < 0 ? 1 : 0;
  }
  return wrong;
}

std::vector<std::uint32_t> read_numbers(const std::string& path, std::size_t count) {
  std::vector<std::uint32_t> numbers(count);
  std::ifstream file(path, std::ios::binary);
  file.read(reinterpret_cast<char*>(numbers.data()),
            static_cast<std::streamsize>(count * sizeof(std::uint32_t)));
  if (!file) throw std::runtime_error(path + ": cannot read " + std::to_string(count) + " numbers");
  return numbers;
}

int run(const std::vector<std::string>& args) {
  const io::Mesh file = io::read_mesh(args.at(0));
  const std::vector<Vec3<float>> vertices = io::to_float(file.vertices);
  const MeshView<float> mesh{vertices, file.triangles};
  const auto scene = Scene<float>::build(mesh);
  const CgalNearest cgal(mesh);
  const io::PointFile source(args.at(1));
  std::vector<Vec3<float>> points(source.size());
  source.read(0, std::span(points));
  const std::size_t part = std::min(points.size(), kCgalPoints);
  std::vector<NearestPoint<float>> nearest(points.size());
  std::vector<std::uint32_t> theirs(part);
  std::vector<double> pierce_times, cgal_times;
  for (int round = 0; round < kRounds; ++round) {
    pierce_times.push_back(
        seconds_of([&] { scene.nearest_points(points, nearest, {.work = {.threads = 1}}); }));
    cgal_times.push_back(seconds_of([&] { cgal.closest(std::span(points).first(part), theirs); }));
  }
  const std::size_t cgal_wrong = count_wrong(mesh, points, nearest, theirs);
  const std::size_t other_wrong =
      args.size() < 3 ? 0
                      : count_wrong(mesh, points, nearest, read_numbers(args[2], points.size()));
  fmt::print(
      "{{\"points\": {}, \"pierce\": [{}], \"part\": {}, \"cgal\": [{}], \"cgal_wrong\": {}, "
      "\"other_wrong\": {}}}\n",
      points.size(), fmt::join(pierce_times, ", "), part, fmt::join(cgal_times, ", "), cgal_wrong,
      other_wrong);
  return 0;
}

}  // namespace
}  // namespace pierce::bench

int main(int argc, char** argv) {
  try {
    if (argc < 3) throw std::runtime_error("usage: bench_nearest MESH POINTS.npy [TRIANGLES]");
    return pierce::bench::run({argv + 1, argv + argc});
  } catch (const std::exception& e) {
    fmt::print(stderr, "bench_nearest: {}\n", e.what());
    return 1;
  }
}
