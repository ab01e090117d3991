#include "pipe.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <array>

#include "wake_up.hpp"

namespace skein::launch {

Pipe make_pipe() {
  std::array<int, 2> ends{};
  if (::pipe2(ends.data(), O_CLOEXEC) != 0) throw_system_error("a pipe");
  const FileDescriptor first(ends[0]);
  const FileDescriptor second(ends[1]);
  Pipe pipe{FileDescriptor(::fcntl(first.get(), F_DUPFD_CLOEXEC, kFirstPipeEnd)),
            FileDescriptor(::fcntl(second.get(), F_DUPFD_CLOEXEC, kFirstPipeEnd))};
  if (!pipe.read_end || !pipe.write_end) throw_system_error("a pipe");
  return pipe;
}

}  // namespace skein::launch
