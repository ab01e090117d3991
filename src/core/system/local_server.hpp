#pragma once

#include <sys/socket.h>

#include <chrono>
#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <utility>

#include "abstract_socket.hpp"
#include "epoll.hpp"

namespace skein {

/// Listens at names of the abstract namespace, and accepts the clients that its owner trusts. All
/// other clients are turned away, and closed by a thread for which nobody waits. After that, or if
/// the kernel has no descriptor, the server accepts nobody for a while: neither strangers nor a
/// shortage keep its thread busy. It has no thread, lock or clock; its owner passes events and the
/// time.
class LocalServer {
 public:
  using Time = std::chrono::steady_clock::time_point;
  using Trusts = std::function<bool(const ucred& client)>;
  /// Moves from the socket, which is non-blocking, if there is room for the client.
  using Take = std::function<void(FileDescriptor& socket, const ucred& client)>;

  /// `epoll` outlives this object.
  LocalServer(Epoll& epoll, Trusts trusts) : epoll_(epoll), trusts_(std::move(trusts)) {}

  LocalServer(const LocalServer&) = delete;
  LocalServer& operator=(const LocalServer&) = delete;

  /// Listens also at `name`, and moves from `socket`. Returns false, with errno, if the name is
  /// taken or the kernel refuses.
  bool open(ListeningSocket& socket, const std::string& name, int backlog = SOMAXCONN);
  void close(const std::string& name);
  bool listens_at(const std::string& name) const;

  /// Accepts clients if the event is one of this server's; returns false if not. A pause counts
  /// from `now`.
  bool handle(std::uint64_t event, Time now, const Take& take);

  /// Ends a pause that is over. Returns the end of one that is not: call it again then.
  std::optional<Time> resume(Time now);

  /// Counts the clients that were turned away.
  std::uint64_t refused() const noexcept { return refused_; }

 private:
  struct Listener {
    std::string name;
    ListeningSocket socket;
  };

  void pause(Time until);

  Epoll& epoll_;
  const Trusts trusts_;
  std::map<std::uint64_t, Listener> listeners_;
  std::optional<Time> paused_until_;
  std::uint64_t refused_ = 0;
};

}  // namespace skein
