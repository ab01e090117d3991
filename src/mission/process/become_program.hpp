#pragma once

#include <sys/types.h>

#include <span>

namespace skein::launch {

// For a child of fork(): these make system calls only, as no lock of another thread may be needed.

enum class Closing {
  AtOnce,
  OnExec,
};

/// Closes each descriptor from `first` on, also where the kernel does not know close_range(2) or a
/// container's filter refuses it: one by one, then.
void close_from(int first, Closing closing) noexcept;

/// What a child becomes, made before fork().
struct Launchpad {
  char* const* arguments;
  char* const* environment;
  std::span<const int> descriptors;  ///< They become 0, 1, 2, ..., and are kFirstPipeEnd or above.
  pid_t parent;
};

/// Makes this child the program: in a process group of its own, ended by the kernel with its
/// parent, with default signals and no further descriptors. Returns only if a system call is
/// refused: its name, and errno says why.
const char* become_program(const Launchpad& pad) noexcept;

}  // namespace skein::launch
