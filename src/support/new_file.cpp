// SPDX-License-Identifier: Apache-2.0
#include "support/new_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <utility>

#include "pierce/error.h"

namespace pierce {

NewFile::NewFile(std::string path) : path_(std::move(path)) {
  struct stat status = {};
  if (::stat(path_.c_str(), &status) == 0 && !S_ISREG(status.st_mode)) {
    throw Error(
        ErrorCode::BadFile,
        path_ + (S_ISDIR(status.st_mode) ? ": is a folder: name a file in it"
                                         : ": is a pipe or a device: name an ordinary file"));
  }
  // A name of its own for every writer: O_EXCL refuses what exists.
  for (unsigned attempt = 0; descriptor_ < 0; ++attempt) {
    temporary_ = path_ + "." + std::to_string(::getpid()) + "-" + std::to_string(attempt) + ".part";
    descriptor_ = ::open(temporary_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    if (descriptor_ < 0 && errno != EEXIST) fail();
  }
}

NewFile::~NewFile() {
  if (descriptor_ < 0) return;
  ::close(descriptor_);
  ::unlink(temporary_.c_str());
}

void NewFile::write(std::uint64_t offset, std::span<const std::byte> bytes) {
  while (!bytes.empty()) {
    const ssize_t written =
        ::pwrite(descriptor_, bytes.data(), bytes.size(), static_cast<off_t>(offset));
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) fail();
    bytes = bytes.subspan(static_cast<std::size_t>(written));
    offset += static_cast<std::uint64_t>(written);
  }
}

void NewFile::commit() {
  // What the system has taken, the disk may still refuse; a name must never stand for less.
  if (::fsync(descriptor_) != 0) fail();
  const int descriptor = std::exchange(descriptor_, -1);
  if (::close(descriptor) != 0 || std::rename(temporary_.c_str(), path_.c_str()) != 0) {
    const int reason = errno;
    ::unlink(temporary_.c_str());
    errno = reason;
    fail();
  }
}

void NewFile::fail() const {
  const int reason = errno;
  const char* cure = "";
  if (reason == ENOSPC || reason == EDQUOT || reason == EFBIG)
    cure = ": free some space or write elsewhere";
  if (reason == ENOENT) cure = ": make its folder first";
  if (reason == EACCES || reason == EROFS) cure = ": choose a folder that you may write to";
  throw Error(ErrorCode::BadFile, path_ + ": cannot be written: " + std::strerror(reason) + cure);
}

}  // namespace pierce
