// SPDX-License-Identifier: Apache-2.0
//
// Where points lie, pierce beside CGAL, one thread, processor time:
//
//   bench_inside MESH OUT POINTS.npy...
//
// The mesh and the points are taken as floats. For each file of points prints one line of JSON:
// seconds of each contender and round, and how many answers differ. CGAL takes only the first
// 100,000 points of a file. With OUT other than "-" the locations of all files go there, one byte a
// point, for scripts/inside_figures.py to compare with others.
#include <fmt/format.h>

#include <algorithm>
#include <ctime>
#include <exception>
#include <functional>
#include <string>
#include <vector>

#include "inside/cgal_inside.h"
#include "io/mesh.h"
#include "io/output_file.h"
#include "io/rays.h"
#include "io/read_mesh.h"
#include "pierce/scene.h"

namespace pierce::bench {
namespace {

constexpr std::size_t kCgalPoints = 100'000;
constexpr int kRounds = 5;

double seconds_of(const std::function<void()>& work) {
  const std::clock_t start = std::clock();
  work();
  return static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
}

struct Timings {
  std::vector<double> batch, single, cgal;
};

int run(const std::vector<std::string>& args) {
  const io::Mesh file = io::read_mesh(args.at(0));
  const std::vector<Vec3<float>> vertices = io::to_float(file.vertices);
  const MeshView<float> mesh{vertices, file.triangles};
  const auto scene = Scene<float>::build(mesh);
  const CgalInside cgal(mesh);
  std::vector<Location> all;
  for (std::size_t n = 2; n < args.size(); ++n) {
    const io::PointFile source(args[n]);
    std::vector<Vec3<float>> points(source.size());
    source.read(0, std::span(points));
    const std::size_t part = std::min(points.size(), kCgalPoints);
    std::vector<Location> batch(points.size());
    std::vector<Location> single(part);
    std::vector<Location> theirs(part);
    Timings timings;
    for (int round = 0; round < kRounds; ++round) {
      timings.batch.push_back(
          seconds_of([&] { scene.locate(points, batch, {.work = {.threads = 1}}); }));
      timings.single.push_back(seconds_of([&] {
        for (std::size_t i = 0; i < part; ++i) single[i] = scene.locate(points[i]);
      }));
      timings.cgal.push_back(
          seconds_of([&] { cgal.locate(std::span(points).first(part), theirs); }));
    }
    std::size_t differences = 0;
    for (std::size_t i = 0; i < part; ++i) {
      differences += batch[i] != theirs[i] || batch[i] != single[i] ? 1 : 0;
    }
    fmt::print(
        "{{\"points\": {}, \"batch\": [{}], \"part\": {}, \"single\": [{}], \"cgal\": [{}], "
        "\"differences\": {}}}\n",
        points.size(), fmt::join(timings.batch, ", "), part, fmt::join(timings.single, ", "),
        fmt::join(timings.cgal, ", "), differences);
    all.insert(all.end(), batch.begin(), batch.end());
  }
  if (args[1] != "-") {
    io::OutputFile out(args[1]);
    out.write({reinterpret_cast<const char*>(all.data()), all.size()});
    out.commit();
  }
  return 0;
}

}  // namespace
}  // namespace pierce::bench

int main(int argc, char** argv) {
  try {
    if (argc < 4) throw std::runtime_error("usage: bench_inside MESH OUT POINTS.npy...");
    return pierce::bench::run({argv + 1, argv + argc});
  } catch (const std::exception& e) {
    fmt::print(stderr, "bench_inside: {}\n", e.what());
    return 1;
  }
}
