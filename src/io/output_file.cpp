// SPDX-License-Identifier: Apache-2.0
#include "io/output_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <limits>
#include <string>
#include <system_error>

#include "io/bad_file.h"
#include "io/spool_file.h"
#include "support/count_words.h"
#include "support/lock.h"

namespace pierce::io {
namespace {

constexpr std::size_t kBufferBytes = std::size_t{1} << 20;

// A link is followed, so that its target is replaced, or made, and not the link itself.
std::filesystem::path resolve(std::filesystem::path path) {
  constexpr int kLinks = 40;  // as many as Linux follows
  std::error_code ignored;
  for (int i = 0; i < kLinks && std::filesystem::is_symlink(path, ignored); ++i) {
    path = path.parent_path() / std::filesystem::read_symlink(path, ignored);
  }
  return path;
}

// Beside the target, so that it can be renamed; with a part of its name, so that there is room for
// what makes it unique.
std::filesystem::path temporary_name(const std::filesystem::path& target, unsigned attempt) {
  constexpr std::size_t kNameBytes = 200;  // of the 255 that file systems allow
  const std::string name = target.filename().string().substr(0, kNameBytes);
  return target.parent_path() / fmt::format("{}.{}-{}.part", name, ::getpid(), attempt);
}

/// The temporary files of this process. Whoever makes, renames or removes one holds the lock, so
/// that the list is always true. Never destroyed: threads may outlive main.
struct Unfinished {
  parallel::Mutex mutex;
  std::vector<std::string> files;
};

Unfinished& unfinished() {
  static auto* const all = new Unfinished;
  return *all;
}

/// Renames or removes the file; then it is no longer unfinished.
template <class Work>
void finish(const std::string& file, Work work) {
  const parallel::Lock lock(unfinished().mutex);
  work();
  std::erase(unfinished().files, file);
}

}  // namespace

void abandon_output_files() {
  unfinished().mutex.lock();  // for good
  for (const std::string& file : unfinished().files) ::unlink(file.c_str());
}

OutputFile::OutputFile(std::filesystem::path path) : path_(std::move(path)) {
  if (path_ == "-") {
    path_ = "standard output";
    descriptor_ = open_unnamed_file(folder());
    if (descriptor_ < 0) fail("cannot be prepared in the folder for temporary files");
  } else {
    open_named();
  }
  buffer_.reserve(kBufferBytes);
}

void OutputFile::open_named() {
  target_ = resolve(path_);
  std::error_code error;
  const std::filesystem::file_status status = std::filesystem::status(target_, error);
  if (error.value() == ELOOP || error.value() == ENAMETOOLONG) {  // the temporary name would do
    errno = error.value();
    fail("cannot be written");
  }
  if (std::filesystem::is_directory(status)) {
    bad_file(path_.string(), "is a folder: name a file in it");
  }
  if (std::filesystem::exists(status) && !std::filesystem::is_regular_file(status)) {
    bad_file(path_.string(), "is a pipe or a device: name an ordinary file");
  }
  const parallel::Lock lock(unfinished().mutex);
  // A name of its own for every writer: O_EXCL refuses what exists.
  for (unsigned attempt = 0; descriptor_ < 0; ++attempt) {
    temporary_ = temporary_name(target_, attempt);
    descriptor_ = ::open(temporary_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    if (descriptor_ < 0 && errno != EEXIST) fail("cannot be written");
  }
  unfinished().files.push_back(temporary_.string());
}

std::filesystem::path OutputFile::folder() const {
  std::error_code ignored;
  if (!target_.empty()) return target_.parent_path();
  const std::filesystem::path folder = std::filesystem::temp_directory_path(ignored);
  return folder.empty() ? "/tmp" : folder;
}

OutputFile::~OutputFile() {
  if (descriptor_ < 0) return;
  ::close(descriptor_);
  if (!temporary_.empty()) {
    finish(temporary_, [&] { ::unlink(temporary_.c_str()); });
  }
}

void OutputFile::reserve(std::uint64_t bytes) {
#ifdef __linux__
  constexpr std::uint64_t kWorthAsking = std::uint64_t{1} << 28;
  constexpr auto kMost = static_cast<std::uint64_t>(std::numeric_limits<off_t>::max());
  if (bytes < kWorthAsking) return;
  const auto size = static_cast<off_t>(std::min(bytes, kMost));
  if (::fallocate(descriptor_, FALLOC_FL_KEEP_SIZE, 0, size) == 0) return;
  if (errno == ENOSPC || errno == EDQUOT || errno == EFBIG)
    fail(fmt::format("has no room for {} bytes", grouped(bytes)).c_str());
#else
  (void)bytes;
#endif
}

void OutputFile::write(std::string_view bytes) {
  if (buffer_.size() + bytes.size() > kBufferBytes) flush();
  if (bytes.size() >= kBufferBytes) {
    put(bytes, flushed_);
    flushed_ += bytes.size();
  } else {
    buffer_.insert(buffer_.end(), bytes.begin(), bytes.end());
  }
}

void OutputFile::rewrite(std::uint64_t offset, std::string_view bytes) {
  flush();
  put(bytes, offset);
}

void OutputFile::commit() {
  flush();
  if (temporary_.empty()) return copy_to_standard_output();
  const int descriptor = descriptor_;
  descriptor_ = -1;
  // close reports what a network file system or a quota could not store
  int reason = ::close(descriptor) == 0 ? 0 : errno;
  finish(temporary_, [&] {
    if (reason == 0 && ::rename(temporary_.c_str(), target_.c_str()) != 0) reason = errno;
    if (reason != 0) ::unlink(temporary_.c_str());
  });
  errno = reason;
  if (reason != 0) fail("cannot be written");
}

void OutputFile::copy_to_standard_output() {
  std::vector<char> piece(kBufferBytes);
  for (std::uint64_t offset = 0; offset < flushed_;) {
    const ssize_t got =
        ::pread(descriptor_, piece.data(), piece.size(), static_cast<off_t>(offset));
    if (got < 0 && errno == EINTR) continue;
    if (got <= 0) fail("cannot be read back");
    offset += static_cast<std::uint64_t>(got);
    for (std::string_view left(piece.data(), static_cast<std::size_t>(got)); !left.empty();) {
      const ssize_t written = ::write(STDOUT_FILENO, left.data(), left.size());
      if (written < 0 && errno == EINTR) continue;
      if (written < 0 && errno == EPIPE) throw BrokenPipe();
      if (written < 0) fail("cannot be written");
      left.remove_prefix(static_cast<std::size_t>(written));
    }
  }
}

void OutputFile::flush() {
  put({buffer_.data(), buffer_.size()}, flushed_);
  flushed_ += buffer_.size();
  buffer_.clear();
}

void OutputFile::put(std::string_view bytes, std::uint64_t offset) {
  while (!bytes.empty()) {
    const ssize_t written =
        ::pwrite(descriptor_, bytes.data(), bytes.size(), static_cast<off_t>(offset));
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) fail("cannot be written");
    bytes.remove_prefix(static_cast<std::size_t>(written));
    offset += static_cast<std::uint64_t>(written);
  }
}

void OutputFile::fail(const char* what) const {
  const int reason = errno;
  const char* cure = "";
  if (reason == ENOSPC || reason == EDQUOT || reason == EFBIG)
    cure = ": free some space or write elsewhere";
  if (reason == ENOENT) cure = ": make its folder first";
  if (reason == ENAMETOOLONG) cure = ": choose a shorter name";
  if (reason == ELOOP) cure = ": its links lead in a circle, name a file";
  if (reason == EACCES || reason == EROFS) cure = ": choose a folder that you may write to";
  bad_file(path_.string(), fmt::format("{}: {}{}", what, std::strerror(reason), cure));
}

}  // namespace pierce::io
