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
  try {
    map(file.descriptor, file.size, path.string());
  } catch (...) {
    ::close(file.descriptor);
    throw;
  }
  ::close(file.descriptor);  // the mapping keeps the file
}

MappedFile::MappedFile(int descriptor, std::uint64_t size, const std::string& name) {
  map(descriptor, size, name);
}

void MappedFile::map(int descriptor, std::uint64_t size, const std::string& name) {
  void* const memory = ::mmap(nullptr, size, PROT_READ, MAP_PRIVATE, descriptor, 0);
  if (memory == MAP_FAILED) {
    bad_file(name, fmt::format("cannot be read: {}", std::strerror(errno)));
  }
  ::madvise(memory, size, MADV_SEQUENTIAL);
  bytes_ = {static_cast<const char*>(memory), size};
}

MappedFile::~MappedFile() {
  // munmap takes back what mmap gave; the constness was ours.
  ::munmap(const_cast<char*>(bytes_.data()), bytes_.size());
}

}  // namespace pierce::io
