// SPDX-License-Identifier: Apache-2.0
#include "support/private_mapping.h"

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

#include "pierce/error.h"

namespace pierce {
namespace {

[[noreturn]] void refuse(const std::string& path, const std::string& why) {
  throw Error(ErrorCode::BadFile, path + ": " + why);
}

constexpr std::uint64_t kPage = 4096;

}  // namespace

PrivateMapping::PrivateMapping(const std::string& path) {
  // O_NONBLOCK: opening a pipe without a writer would wait for ever.
  const int descriptor = ::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK);
  if (descriptor < 0) {
    const int reason = errno;
    refuse(path, std::string("cannot be opened: ") + std::strerror(reason) +
                     (reason == ENOENT ? ": check the name" : ""));
  }
  struct stat status = {};
  const bool known = ::fstat(descriptor, &status) == 0;
  const int reason = errno;
  void* memory = nullptr;
  if (known && S_ISREG(status.st_mode) && status.st_size > 0) {
    // NORESERVE: what is never written to needs no room of its own.
    memory = ::mmap(nullptr, static_cast<std::size_t>(status.st_size), PROT_READ | PROT_WRITE,
                    MAP_PRIVATE | MAP_NORESERVE, descriptor, 0);
  }
  const int trouble = known ? errno : reason;
  ::close(descriptor);  // the mapping keeps the file
  if (known && S_ISDIR(status.st_mode)) refuse(path, "is a folder: name a file in it");
  if (known && !S_ISREG(status.st_mode))
    refuse(path, "is a pipe or a device: save its contents to a file first");
  if (known && status.st_size == 0) refuse(path, "is empty: write it again");
  if (!known || memory == MAP_FAILED)
    refuse(path, std::string("cannot be read: ") + std::strerror(trouble));
  bytes_ = {static_cast<std::byte*>(memory), static_cast<std::size_t>(status.st_size)};
}

PrivateMapping::~PrivateMapping() { ::munmap(bytes_.data(), bytes_.size()); }

void PrivateMapping::expect(std::uint64_t offset, std::uint64_t bytes) const {
  const std::uint64_t first = offset / kPage * kPage;
  if (bytes == 0 || offset + bytes > bytes_.size()) return;
#if defined(MADV_POPULATE_READ)
  // One call in place of many page faults; an older system says no, and that is fine.
  if (::madvise(bytes_.data() + first, offset + bytes - first, MADV_POPULATE_READ) == 0) return;
#endif
  (void)::madvise(bytes_.data() + first, offset + bytes - first, MADV_WILLNEED);
}

}  // namespace pierce
