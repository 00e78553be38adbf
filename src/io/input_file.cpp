// SPDX-License-Identifier: Apache-2.0
#include "io/input_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <utility>

#include "io/bad_file.h"
#include "io/mapped_file.h"

namespace pierce::io {
namespace {

[[noreturn]] void fail(const std::string& name) {
  bad_file(name, fmt::format("cannot be read: {}", std::strerror(errno)));
}

// To the end of a pipe.
std::string read_all(int descriptor, const std::string& name) {
  constexpr std::size_t kPiece = std::size_t{1} << 20;
  std::string contents;
  std::size_t used = 0;
  while (true) {
    if (contents.size() - used < kPiece) contents.resize(std::max(2 * used, used + kPiece));
    const ssize_t got = ::read(descriptor, contents.data() + used, contents.size() - used);
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) fail(name);
    if (got == 0) break;
    used += static_cast<std::size_t>(got);
  }
  contents.resize(used);
  return contents;
}

}  // namespace

InputFile::InputFile(const std::filesystem::path& path) : name_(path.string()) {
  if (name_ == "-") {
    open_standard_input();
    return;
  }
  const OpenedFile file = open_regular_file(path);
  descriptor_ = file.descriptor;
  size_ = file.size;
}

InputFile::InputFile(std::string contents, std::string name)
    : name_(std::move(name)), size_(contents.size()), contents_(std::move(contents)) {}

InputFile::InputFile(InputFile&& other) noexcept
    : name_(std::move(other.name_)),
      descriptor_(std::exchange(other.descriptor_, -1)),
      start_(other.start_),
      size_(other.size_),
      contents_(std::move(other.contents_)),
      map_(std::move(other.map_)) {}

InputFile::~InputFile() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

void InputFile::open_standard_input() {
  name_ = "standard input";
  struct stat status = {};
  if (::fstat(STDIN_FILENO, &status) != 0) fail(name_);
  if (S_ISDIR(status.st_mode)) bad_file(name_, "is a folder: name a file in it");
  if (S_ISREG(status.st_mode)) {
    const off_t at = ::lseek(STDIN_FILENO, 0, SEEK_CUR);  // another program may have read before
    if (at < 0) fail(name_);
    start_ = static_cast<std::uint64_t>(at);
    size_ = static_cast<std::uint64_t>(std::max<off_t>(status.st_size - at, 0));
    descriptor_ = ::fcntl(STDIN_FILENO, F_DUPFD_CLOEXEC, 0);
    if (descriptor_ < 0) fail(name_);
  } else {
    contents_ = read_all(STDIN_FILENO, name_);
    size_ = contents_.size();
  }
  if (size_ == 0) {
    if (descriptor_ >= 0) ::close(descriptor_);
    bad_file(name_, "is empty: pass it the table");
  }
}

void InputFile::read(std::uint64_t offset, std::span<char> out) const {
  if (descriptor_ < 0) {
    std::copy_n(contents_.begin() + static_cast<std::ptrdiff_t>(offset), out.size(), out.begin());
    return;
  }
  offset += start_;
  while (!out.empty()) {
    const ssize_t got = ::pread(descriptor_, out.data(), out.size(), static_cast<off_t>(offset));
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) fail(name_);
    if (got == 0) bad_file(name_, "became shorter while it was read");
    out = out.subspan(static_cast<std::size_t>(got));
    offset += static_cast<std::uint64_t>(got);
  }
}

std::string_view InputFile::bytes() {
  if (descriptor_ < 0) return contents_;
  if (!map_) map_ = std::make_unique<MappedFile>(descriptor_, start_ + size_, name_);
  return map_->bytes().substr(start_);
}

}  // namespace pierce::io
