// SPDX-License-Identifier: Apache-2.0
//
// pierce job status, merge: what looks at chunks that are there.
#include <fmt/format.h>

#include <chrono>
#include <cstring>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "failure.h"
#include "file_options.h"
#include "interrupt.h"
#include "io/bad_file.h"
#include "io/json_writer.h"
#include "io/mapped_file.h"
#include "io/npy.h"
#include "io/output_file.h"
#include "job/job_commands.h"
#include "job/job_file.h"
#include "output.h"
#include "progress_bar.h"
#include "support/checksum.h"

namespace pierce::tool {
namespace {

// The Python text of the type in a header of ours: {'descr': ..., 'fortran_order': ...
std::string_view descr_of(std::string_view bytes) {
  constexpr std::string_view kBefore = "'descr': ", kAfter = ", 'fortran_order'";
  const std::size_t begin = bytes.find(kBefore), end = bytes.find(kAfter);
  if (begin == std::string_view::npos || end == std::string_view::npos) return {};
  return bytes.substr(begin + kBefore.size(), end - begin - kBefore.size());
}

// A chunk's file, of which header and length fit each other and the job, and, if `source` is given,
// whose bytes are those that were written, of these rays.
class ChunkFile {
 public:
  ChunkFile(const Job& job, std::uint64_t chunk, const RayStream* source)
      : name_(job.chunk_file(chunk).string()), file_(name_) {
    array_ = file_.bytes();
    if (array_.size() < sizeof(ChunkEnd)) damaged();
    array_.remove_suffix(sizeof(ChunkEnd));
    ChunkEnd end;
    std::memcpy(&end, array_.data() + array_.size(), sizeof end);
    if (end.chunk != job.mark_of(chunk) ||
        (source != nullptr && end.bytes != checksum(std::as_bytes(std::span(array_)))))
      damaged();
    if (source != nullptr && end.rays != job.rays_checksum_of(chunk, *source)) {
      io::bad_file(name_,
                   "was cast from other rays than the job's: remove it and run the job again");
    }
    header_ = io::parse_npy_header(array_, name_);
    const bool whole =
        array_.size() == header_.data_offset + header_.count() * header_.element_bytes;
    const CastOptions& question = job.question;
    const std::uint64_t rays = job.rays_in(chunk);
    const Reduction reduction = question.reduce.reduction;
    const bool open =
        is_sum(reduction) || (reduction == Reduction::None && question.query == Query::All);
    const std::uint64_t rows = reduction == Reduction::Bits ? (rays + 7) / 8 : rays;
    if (!whole || (!open && header_.count() != rows)) damaged();
  }
  [[nodiscard]] std::string_view descr() const {
    return descr_of(array_.substr(0, header_.data_offset));
  }
  [[nodiscard]] std::string_view data() const { return array_.substr(header_.data_offset); }
  [[nodiscard]] std::uint64_t rows() const { return header_.count(); }
  [[noreturn]] void damaged() const {
    io::bad_file(name_, "is not as it was written: remove it and run the job again");
  }

