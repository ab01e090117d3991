#pragma once

#include <fcntl.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <array>
#include <cstdint>

#include "core/system/file_descriptor.hpp"

namespace skein::launch {

/// What getdents64(2) fills in; the C library does not declare it.
struct DirectoryEntry {
  std::uint64_t inode;
  std::int64_t offset;
  unsigned short length;
  unsigned char type;
  char name[1];
};

/// 0 for a name that is not a number.
inline int number_of(const char* name) noexcept {
  int number = 0;
  for (; *name != '\0'; ++name) {
    if (*name < '0' || *name > '9') return 0;
    number = 10 * number + (*name - '0');
  }
  return number;
}

/// Calls `visit(number, folder's descriptor)` for each entry of a folder of /proc whose name is a
/// number above 0; false if the folder cannot be read to its end. Allocates nothing, so that it may
/// be called between fork and exec.
template <class Visit>
bool for_each_number_in(const char* path, const Visit& visit) {
  const FileDescriptor folder(::open(path, O_RDONLY | O_DIRECTORY | O_CLOEXEC));
  alignas(DirectoryEntry) std::array<char, 16 * 1024> entries;
  while (true) {
    const auto size = ::syscall(SYS_getdents64, folder.get(), entries.data(), entries.size());
    if (size <= 0) return size == 0;
    for (long at = 0; at < size;) {
      const auto* entry = reinterpret_cast<const DirectoryEntry*>(entries.data() + at);
      at += entry->length;
      if (const int number = number_of(entry->name); number > 0) visit(number, folder.get());
    }
  }
}

}  // namespace skein::launch
