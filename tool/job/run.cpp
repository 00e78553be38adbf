// SPDX-License-Identifier: Apache-2.0
//
// pierce job run, verify: what casts.
#include <fmt/format.h>

#include <algorithm>
#include <random>

#include "interrupt.h"
#include "io/mapped_file.h"
#include "job/cast_chunk.h"
#include "job/job_commands.h"
#include "job/part.h"
#include "output.h"
#include "progress_bar.h"
#include "save_scene.h"

namespace pierce::tool {
namespace {

template <class Real>
Scene<Real> load_scene(const Job& job) {
  const std::string path = job.scene.string();
  require_there(job.scene, "scene");
  const SceneFileInfo info = scene_file_info(path);
  if (info.fingerprint != job.fingerprint) {
    io::bad_file(
        path, fmt::format("is not the scene of this job: its fingerprint is {}, and the "
                          "job's {}; bring that back, or create another job",
                          fingerprint_text(info.fingerprint), fingerprint_text(job.fingerprint)));
  }
  return Scene<Real>::load(path);
}

std::string rate_text(double rays, double seconds) {
  return seconds > 0 ? fmt::format("{:.3g} M rays/s", rays / seconds * 1e-6) : "";
}

std::string chunk_json(const Job& job, std::uint64_t chunk, const ChunkResult& result) {
  const std::uint64_t rays = job.rays_in(chunk);
  return fmt::format(
      "{{\"chunk\": {}, \"first\": {}, \"rays\": {}, \"hits\": {}, \"seconds\": {:.6g}, "
      "\"rays_per_second\": {:.6g}}}\n",
      chunk, job.first_ray(chunk), rays, result.hits, result.seconds,
      static_cast<double>(rays) / std::max(result.seconds, 1e-9));
}

template <class Real>
int run_as(const Job& job, const RunOptions& options, const Part& part) {
  std::vector<std::uint64_t> open;
  std::uint64_t mine = 0;
  for (std::uint64_t chunk = part.i; chunk < job.chunks(); chunk += part.of, ++mine) {
    if (!job.is_done(chunk)) open.push_back(chunk);
  }
  const Scene<Real> scene = load_scene<Real>(job);
  const RayStream source = job.open_rays();
  const interrupt::Graceful graceful;
  ProgressBar bar("job");
  std::uint64_t cast = 0, cast_rays = 0, hits = 0, done_rays = 0, open_rays = 0;
  for (const std::uint64_t chunk : open) open_rays += job.rays_in(chunk);
  const Stopwatch watch;
  for (const std::uint64_t chunk : open) {
    interrupt::check();
    const std::uint64_t size = job.rays_in(chunk);
    if (!job.is_done(chunk)) {  // nobody else has cast it meanwhile
      const double from = static_cast<double>(done_rays) / static_cast<double>(open_rays);
      const double to = static_cast<double>(done_rays + size) / static_cast<double>(open_rays);
      const WorkOptions work{.threads = options.threads,
                             .progress = bar.callback(from, to),
                             .stop = interrupt::stop()};
      const ChunkResult result = cast_chunk(job, scene, source, chunk, work);
      ++cast;
      cast_rays += size;
      hits += result.hits;
      bar.note(rate_text(static_cast<double>(cast_rays), watch.seconds()));
      if (options.json) print(chunk_json(job, chunk, result));
    }
    done_rays += size;
  }
  if (options.quiet || options.json) return 0;
  Summary table;
  if (!part.from.empty())
    table.add("part", fmt::format("{} of {} (0 is the first), by {}", part.i, part.of, part.from));
  table.add("chunks", fmt::format("{} cast, {} were there", grouped(cast), grouped(mine - cast)));
  if (cast > 0) {
    table.add("hits", fmt::format("{} ({})", grouped(hits), percentage(hits, cast_rays)));
    table.add("cast", timing(watch.seconds(), cast_rays, "rays"));
  }
  remark(table.text());
  return 0;
}

// The file is removed however this ends.
struct Scratch {
  std::filesystem::path path;
  ~Scratch() {
    std::error_code ignored;
    std::filesystem::remove(path, ignored);
  }
};

template <class Real>
int verify_as(const Job& job, const VerifyOptions& options) {
  job.check_rays();
  std::vector<std::uint64_t> done;
  for (std::uint64_t chunk = 0; chunk < job.chunks(); ++chunk) {
    if (job.is_done(chunk)) done.push_back(chunk);
  }
  if (done.empty())
    io::bad_file(job.folder.string(), "has no chunk that could be cast anew: run the job first");
  std::mt19937_64 random(options.seed != 0 ? options.seed : std::random_device()());
  std::shuffle(done.begin(), done.end(), random);
  if (!options.all && done.size() > options.chunks) done.resize(options.chunks);
  const Scene<Real> scene = load_scene<Real>(job);
  (void)Scene<Real>::load(job.scene.string(), {.verify = true});
  const RayStream source = job.open_rays();
  const interrupt::Graceful graceful;
  ProgressBar bar("verify");
  std::vector<std::uint64_t> different;
  for (std::size_t i = 0; i < done.size(); ++i) {
    interrupt::check();
    bar.show(static_cast<double>(i) / static_cast<double>(done.size()));
    const Scratch anew{unique_file(job, done[i])};
    (void)cast_chunk_to(job, scene, source, done[i], anew.path,
                        {.threads = options.threads, .stop = interrupt::stop()});
    bool same = false;
    try {
      same = io::MappedFile(anew.path).bytes() == io::MappedFile(job.chunk_file(done[i])).bytes();
    } catch (const Error&) {  // an empty file
    }
    if (!same) different.push_back(done[i]);
  }
  if (different.empty()) {
    if (!options.quiet)
      remark(fmt::format("{} of {} chunks cast anew: the same to the last byte\n",
                         grouped(done.size()), grouped(job.chunks())));
    return 0;
  }
  std::sort(different.begin(), different.end());
  io::bad_file(
      job.chunk_file(different[0]).string(),
      fmt::format("is not what its rays give ({} of {} chunks that were cast anew): remove "
                  "it and run the job again",
                  different.size(), done.size()));
}

}  // namespace

int run_job(const RunOptions& options) {
  const Job job = Job::open(options.folder);
  const Part part = part_of_job(options.part);
  return job.is_float ? run_as<float>(job, options, part) : run_as<double>(job, options, part);
}

int verify_job(const VerifyOptions& options) {
  const Job job = Job::open(options.folder);
  return job.is_float ? verify_as<float>(job, options) : verify_as<double>(job, options);
}

}  // namespace pierce::tool
