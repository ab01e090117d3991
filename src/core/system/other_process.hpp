#pragma once

#include "file_descriptor.hpp"

namespace skein {

/// A descriptor (pidfd) of the process that connected, or began to listen, at the other end of a
/// local socket; none if it has ended, or cannot be seen from here. Before Linux 6.5 it is found by
/// its number, which may be another process's since it has ended: then it is not exact.
struct OtherProcess {
  FileDescriptor descriptor;
  bool is_exact = true;
};
OtherProcess other_process(const FileDescriptor& socket);

/// Whether the process has ended; false if `process` is none. Copies of its descriptors, in its
/// children, do not count.
bool has_ended(const FileDescriptor& process);

}  // namespace skein
