// SPDX-License-Identifier: Apache-2.0
//
// One chunk of a job: cast, stored, named.
#pragma once

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstdint>
#include <cstring>
#include <random>
#include <span>
#include <string>
#include <vector>

#include "cast_piece.h"
#include "io/bad_file.h"
#include "job/job_file.h"

namespace pierce::tool {

struct ChunkResult {
  std::uint64_t hits = 0;
  double seconds = 0;
};

/// Puts its ChunkEnd behind a chunk's array.
inline void seal_chunk(const Job& job, std::uint64_t chunk, std::uint64_t rays,
                       const std::filesystem::path& file) {
  const ChunkEnd end{job.mark_of(chunk), rays, checksum_of_file(file)};
  errno = ENOSPC;  // if it writes half of it
  const int descriptor = ::open(file.c_str(), O_WRONLY | O_APPEND | O_CLOEXEC);
  const bool written =
      descriptor >= 0 && ::write(descriptor, &end, sizeof end) == ssize_t{sizeof end};
  const int reason = errno;
  if (descriptor >= 0) ::close(descriptor);
  if (!written) {
    std::error_code ignored;
    std::filesystem::remove(file, ignored);
    io::bad_file(file.string(), fmt::format("cannot be written: {}", std::strerror(reason)));
  }
}

/// Casts the chunk and writes its file, under this name.
template <class Real>
ChunkResult cast_chunk_to(const Job& job, const Scene<Real>& scene, const RayStream& source,
                          std::uint64_t chunk, const std::filesystem::path& file,
                          const WorkOptions& work) {
  const Stopwatch watch;
  const std::uint64_t first = job.first_ray(chunk);
  const std::vector<std::uint64_t> shape = {job.rays_in(chunk)};
  const std::uint64_t rays = job.rays_checksum_of(chunk, source);
  BatchOptions batch = batch_options(job.question);
  batch.work = work;
  ChunkResult result;
  const std::size_t most = rays_at_a_time(work.threads);
  const auto cast = [&](auto asker) {
    // In pieces, as `pierce cast` does: a chunk may have more rays than memory.
    for (std::uint64_t done = 0; done < job.rays_in(chunk); done += most) {
      const auto piece =
          static_cast<std::size_t>(std::min<std::uint64_t>(most, job.rays_in(chunk) - done));
      result.hits += cast_piece(scene, source, first + done, piece, asker, batch);
      asker.write();
    }
    asker.finish();
  };
  with_asker(job.question, {file, io::RecordFormat::Npy}, scene, first,
             std::span<const std::uint64_t>(shape), cast);
  seal_chunk(job, chunk, rays, file);
  result.seconds = watch.seconds();
  return result;
}

/// A name in the folder of chunks that no other worker on any machine takes.
inline std::filesystem::path unique_file(const Job& job, std::uint64_t chunk) {
  std::random_device device;
  const auto token = (std::uint64_t{device()} << 32) | device();
  return job.folder / "chunks" / fmt::format("{:09}.{:016x}.new", chunk, token);
}

/// The same, and the file gets its name when its bytes are on the disk: what bears the name of a
/// chunk is whole, whatever was killed, filled or switched off.
template <class Real>
ChunkResult cast_chunk(const Job& job, const Scene<Real>& scene, const RayStream& source,
                       std::uint64_t chunk, const WorkOptions& work) {
  const std::filesystem::path file = unique_file(job, chunk);
  const ChunkResult result = cast_chunk_to(job, scene, source, chunk, file, work);
  const int descriptor = ::open(file.c_str(), O_RDONLY | O_CLOEXEC);
  const bool stored = descriptor >= 0 && ::fsync(descriptor) == 0;
  const int reason = errno;
  if (descriptor >= 0) ::close(descriptor);
  std::error_code error;
  if (stored) std::filesystem::rename(file, job.chunk_file(chunk), error);
  if (!stored || error) {
    std::error_code ignored;
    std::filesystem::remove(file, ignored);
    // Whoever merged meanwhile took this file for one of a worker that had been killed.
    if (job.is_done(chunk)) return result;
    io::bad_file(
        job.chunk_file(chunk).string(),
        fmt::format("cannot be written: {}", stored ? error.message() : std::strerror(reason)));
  }
  return result;
}

}  // namespace pierce::tool
