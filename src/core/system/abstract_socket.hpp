#pragma once

#include <sys/socket.h>
#include <sys/un.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstddef>
#include <cstring>
#include <optional>
#include <string>
#include <utility>

#include "file_descriptor.hpp"

namespace skein {

/// SOCK_STREAM or SOCK_SEQPACKET.
inline FileDescriptor local_socket(int type = SOCK_STREAM) {
  return FileDescriptor(socket(AF_UNIX, type | SOCK_CLOEXEC | SOCK_NONBLOCK, 0));
}

// An abstract socket: its name begins with NUL, it lives in the network namespace, and the kernel
// removes it with the process.
inline socklen_t fill_address(sockaddr_un& address, const std::string& name) {
  address = {};
  address.sun_family = AF_UNIX;
  const std::size_t length = std::min(name.size(), sizeof(address.sun_path) - 1);
  std::memcpy(address.sun_path + 1, name.data(), length);
  return static_cast<socklen_t>(offsetof(sockaddr_un, sun_path) + 1 + length);
}

/// False, with errno, where the name is taken or the kernel refuses.
inline bool listen_at(const FileDescriptor& socket, const std::string& name,
                      int backlog = SOMAXCONN) {
  sockaddr_un address;
  const socklen_t length = fill_address(address, name);
  return bind(socket.get(), reinterpret_cast<sockaddr*>(&address), length) == 0 &&
         listen(socket.get(), backlog) == 0;
}

// A client that waits at a listening socket costs nothing. So none is let in for a while after one
// was turned away, and after the kernel had no descriptor.
inline constexpr std::chrono::milliseconds kAfterRefusal{10};
inline constexpr std::chrono::milliseconds kAfterShortage{100};
/// Others have their turn then.
inline constexpr std::size_t kAcceptedInARow = 16;

/// Lets in waiting clients, `most` at most. False if the kernel has no descriptor for the next one.
template <class Take>
bool let_in(int listening, std::size_t most, const Take& take) {
  for (; most > 0; --most) {
    FileDescriptor socket(accept4(listening, nullptr, nullptr, SOCK_CLOEXEC | SOCK_NONBLOCK));
    if (!socket) return errno != EMFILE && errno != ENFILE && errno != ENOMEM && errno != ENOBUFS;
    take(std::move(socket));
  }
  return true;
}

/// Nobody listens, or nothing is known, with the socket not connected.
enum class Reached { Yes, Nobody, Unknown };

inline Reached connect_to(const FileDescriptor& socket, const std::string& name) {
  sockaddr_un address;
  const socklen_t length = fill_address(address, name);
  if (!socket) return Reached::Unknown;
  if (connect(socket.get(), reinterpret_cast<sockaddr*>(&address), length) == 0) {
    return Reached::Yes;
  }
  return errno == ECONNREFUSED ? Reached::Nobody : Reached::Unknown;
}

/// The process at the other end, by the kernel's word.
inline std::optional<ucred> other_end(const FileDescriptor& socket) {
  ucred owner{};
  socklen_t size = sizeof owner;
  if (getsockopt(socket.get(), SOL_SOCKET, SO_PEERCRED, &owner, &size) != 0) return std::nullopt;
  return owner;
}

}  // namespace skein
