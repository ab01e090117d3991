#include "core/system/other_process.hpp"

#include <poll.h>
#include <sys/syscall.h>

#include <cerrno>

#include "core/system/abstract_socket.hpp"

namespace skein {
namespace {

constexpr int kPeerDescriptor = 77;  // SO_PEERPIDFD, which older C libraries do not declare

}  // namespace

OtherProcess other_process(const FileDescriptor& socket) {
  int descriptor = -1;
  socklen_t size = sizeof descriptor;
  if (getsockopt(socket.get(), SOL_SOCKET, kPeerDescriptor, &descriptor, &size) == 0) {
    return {FileDescriptor(descriptor)};
  }
  if (errno != ENOPROTOOPT) return {};
  const auto owner = other_end(socket);
  if (!owner || owner->pid <= 0) return {};
  return {FileDescriptor(static_cast<int>(syscall(SYS_pidfd_open, owner->pid, 0))), false};
}

bool has_ended(const FileDescriptor& process) {
  pollfd polled{process.get(), POLLIN, 0};
  return poll(&polled, 1, 0) > 0;
}

}  // namespace skein
