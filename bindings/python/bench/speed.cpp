// SPDX-License-Identifier: Apache-2.0
//
// speed.py's other half: the same batches from C++, with arrays of Ray and Hit.
//
//   speed VERTICES TRIANGLES RAYS THREADS     raw files: (n, 3) doubles, (m, 3) uint32, (k, 8)
//                                             doubles
//
// Casts the batch once for each line that it reads, and answers with the seconds that it took and
// those that processors worked on it. The line "new": into a new array of hits, else into the same.
#include <pierce/pierce.h>

#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <string>
#include <vector>

namespace {

template <class T>
std::vector<T> read(const char* path) {
  std::vector<T> rows(std::filesystem::file_size(path) / sizeof(T));
  std::ifstream(path, std::ios::binary)
      .read(reinterpret_cast<char*>(rows.data()),
            static_cast<std::streamsize>(rows.size() * sizeof(T)));
  return rows;
}

}  // namespace

int main(int count, char** arguments) {
  if (count != 5) return 2;
  const pierce::Mesh<double> mesh{read<pierce::Vec3<double>>(arguments[1]),
                                  read<pierce::Triangle>(arguments[2])};
  const auto rays = read<pierce::Ray<double>>(arguments[3]);
  const auto scene = pierce::Scene<double>::build(mesh.view());
  pierce::BatchOptions options;
  options.work.threads = static_cast<unsigned>(std::atoi(arguments[4]));
  std::vector<pierce::Hit<double>> same(rays.size());
  for (std::string line; std::getline(std::cin, line);) {
    const auto start = std::chrono::steady_clock::now();
    const std::clock_t work = std::clock();
    if (line == "new") {
      std::vector<pierce::Hit<double>> hits(rays.size());
      scene.closest_hits(rays, hits, options);
    } else {
      scene.closest_hits(rays, same, options);
    }
    const double worked = static_cast<double>(std::clock() - work) / CLOCKS_PER_SEC;
    const std::chrono::duration<double> took = std::chrono::steady_clock::now() - start;
    std::printf("%.4f %.4f\n", took.count(), worked);
    std::fflush(stdout);
  }
}
