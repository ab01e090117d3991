#pragma once

#include "core/system/file_descriptor.hpp"

namespace skein::launch {

struct Pipe {
  FileDescriptor read_end;
  FileDescriptor write_end;
};

/// The least number of the ends of a pipe: children get the descriptors below, which may be closed
/// in the launcher.
inline constexpr int kFirstPipeEnd = 4;

/// Both ends are closed on exec. Throws Unavailable where the system has none.
Pipe make_pipe();

}  // namespace skein::launch
