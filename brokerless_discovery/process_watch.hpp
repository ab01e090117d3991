#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <string_view>

#include "skein/guid.hpp"

namespace skein::brokerless_discovery {

/// Learns from the kernel, within a scheduling delay, that another process of this host and user
/// has ended: each participant has an abstract Unix socket on which its process listens, the others
/// stay connected to it and see it hang up, or its process end. The process greets with one byte
/// whom it lets watch; who is not greeted learns nothing from a hang-up, and connects once more.
/// One thread, `skein-watch`. Thread-safe.
///
/// Processes of other users are turned away, root's too. Whoever is turned away, or finds no room,
/// goes by the lease.
class ProcessWatch {
 public:
  /// How many connections a process takes from others, and from one of them.
  static constexpr std::size_t kMaxWatchers = 256;
  static constexpr std::size_t kMaxWatchersOfOne = 128;
  /// How many others a process watches.
  static constexpr std::size_t kMaxWatched = 256;

  /// Throws Unavailable where the kernel gives no descriptor.
  ProcessWatch();
  ~ProcessWatch();

  /// A new address at which others can watch this process; it holds the participant's GUID, so that
  /// no other participant can give it as its own. Throws as the constructor.
  std::string open(const Guid& participant);

  /// Nobody else can begin to watch at `address`. Who does already hears of the process's end.
  void close(const std::string& address);

  /// Whether open(participant) can have given the address.
  static bool is_address_of(const Guid& participant, std::string_view address);

  /// Whether it is an address at all.
  static bool is_address(std::string_view address);

  /// Equal for processes that can watch each other: same boot, same network namespace. Each
  /// process's own, with a line in the log, if either is unknown.
  static std::string host();

  /// Calls `ended` once, on the watch's thread, when the process at `address` has ended; at once
  /// where nobody listens there any more. Watching one address twice for one `watcher` calls only
  /// the first `ended`. Addresses of this object are not watched.
  void watch(const std::string& address, const void* watcher, std::function<void()> ended);

  /// `watcher` need not hear of that address any more; an `ended` may be running.
  void unwatch(const std::string& address, const void* watcher);

  /// Nor of any.
  void unwatch(const void* watcher);

  struct Counters {
    std::size_t watchers = 0;   ///< Connections from others, now.
    std::size_t watched = 0;    ///< Connections to others, now.
    std::uint64_t refused = 0;  ///< Connections turned away, since the start.
  };
  Counters counters() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace skein::brokerless_discovery
