#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <unordered_map>
#include <vector>

#include "core/system/abstract_socket.hpp"
#include "core/system/epoll.hpp"

namespace skein::brokerless_discovery {

/// The processes that this one watches, by their addresses. Its owner
/// runs the actions, after it has given back its lock. Not thread-safe.
class WatchedProcesses {
 public:
  using Action = std::function<void()>;

  /// `epoll` outlives this object.
  explicit WatchedProcesses(Epoll& epoll) : epoll_(epoll) {}
  WatchedProcesses(const WatchedProcesses&) = delete;
  WatchedProcesses& operator=(const WatchedProcesses&) = delete;

  /// Returns true if nobody listens at `address`: `action` is due. Otherwise it is
  /// moved from, unless this watcher has one already or there is no room.
  [[nodiscard]] bool watch(const std::string& address, const void* watcher, Action& action);
  void unwatch(const std::string& address, const void* watcher);
  void unwatch(const void* watcher);

  /// Adds to `ended` the actions that are due if a process has ended.
  void handle(const Epoll::Event& event, std::vector<Action>& ended);

  std::size_t count() const noexcept { return watched_.size(); }

 private:
  struct Watched {
    std::uint64_t id = 0;
    FileDescriptor socket;
    std::uint64_t process_id = 0;
    FileDescriptor process;  // a child of it may keep the other end of the socket open
    bool greeted = false;
    bool second = false;  // whether the first connection ended without a greeting
    std::map<const void*, Action> actions;
  };
  using Position = std::unordered_map<std::string, Watched>::iterator;

  Reached join(Watched& other, const std::string& address);
  void heard(Position position, std::uint32_t events, std::vector<Action>& ended);
  void tell(Position position, std::vector<Action>& ended);
  void leave(const Watched& other);
  Position drop(Position position);

  Epoll& epoll_;
  std::unordered_map<std::string, Watched> watched_;
  std::unordered_map<std::uint64_t, std::string> addresses_;  // by each polled number
};

}  // namespace skein::brokerless_discovery
