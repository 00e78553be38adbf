// SPDX-License-Identifier: Apache-2.0
#include "io/spool_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <utility>

#include "io/bad_file.h"

namespace pierce::io {
namespace {

constexpr std::size_t kSpoolBytes = std::size_t{1} << 18;

[[noreturn]] void fail_spool(const std::string& name) {
  bad_file(name, fmt::format("cannot be written: {}", std::strerror(errno)));
}

}  // namespace

int open_unnamed_file(const std::filesystem::path& folder) {
  const std::string place = folder.empty() ? "." : folder.string();
  int descriptor = -1;
#ifdef O_TMPFILE
  descriptor = ::open(place.c_str(), O_TMPFILE | O_RDWR | O_CLOEXEC, 0600);
#endif
  if (descriptor >= 0) return descriptor;
  // A file system that cannot make them: make a file and take its name away.
  std::string pattern = place + "/pierce-XXXXXX";
  descriptor = ::mkostemp(pattern.data(), O_CLOEXEC);
  if (descriptor >= 0) ::unlink(pattern.c_str());
  return descriptor;
}

SpoolFile::SpoolFile(const std::filesystem::path& folder, std::string name)
    : name_(std::move(name)), descriptor_(open_unnamed_file(folder)) {
  if (descriptor_ < 0) fail_spool(name_);
  buffer_.reserve(kSpoolBytes);
}

SpoolFile::SpoolFile(SpoolFile&& other) noexcept
    : name_(std::move(other.name_)),
      descriptor_(std::exchange(other.descriptor_, -1)),
      flushed_(other.flushed_),
      buffer_(std::move(other.buffer_)) {}

SpoolFile::~SpoolFile() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

void SpoolFile::flush() {
  const char* at = buffer_.data();
  for (std::size_t left = buffer_.size(); left > 0;) {
    const ssize_t written = ::pwrite(descriptor_, at, left, static_cast<off_t>(flushed_));
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) fail_spool(name_);
    at += written;
    left -= static_cast<std::size_t>(written);
    flushed_ += static_cast<std::uint64_t>(written);
  }
  buffer_.clear();
}

void SpoolFile::read_all(const std::function<void(std::string_view)>& consumer) {
  flush();
  for (std::uint64_t at = 0; at < flushed_;) {
    buffer_.resize(std::min<std::uint64_t>(kSpoolBytes, flushed_ - at));
    const ssize_t got =
        ::pread(descriptor_, buffer_.data(), buffer_.size(), static_cast<off_t>(at));
    if (got < 0 && errno == EINTR) continue;
    if (got <= 0) fail_spool(name_);
    consumer({buffer_.data(), static_cast<std::size_t>(got)});
    at += static_cast<std::uint64_t>(got);
  }
  buffer_.clear();
}

}  // namespace pierce::io
