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

#include "close_elsewhere.hpp"
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

inline FileDescriptor accept_at(int listening) {
  return FileDescriptor(accept4(listening, nullptr, nullptr, SOCK_CLOEXEC | SOCK_NONBLOCK));
}

/// A socket that listens. Strangers may wait at it, who are hung up elsewhere when it is closed.
class ListeningSocket : public FileDescriptor {
 public:
  ListeningSocket() = default;
  explicit ListeningSocket(FileDescriptor socket) : FileDescriptor(std::move(socket)) {}
  ListeningSocket(ListeningSocket&&) = default;
  ListeningSocket& operator=(ListeningSocket&& other) noexcept {
    close();
    FileDescriptor::operator=(std::move(other));
    return *this;
  }
  ~ListeningSocket() { close(); }

  /// The name is free afterwards, unless too much is left to be closed.
  void close() noexcept {
    if (!*this) return;
    shutdown(get(), SHUT_RDWR);  // nobody else comes
    while (!closing_is_behind()) {
      FileDescriptor waiting = accept_at(get());
      if (!waiting && (errno == EAGAIN || errno == EINVAL)) return reset();
      if (!waiting) break;
      hang_up_elsewhere(std::move(waiting));
    }
    close_elsewhere(std::move(*this));
  }
};

// A client that waits at a listening socket costs nothing. So none is let in for a while after one
// was turned away, and after the kernel had no descriptor.
inline constexpr std::chrono::milliseconds kAfterRefusal{10};
inline constexpr std::chrono::milliseconds kAfterShortage{100};
/// Others have their turn then.
inline constexpr std::size_t kAcceptedInARow = 16;

/// Lets in waiting clients, `most` at most. What `take(FileDescriptor&)` does not move from is
/// turned away. False if the kernel has no descriptor for the next one, or too many of those that
/// were turned away are still open.
template <class Take>
bool let_in(int listening, std::size_t most, const Take& take) {
  for (; most > 0; --most) {
    if (closing_is_behind()) return false;
    FileDescriptor socket = accept_at(listening);
    if (!socket) return errno != EMFILE && errno != ENFILE && errno != ENOMEM && errno != ENOBUFS;
    take(socket);
    if (socket) hang_up_elsewhere(std::move(socket));
  }
  return true;
}

/// Nobody listens; a user does whom one does not speak to; or nothing is known, as where so many
/// wait already that there is no room (EAGAIN).
enum class Reached { Yes, Nobody, Stranger, Unknown };

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

/// The socket is connected to `process` if it was reached; if not, errno says why.
struct Contact {
  Reached reached = Reached::Unknown;
  FileDescriptor socket;
  pid_t process = 0;
};

/// Connects to the process that listens at `name`, if `knows(uid_t)` its user. Never waits.
template <class Knows>
Contact reach(const std::string& name, const Knows& knows, int type = SOCK_STREAM) {
  Contact contact{Reached::Unknown, local_socket(type)};
  contact.reached = connect_to(contact.socket, name);
  if (contact.reached != Reached::Yes) return contact;
  const auto owner = other_end(contact.socket);
  if (owner && knows(owner->uid)) {
    contact.process = owner->pid;
    return contact;
  }
  hang_up_elsewhere(std::move(contact.socket));
  contact.reached = Reached::Stranger;
  return contact;
}

}  // namespace skein
