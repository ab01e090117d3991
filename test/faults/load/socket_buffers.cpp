#include "socket_buffers.hpp"

#include <sys/socket.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cstring>

namespace {

std::atomic<int> most{0};

}  // namespace

/// Stands before the C library's, for the vendors' modules too.
extern "C" int setsockopt(int socket, int level, int option, const void* value,
                          socklen_t size) noexcept {
  int room = 0;
  const bool buffer = level == SOL_SOCKET && (option == SO_RCVBUF || option == SO_SNDBUF);
  if (buffer && most > 0 && size == sizeof room) {
    std::memcpy(&room, value, sizeof room);
    room = std::min(room, most.load());
    value = &room;
  }
  return static_cast<int>(syscall(SYS_setsockopt, socket, level, option, value, size));
}

namespace skein::test {

SocketBuffersOfAtMost::SocketBuffersOfAtMost(int bytes) { most = bytes; }

SocketBuffersOfAtMost::~SocketBuffersOfAtMost() { most = 0; }

}  // namespace skein::test
