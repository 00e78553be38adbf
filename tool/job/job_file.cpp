// SPDX-License-Identifier: Apache-2.0
#include "job/job_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cstring>

#include "failure.h"
#include "io/bad_file.h"
#include "io/json_view.h"
#include "io/json_writer.h"
#include "io/mapped_file.h"
#include "io/output_file.h"
#include "save_scene.h"
#include "support/checksum.h"

namespace pierce::tool {
namespace {

constexpr std::uint64_t kVersion = 3;

std::uint64_t read_hex(const io::JsonView& json) {
  const std::string& text = json.text();
  std::uint64_t value = 0;
  const char* const end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, value, 16);
  if (error != std::errc() || stop != end || text.empty())
    json.fail("expected a hexadecimal number: correct it");
  return value;
}

}  // namespace

std::filesystem::path Job::chunk_file(std::uint64_t chunk) const {
  return folder / "chunks" / fmt::format("{:09}.npy", chunk);
}

bool Job::is_done(std::uint64_t chunk) const {
  const std::filesystem::path path = chunk_file(chunk);
  const int file = ::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK);
  if (file < 0) {
    if (errno == ENOENT) return false;
    io::bad_file(path.string(), fmt::format("cannot be opened: {}", std::strerror(errno)));
  }
  struct stat status = {};
  ChunkEnd end;
  const bool read =
      ::fstat(file, &status) == 0 &&
      ::pread(file, &end, sizeof end, status.st_size - off_t{sizeof end}) == ssize_t{sizeof end};
  ::close(file);
  if (read && end.chunk == mark_of(chunk)) return true;
  io::bad_file(path.string(),
               "is not this chunk of this job, or was cut off: remove it and run the job again");
}

RayStream Job::open_rays() const {
  if (made) return RayStream(*made);
  require_there(rays_file, "file of rays");
  io::RayFile file(rays_file);
  std::error_code ignored;
  if (std::filesystem::file_size(rays_file, ignored) != rays_bytes || file.size() != rays) {
    io::bad_file(rays_file.string(),
                 "is not the file of rays that the job was created with: bring that back, or "
                 "create another job");
  }
  return RayStream(std::move(file));
}

std::string Job::text(bool whole) const {
  io::JsonWriter json;
  json.open_object();
  json.value("pierce_job", kVersion);
  if (whole) json.value("scene", scene.string());
  json.value("fingerprint", fingerprint_text(fingerprint));
  json.value("precision", is_float ? "float" : "double");
  json.value("query", name_of(question.query));
  json.value("sides", name_of(question.sides));
  json.value("range", name_of(question.range));
  if (question.max_hits != kUnlimited) json.value("max_hits", question.max_hits);
  json.value("reduce", name_of(question.reduce.reduction));
  json.value("bins", question.reduce.bins);
  json.value("t_low", question.reduce.low);
  json.value("t_high", question.reduce.high);
  if (made) {
    made->write(json);
  } else {
    json.open_object("rays");
    json.value("kind", "file");
    if (whole) json.value("path", rays_file.string());
    json.value("bytes", rays_bytes);
    json.value("checksum", fingerprint_text(rays_checksum));
    json.close_object();
  }
  json.value("count", rays);
  json.value("chunk", chunk_rays);
  json.value("chunks", chunks());
  if (whole) json.value("checksum", fingerprint_text(checksum()));
  json.close_object();
  return json.text();
}

std::uint64_t Job::checksum() const {
  return xxh64(std::as_bytes(std::span<const char>(text(false))));
}

std::uint64_t Job::mark_of(std::uint64_t chunk) const {
  const std::uint64_t both[] = {checksum(), chunk};
  return xxh64(std::as_bytes(std::span(both)));
}

