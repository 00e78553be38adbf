// SPDX-License-Identifier: Apache-2.0
//
// pierce job create.
#include <fmt/format.h>

#include <filesystem>
#include <optional>
#include <utility>

#include "failure.h"
#include "io/bad_file.h"
#include "job/job_commands.h"
#include "job/job_file.h"
#include "loaded_scene.h"
#include "output.h"
#include "save_scene.h"

namespace pierce::tool {
namespace {

namespace fs = std::filesystem;

template <class Real>
int create_as(const CreateOptions& options, std::vector<Geometry> meshes,
              std::optional<io::RayFile> file) {
  const LoadedScene<Real> loaded(std::move(meshes), {.work = {.threads = options.threads}});
  Job job;
  job.folder = options.folder;
  job.is_float = std::is_same_v<Real, float>;
  job.question = options;
  if (file) {
    job.rays_file = fs::absolute(options.source.rays);
    job.rays_bytes = fs::file_size(job.rays_file);
    job.rays_checksum = checksum_of_file(job.rays_file);
    job.rays = file->size();
  } else {
    job.made = make_rays<Real>(options.source, loaded.views(), has_z_up(options.meshes.files));
    job.rays = job.made->count();
  }
  if (job.rays == 0) io::bad_file(options.source.rays, "holds no rays: give some");
  job.chunk_rays = (options.chunk + 7) / 8 * 8;
  if (job.chunks() > 1'000'000'000)
    throw UsageError("--chunk: makes more than 10^9 chunks; give larger ones");
  std::error_code error;
  fs::create_directories(job.folder / "chunks", error);
  if (error) {
    io::bad_file(options.folder, fmt::format("cannot be made: {}: choose a folder that you may "
                                             "write to",
                                             error.message()));
  }
  if (loaded.meshes().stored_scene() != nullptr) {
    job.scene = fs::absolute(options.meshes.files[0]);
    (void)Scene<Real>::load(job.scene.string(), {.verify = true});
    job.fingerprint = scene_file_info(job.scene.string()).fingerprint;
  } else {
    const fs::path scene = job.folder / "scene.pierce";
    save_scene(loaded, scene.string(), options.threads);
    job.fingerprint = scene_file_info(scene.string()).fingerprint;
    job.scene = "scene.pierce";
  }
  job.create();  // last: now it is a job
  if (!options.quiet) {
    Summary table;
    loaded.add_size_to(table);
    loaded.add_to(table);
    table.add("rays", grouped(job.rays));
    table.add("chunks",
              fmt::format("{} of {} rays", grouped(job.chunks()), grouped(job.chunk_rays)));
    table.add("wrote", options.folder);
    remark(table.text());
  }
  return 0;
}

}  // namespace

int create_job(CreateOptions options) {
  if (options.source.rays.empty() && !options.source.made())
    throw UsageError("give one of --rays, --camera, --grid, --lidar and --sphere");
  check_cast(options);
  if (options.source.rays == "-") throw UsageError("--rays: a job's rays must be in a file");
  std::error_code ignored;
  if (fs::exists(fs::path(options.folder) / "job.json", ignored)) {
    throw UsageError(fmt::format("'{}' holds a job already; name another folder, or run that one",
                                 options.folder));
  }
  if (!fs::is_empty(fs::path(options.folder) / "chunks", ignored) && !ignored) {
    throw UsageError(
        fmt::format("'{}' holds chunks of another job; name another folder, or empty "
                    "that one",
                    options.folder));
  }
  CastInputs read = read_inputs(options);
  return read.use_float ? create_as<float>(options, std::move(read.meshes), std::move(read.rays))
                        : create_as<double>(options, std::move(read.meshes), std::move(read.rays));
}

}  // namespace pierce::tool