 private:
  std::string name_;
  io::MappedFile file_;
  std::string_view array_;  // all but the end
  io::NpyHeader header_;
};

std::uint64_t done_chunks(const Job& job) {
  std::uint64_t done = 0;
  for (std::uint64_t chunk = 0; chunk < job.chunks(); ++chunk) done += job.is_done(chunk) ? 1 : 0;
  return done;
}

// What workers left that were killed; young ones may belong to somebody who is at work. (With
// `older`, by a clock that need not be this machine's.)
std::vector<std::filesystem::path> leftovers(const Job& job,
                                             std::optional<std::chrono::minutes> older) {
  std::vector<std::filesystem::path> files;
  std::error_code ignored;
  const auto now = std::filesystem::file_time_type::clock::now();
  for (const auto& entry : std::filesystem::directory_iterator(job.folder / "chunks", ignored)) {
    const std::string extension = entry.path().extension().string();
    if (extension != ".new" && extension != ".part") continue;
    const auto written = entry.last_write_time(ignored);
    if (!older || (!ignored && now - written >= *older)) files.push_back(entry.path());
  }
  return files;
}

void require_all_done(const Job& job) {
  for (std::uint64_t chunk = 0; chunk < job.chunks(); ++chunk) {
    if (job.is_done(chunk)) continue;
    io::bad_file(job.folder.string(),
                 fmt::format("chunk {} is not there yet ({} of {} are): run the job to its end",
                             chunk, done_chunks(job), job.chunks()));
  }
}

void write_sum(const Job& job, const RayStream& source, io::OutputFile& out) {
  std::vector<std::uint64_t> sum, counts;
  std::string descr;
  for (std::uint64_t chunk = 0; chunk < job.chunks(); ++chunk) {
    interrupt::check();
    const ChunkFile file(job, chunk, &source);
    if (chunk == 0) {
      sum.resize(file.rows());
      descr = file.descr();
    }
    if (file.rows() != sum.size() || file.descr() != descr || descr != "'<u8'") file.damaged();
    counts.resize(sum.size());
    std::memcpy(counts.data(), file.data().data(), file.data().size());
    for (std::size_t i = 0; i < sum.size(); ++i) sum[i] += counts[i];
  }
  const std::uint64_t shape[] = {sum.size()};
  out.write(io::make_npy_header(descr, shape));
  out.write({reinterpret_cast<const char*>(sum.data()), sum.size() * sizeof(sum[0])});
}

void write_rows(const Job& job, const RayStream& source, io::OutputFile& out) {
  std::string descr;
  std::uint64_t rows = 0;
  for (std::uint64_t chunk = 0; chunk < job.chunks(); ++chunk) {
    const ChunkFile file(job, chunk, nullptr);
    if (chunk == 0) descr = file.descr();
    if (file.descr() != descr) file.damaged();
    rows += file.rows();
  }
  std::vector<std::uint64_t> shape = {rows};
  if (job.question.reduce.reduction == Reduction::Depth) shape = source.shape();
  out.write(io::make_npy_header(descr, shape));
  ProgressBar bar("merge");
  for (std::uint64_t chunk = 0; chunk < job.chunks(); ++chunk) {
    interrupt::check();
    bar.show(static_cast<double>(chunk) / static_cast<double>(job.chunks()));
    out.write(ChunkFile(job, chunk, &source).data());
  }
}

}  // namespace

int status_of_job(const StatusOptions& options) {
  const Job job = Job::open(options.folder);
  const std::uint64_t done = done_chunks(job);
  const std::uint64_t left = leftovers(job, {}).size();
  if (options.json) {
    io::JsonWriter json;
    json.open_object();
    json.value("command", "job status");
    json.value("rays", job.rays);
    json.value("chunks", job.chunks());
    json.value("done", done);
    json.value("unfinished_files", left);
    finish_json(json);
    return 0;
  }
  Summary table;
  table.add("query", name_of(job.question.query));
  if (job.question.reduce.reduction != Reduction::None)
    table.add("reduced to", name_of(job.question.reduce.reduction));
  table.add("rays", fmt::format("{}, {} a chunk", grouped(job.rays), grouped(job.chunk_rays)));
  table.add("chunks", fmt::format("{} of {} done ({})", grouped(done), grouped(job.chunks()),
                                  percentage(done, job.chunks())));
  if (left > 0)
    table.add("unfinished", fmt::format("{}, of workers that are casting or were killed",
                                        counted(left, "file", "files")));
  print(table.text());
  return 0;
}

int merge_job(const MergeOptions& options) {
  if (!io::has_extension(options.out, ".npy"))
    throw UsageError("--out: '" + options.out + "' must end in .npy");
  const Job job = Job::open(options.folder);
  require_all_done(job);
  job.check_rays();
  const RayStream source = job.open_rays();
  const interrupt::Graceful graceful;
  io::OutputFile out(options.out);
  if (is_sum(job.question.reduce.reduction)) {
    write_sum(job, source, out);
  } else {
    write_rows(job, source, out);
  }
  out.commit();
  for (const std::filesystem::path& file : leftovers(job, std::chrono::minutes(60))) {
    std::error_code ignored;
    std::filesystem::remove(file, ignored);
  }
  if (!options.quiet)
    remark(fmt::format("{} merged, wrote {}\n", counted(job.chunks(), "chunk", "chunks"),
                       options.out));
  return 0;
}

}  // namespace pierce::tool
