// SPDX-License-Identifier: Apache-2.0
//
// Any bytes in the folder of a job. The first byte says what the rest is: job.json, as it is or
// with the checksum that belongs to it; the file of a chunk, as it is or with the right end; or
// bytes that are put into one of them. Every command of `pierce job` refuses it with one line, or
// does its work: what is merged then is what the chunks hold, and what is verified is what was
// cast here. (In TMPDIR, which had better be in memory: chunks are written to the disk itself.)
#include <unistd.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>

#include "failure.h"
#include "io/npy.h"
#include "job/job_commands.h"
#include "job/job_file.h"
#include "save_scene.h"
#include "support/checksum.h"

namespace {

namespace fs = std::filesystem;
using namespace pierce;
using namespace pierce::tool;

void require(bool condition) {
  if (!condition) std::abort();
}

std::string slurp(const fs::path& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

void put(const fs::path& path, std::string_view bytes) {
  std::ofstream(path, std::ios::binary) << bytes;
}

// False if it refuses, with one line.
template <class Work>
bool succeeds(const Work& work) {
  try {
    work();
    return true;
  } catch (const Error& error) {
    require(error.code() != ErrorCode::Stopped);
    require(std::string_view(error.what()).find('\n') == std::string_view::npos);
  } catch (const UsageError& error) {
    require(std::string_view(error.what()).find('\n') == std::string_view::npos);
  }
  return false;
}

// Two jobs about one triangle: a list of hits, and counts. Cast once, as they should be.
struct Fixture {
  fs::path base = fs::temp_directory_path() / ("fuzz-job-" + std::to_string(::getpid()));
  fs::path folders[2] = {base / "all", base / "sum"};
  std::string json[2], chunks[2][3], merged[2];

  Fixture() {
    require(std::freopen("/dev/null", "w", stdout) != nullptr);  // `job status` prints
    fs::create_directories(base);
    put(base / "a.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n");
    for (int k = 0; k < 2; ++k) {
      CreateOptions options;
      options.meshes.files = {(base / "a.off").string()};
      options.folder = folders[k].string();
      options.source.sphere = 20;
      options.chunk = 8;
      options.threads = 1;
      options.quiet = true;
      if (k == 0) options.query = Query::All;
      if (k == 1) options.reduce.reduction = Reduction::Histogram;
      if (k == 1) options.t_range = "0,1";
      require(create_job(options) == 0);
      require(run(folders[k]) == 0 && merge(folders[k]) == 0);
      json[k] = slurp(folders[k] / "job.json");
      merged[k] = slurp(base / "out.npy");
      for (int c = 0; c < 3; ++c) chunks[k][c] = slurp(chunk_file(k, c));
    }
  }
  ~Fixture() { fs::remove_all(base); }

  fs::path chunk_file(int k, int chunk) const {
    return folders[k] / "chunks" / ("00000000" + std::to_string(chunk) + ".npy");
  }
  static int run(const fs::path& folder) {
    return run_job({.folder = folder.string(), .part = "0/1", .threads = 1, .quiet = true});
  }
  int merge(const fs::path& folder) const {
    return merge_job(
        {.folder = folder.string(), .out = (base / "out.npy").string(), .quiet = true});
  }
};

// Replaces bytes: where, as 16 bits; what.
std::string mended(std::string bytes, std::string_view by) {
  for (std::size_t i = 0; i + 3 <= by.size() && !bytes.empty(); i += 3) {
    const auto low = static_cast<unsigned char>(by[i]),
               high = static_cast<unsigned char>(by[i + 1]);
    bytes[(low + 256U * high) % bytes.size()] = by[i + 2];
  }
  return bytes;
}

// A job that this machine casts in no time.
bool is_small(const Job& job) {
  return job.rays <= 1000 && job.chunks() <= 20 && job.question.reduce.bins <= 100000;
}

// With the checksum that pierce itself would write.
std::string with_checksum(const fs::path& folder, std::string json) {
  constexpr std::string_view kKey = "\"checksum\": \"";
  const std::size_t begin = json.rfind(kKey) + kKey.size();
  if (begin < kKey.size()) return json;
  put(folder / "job.json", json);
  (void)succeeds([&] {
    const std::string right = fingerprint_text(Job::read(folder).checksum());
    json.replace(begin, std::min(json.find('"', begin), json.size()) - begin, right);
  });
  return json;
}

void attack_json(Fixture& fixture, int k, std::string json, bool right_sum) {
  const fs::path& folder = fixture.folders[k];
  if (right_sum) json = with_checksum(folder, std::move(json));
  put(folder / "job.json", json);
  std::optional<Job> job;
  if (succeeds([&] { job = Job::open(folder); }) && is_small(*job)) {
    (void)succeeds([&] { (void)status_of_job({folder.string(), false}); });
    // The chunks that are there are of another job, unless nothing but paths was changed.
    const bool same = succeeds([&] { (void)fixture.merge(folder); });
    if (same) require(slurp(fixture.base / "out.npy") == fixture.merged[k]);
    if (!same) {
      fs::remove_all(folder / "chunks");
      fs::create_directories(folder / "chunks");
      if (succeeds([&] { (void)Fixture::run(folder); })) {
        require(fixture.merge(folder) == 0);
        require(verify_job({.folder = folder.string(), .threads = 1, .all = true, .quiet = true}) ==
                0);
      }
      fs::remove_all(folder / "chunks");
      fs::create_directories(folder / "chunks");
      for (int c = 0; c < 3; ++c) put(fixture.chunk_file(k, c), fixture.chunks[k][c]);
    }
  }
  put(folder / "job.json", fixture.json[k]);
}

void attack_chunk(Fixture& fixture, int k, std::string chunk, bool right_end) {
  const fs::path& folder = fixture.folders[k];
  if (right_end) {
    const ChunkEnd end{Job::open(folder).checksum(),
                       pierce::checksum(std::as_bytes(std::span(chunk)))};
    chunk.append(reinterpret_cast<const char*>(&end), sizeof end);
  }
  const bool as_it_was = chunk == fixture.chunks[k][1];
  put(fixture.chunk_file(k, 1), chunk);
  (void)succeeds([&] { (void)status_of_job({folder.string(), false}); });
  const bool merged = succeeds([&] { (void)fixture.merge(folder); });
  if (!right_end) require(merged == as_it_was);
  if (merged && as_it_was) require(slurp(fixture.base / "out.npy") == fixture.merged[k]);
  if (merged) (void)io::parse_npy_header(slurp(fixture.base / "out.npy"), "out.npy");
  const bool verified = succeeds([&] {
    (void)verify_job({.folder = folder.string(), .threads = 1, .all = true, .quiet = true});
  });
  require(verified == as_it_was);
  put(fixture.chunk_file(k, 1), fixture.chunks[k][1]);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static Fixture fixture;
  if (size == 0) return 0;
  const std::string_view rest(reinterpret_cast<const char*>(data) + 1, size - 1);
  const int k = data[0] & 1;
  const bool right = (data[0] & 2) != 0, replace = (data[0] & 4) != 0;
  if ((data[0] & 8) == 0) {
    attack_json(fixture, k, replace ? mended(fixture.json[k], rest) : std::string(rest), right);
  } else {
    std::string chunk = fixture.chunks[k][1];
    if (right) chunk.resize(chunk.size() - sizeof(ChunkEnd));
    attack_chunk(fixture, k, replace ? mended(chunk, rest) : std::string(rest), right);
  }
  return 0;
}
