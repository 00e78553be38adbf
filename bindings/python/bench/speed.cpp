// SPDX-License-Identifier: Apache-2.0
//
// speed.py's other half: the same batches from C++, with arrays of Ray and Hit.
//
//   speed VERTICES TRIANGLES RAYS THREADS TIMES     raw files: (n, 3) doubles, (m, 3) uint32,
//                                                   (k, 8) doubles
//
// Prints the seconds of each of the TIMES batches.
#include <pierce/pierce.h>

#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
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
  if (count != 6) return 2;
  const pierce::Mesh<double> mesh{read<pierce::Vec3<double>>(arguments[1]),
                                  read<pierce::Triangle>(arguments[2])};
  const auto rays = read<pierce::Ray<double>>(arguments[3]);
  const auto scene = pierce::Scene<double>::build(mesh.view());
  pierce::BatchOptions options;
  options.work.threads = static_cast<unsigned>(std::atoi(arguments[4]));
  std::vector<pierce::Hit<double>> hits(rays.size());
  for (int i = 0; i < std::atoi(arguments[5]); ++i) {
    const auto start = std::chrono::steady_clock::now();
    scene.closest_hits(rays, hits, options);
    const std::chrono::duration<double> took = std::chrono::steady_clock::now() - start;
    std::printf("%.4f\n", took.count());
    std::fflush(stdout);
  }
}
