// SPDX-License-Identifier: Apache-2.0
//
// A job's folder:
//
//   job.json        what is asked: the scene by its fingerprint, the query, the rays, the chunks
//   scene.pierce    the scene, unless it was a scene file already: then job.json has its path
//   chunks/N.npy    the answers of chunk N, which appear when they are complete; behind the array
//                   a ChunkEnd, so that no chunk of another job or of other rays, under the name of
//                   another chunk, or damaged, is merged
//
// Answers depend on job.json alone, so it does not matter who casts a chunk, where, or how often.
// Only the paths in job.json may be changed.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>

#include "cast_options.h"
#include "io/rays.h"
#include "made_rays.h"

namespace pierce::tool {

/// The last bytes of a chunk's file.
struct ChunkEnd {
  std::uint64_t chunk = 0;  ///< Job::mark_of(chunk)
  std::uint64_t rays = 0;   ///< Job::rays_checksum_of(chunk)
  std::uint64_t bytes = 0;  ///< the checksum of all bytes before this
};

struct Job {
  std::filesystem::path folder;
  std::filesystem::path scene;  ///< absolute, or in the folder
  std::uint64_t fingerprint = 0;
  std::uint64_t stated_checksum = 0;  ///< as it stands in job.json
  bool is_float = true;
  CastOptions question;  ///< query, sides, range, max_hits, reduce
  /// The rays: made, or of a file (absolute), whose bytes have this checksum.
  std::optional<MadeRays> made;
  std::filesystem::path rays_file;
  std::uint64_t rays_bytes = 0, rays_checksum = 0;
  std::uint64_t rays = 0;        ///< how many there are
  std::uint64_t chunk_rays = 0;  ///< a multiple of eight

  [[nodiscard]] std::uint64_t chunks() const { return (rays + chunk_rays - 1) / chunk_rays; }
  [[nodiscard]] std::uint64_t first_ray(std::uint64_t chunk) const { return chunk * chunk_rays; }
  [[nodiscard]] std::uint64_t rays_in(std::uint64_t chunk) const {
    return std::min(chunk_rays, rays - first_ray(chunk));
  }
  [[nodiscard]] std::filesystem::path chunk_file(std::uint64_t chunk) const;
  /// Throws Error (BadFile) if the chunk's file ends otherwise than one of this job.
  [[nodiscard]] bool is_done(std::uint64_t chunk) const;
  /// Opens the rays. Throws Error (BadFile) if their file has changed its size or number of rays.
  [[nodiscard]] RayStream open_rays() const;
  /// Throws Error (BadFile) if the bytes of the file of rays are not those of the job's creation.
  void check_rays() const;

  /// XXH64 of all that answers depend on.
  [[nodiscard]] std::uint64_t checksum() const;
  /// Of that and the chunk's number.
  [[nodiscard]] std::uint64_t mark_of(std::uint64_t chunk) const;
  /// Of the chunk's rays as they are cast; 0 if they are made and cannot change.
  [[nodiscard]] std::uint64_t rays_checksum_of(std::uint64_t chunk, const RayStream& source) const;
  /// Writes job.json; it must not be there yet.
  void create() const;
  /// Reads it. Throws Error (BadFile) if there is no job, or none that this pierce understands.
  static Job open(const std::filesystem::path& folder);
  /// The same, whatever its checksum is.
  static Job read(const std::filesystem::path& folder);

 private:
  [[nodiscard]] std::string text(bool whole) const;  // of job.json; or what checksum() is of
};

/// Throws Error (BadFile) if the job's `what` is not where job.json says.
void require_there(const std::filesystem::path& file, const char* what);

/// XXH64 over pieces of a file (support/checksum.h).
[[nodiscard]] std::uint64_t checksum_of_file(const std::filesystem::path& file);

}  // namespace pierce::tool
