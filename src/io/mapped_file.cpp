// SPDX-License-Identifier: Apache-2.0
#include "io/mapped_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

#include "io/bad_file.h"

namespace pierce::io {

OpenedFile open_regular_file(const std::filesystem::path& path) {
  const std::string name = path.string();
  // O_NONBLOCK: opening a pipe without a writer would wait for ever; regular files do not mind.
  const int descriptor = ::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK);
  if (descriptor < 0) {
    const int reason = errno;
    if (reason == ENOENT && name == "-") {
      bad_file(name, "standard input is not read: give the name of a file");
    }
    bad_file(name, fmt::format("cannot be opened: {}{}", std::strerror(reason),
                               reason == ENOENT ? ": check the name" : ""));
  }
  struct stat status = {};
  std::string trouble;
  if (::fstat(descriptor, &status) != 0) {
    trouble = std::strerror(errno);
  } else if (S_ISDIR(status.st_mode)) {
    trouble = "is a folder: name a file in it";
  } else if (!S_ISREG(status.st_mode)) {
    trouble = "is a pipe or a device: save its contents to a file first";
  } else if (status.st_size == 0) {
    trouble = "is empty: write it again";
  }
  if (!trouble.empty()) {
    ::close(descriptor);
    bad_file(name, trouble);
  }
  return {descriptor, static_cast<std::uint64_t>(status.st_size)};
}

MappedFile::MappedFile(const std::filesystem::path& path) {
  const OpenedFile file = open_regular_file(path);
  void* const memory = ::mmap(nullptr, file.size, PROT_READ, MAP_PRIVATE, file.descriptor, 0);
  const int reason = errno;
  ::close(file.descriptor);  // the mapping keeps the file
  if (memory == MAP_FAILED) {
    bad_file(path.string(), fmt::format("cannot be read: {}", std::strerror(reason)));
  }
  ::madvise(memory, file.size, MADV_SEQUENTIAL);
  bytes_ = {static_cast<const char*>(memory), file.size};
}

MappedFile::~MappedFile() {
  // munmap takes back what mmap gave; the constness was ours.
  ::munmap(const_cast<char*>(bytes_.data()), bytes_.size());
}

}  // namespace pierce::io
