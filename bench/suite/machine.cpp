// SPDX-License-Identifier: Apache-2.0
//
// Reads what Linux tells about itself; elsewhere those entries say "unknown".
#include "suite/machine.h"

#include <fmt/chrono.h>
#include <fmt/format.h>
#include <sys/utsname.h>

#include <chrono>
#include <fstream>
#include <sstream>
#include <thread>

#include "contenders/families.h"
#include "kernels/kernel.h"
#include "pierce_commit.h"

namespace pierce::bench {
namespace {

std::string first_line(const std::string& path) {
  std::ifstream file(path);
  std::string line;
  return std::getline(file, line) ? line : "unknown";
}

// The value of the first line "key : value" whose key begins so.
std::string value_of(const std::string& path, const std::string& key) {
  std::ifstream file(path);
  for (std::string line; std::getline(file, line);) {
    if (line.rfind(key, 0) != 0) continue;
    const std::size_t colon = line.find(':');
    if (colon == std::string::npos) continue;
    const std::size_t start = line.find_first_not_of(" \t", colon + 1);
    if (start != std::string::npos) return line.substr(start);
  }
  return "unknown";
}

std::string caches() {
  std::string all;
  for (int index = 0; index < 8; ++index) {
    const std::string folder = fmt::format("/sys/devices/system/cpu/cpu0/cache/index{}/", index);
    const std::string level = first_line(folder + "level");
    if (level == "unknown") break;
    if (first_line(folder + "type") == "Instruction") continue;
    if (!all.empty()) all.append(", ");
    all.append(fmt::format("L{} {}", level, first_line(folder + "size")));
  }
  return all.empty() ? "unknown" : all;
}

std::string system_name() {
  utsname name{};
  if (uname(&name) != 0) return "unknown";
  return std::string(name.sysname) + " " + name.release + " " + name.machine;
}

// Which of the three words of transparent_hugepage/enabled stands in brackets.
std::string huge_pages() {
  const std::string line = first_line("/sys/kernel/mm/transparent_hugepage/enabled");
  const std::size_t open = line.find('[');
  const std::size_t close = line.find(']');
  return close == std::string::npos ? line : line.substr(open + 1, close - open - 1);
}

std::string compiler() {
#ifdef __clang__
  return "clang " __clang_version__;
#else
  return "g++ " __VERSION__;
#endif
}

}  // namespace

std::vector<std::pair<std::string, std::string>> describe_machine() {
  std::vector<std::pair<std::string, std::string>> all{
      {"date", fmt::format("{:%Y-%m-%d %H:%M} UTC", fmt::gmtime(std::time(nullptr)))},
      {"commit", PIERCE_COMMIT},
      {"version", PIERCE_VERSION},
      {"kernel", kernels::active_kernel().name},
      {"cpu",
       fmt::format("{}, family {} model {}", value_of("/proc/cpuinfo", "model name"),
                   value_of("/proc/cpuinfo", "cpu family"), value_of("/proc/cpuinfo", "model\t"))},
      {"cores", std::to_string(std::thread::hardware_concurrency())},
      {"caches", caches()},
      {"memory", value_of("/proc/meminfo", "MemTotal")},
      {"huge pages", huge_pages()},
      {"system", system_name()},
      {"load before", first_line("/proc/loadavg")},
      {"compiler", compiler()},
      {"flags", PIERCE_BENCH_FLAGS},
  };
#ifdef PIERCE_BENCH_EMBREE
  all.emplace_back("embree", embree_version());
  all.emplace_back("embree 4", embree4_version());
#endif
#ifdef PIERCE_BENCH_CGAL
  all.emplace_back("cgal", cgal_version());
#endif
  return all;
}

}  // namespace pierce::bench
