#pragma once

#include <functional>
#include <memory>
#include <string>

namespace skein::brokerless_discovery {

/// Learns from the kernel, within a scheduling delay, that another process of this host has ended:
/// each process listens on an abstract Unix socket, the others stay connected to it and see it hang
/// up. Nothing is ever sent. One thread, `skein-watch`. Thread-safe.
class ProcessWatch {
 public:
  /// Throws Unavailable where the kernel gives no socket.
  ProcessWatch();
  ~ProcessWatch();

  /// Where others can watch this process; unique to this object.
  const std::string& address() const noexcept;

  /// Equal for processes that can watch each other: same boot, same network namespace.
  static std::string host();

  /// Calls `ended` once, on the watch's thread, when the process at `address` has ended; at once
  /// where nobody listens there any more. Watching one address twice calls only the first `ended`.
  void watch(const std::string& address, std::function<void()> ended);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace skein::brokerless_discovery