namespace {

template <class Real>
std::uint64_t checksum_of_rays(const RayStream& source, std::uint64_t first, std::uint64_t count) {
  constexpr std::uint64_t kAtOnce = 1 << 16;
  std::vector<Ray<Real>> rays;
  std::uint64_t both[2] = {0, 0};  // so far, and the next ones
  for (std::uint64_t done = 0; done < count; done += rays.size()) {
    rays.resize(static_cast<std::size_t>(std::min(kAtOnce, count - done)));
    source.read(first + done, std::span(rays));
    both[1] = xxh64(std::as_bytes(std::span(rays)));
    both[0] = xxh64(std::as_bytes(std::span(both)));
  }
  return both[0];
}

}  // namespace

std::uint64_t Job::rays_checksum_of(std::uint64_t chunk, const RayStream& source) const {
  if (made) return 0;
  return is_float ? checksum_of_rays<float>(source, first_ray(chunk), rays_in(chunk))
                  : checksum_of_rays<double>(source, first_ray(chunk), rays_in(chunk));
}

void Job::check_rays() const {
  if (made) return;
  require_there(rays_file, "file of rays");
  if (checksum_of_file(rays_file) == rays_checksum) return;
  io::bad_file(rays_file.string(),
               "is not the file of rays that the job was created with: its checksum is another");
}

void Job::create() const {
  io::OutputFile file(folder / "job.json");
  file.write(text(true));
  file.commit();
}

Job Job::read(const std::filesystem::path& folder) {
  const std::filesystem::path path = folder / "job.json";
  std::error_code ignored;
  if (!std::filesystem::exists(path, ignored)) {
    io::bad_file(folder.string(),
                 "holds no job: name the folder of one, or make it with `pierce job create`");
  }
  const io::MappedFile file(path);
  const std::string name = path.string();
  const nlohmann::json document = io::parse_json(file.bytes(), name);
  const io::JsonView json(document, name);
  if (!document.is_object()) json.fail("is no job: make it with `pierce job create`");
  if (json.at("pierce_job").whole() != kVersion)
    json.fail("is of another version: run it with the pierce that created it");
  Job job;
  job.folder = folder;
  const std::filesystem::path scene = json.at("scene").text();
  job.scene = scene.is_absolute() ? scene : folder / scene;
  job.fingerprint = read_hex(json.at("fingerprint"));
  job.is_float = json.at("precision").text() == "float";
  if (!job.is_float && json.at("precision").text() != "double")
    json.at("precision").fail("is neither float nor double: correct it");
  parse_question(json, job.question);
  job.rays = json.at("count").whole(std::uint64_t{1} << 48);
  job.chunk_rays = json.at("chunk").whole(std::uint64_t{1} << 32);
  if (job.rays == 0 || job.chunk_rays == 0 || job.chunk_rays % 8 != 0 ||
      job.chunks() > 1'000'000'000 || job.chunks() != json.at("chunks").whole())
    json.fail("its numbers of rays and chunks do not fit: create the job anew");
  const io::JsonView rays = json.at("rays");
  if (rays.at("kind").text() != "file") {
    job.made = MadeRays::read(rays);
    if (job.made->count() != job.rays) rays.fail("are not as many as the job has");
  } else {
    job.rays_file = rays.at("path").text();
    job.rays_bytes = rays.at("bytes").whole();
    job.rays_checksum = read_hex(rays.at("checksum"));
  }
  job.stated_checksum = read_hex(json.at("checksum"));
  return job;
}

Job Job::open(const std::filesystem::path& folder) {
  Job job = read(folder);
  if (job.stated_checksum != job.checksum()) {
    io::bad_file((folder / "job.json").string(),
                 "was changed since the job was created: bring it back, or create another job");
  }
  return job;
}

void require_there(const std::filesystem::path& file, const char* what) {
  std::error_code error;
  if (std::filesystem::exists(file, error) || error) return;  // else the reader says why not
  io::bad_file(file.string(),
               fmt::format("is not there, the {} of the job: bring it back, or write into job.json "
                           "where it lies now",
                           what));
}

std::uint64_t checksum_of_file(const std::filesystem::path& file) {
  const io::MappedFile map(file);
  return checksum(std::as_bytes(std::span(map.bytes())));
}

}  // namespace pierce::tool
