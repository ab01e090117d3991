#pragma once

#include <atomic>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <string_view>
#include <utility>

#include "skein/detail/channel.hpp"
#include "skein/error.hpp"
#include "skein/guid.hpp"

namespace skein::rpc {

/// The error for a call or a client that comes to a service too late.
inline NotSent being_withdrawn(std::string_view service) {
  return NotSent(std::string(service) + " is being withdrawn");
}

/// A client's request when it connects: the paper's `initialize()`.
struct OpenRequest {
  Guid client;           ///< Nil for a client in the same process.
  std::string strategy;  ///< Selection strategy by name; empty means the provider's default.
};

/// Makes a Head's session for a new client; throws Error to refuse it.
using SessionFactory = std::function<std::shared_ptr<Session>(const OpenRequest&)>;

/// Asks a service's owner, as long as the owner is there: close() waits for each question.
/// Thread-safe.
class ServiceOwner {
 public:
  /// The name that people know a strand by; empty if it has none.
  using NameOf = std::function<std::string(const Guid& strand)>;

  /// Both may be empty. close() sets `leaving`.
  ServiceOwner(SessionFactory open, NameOf name_of, std::shared_ptr<std::atomic<bool>> leaving)
      : open_(std::move(open)), name_of_(std::move(name_of)), leaving_(std::move(leaving)) {}

  /// A session for a new client, or null if the owner makes none. Throws NotSent, which names the
  /// `service`, once it is leaving.
  std::shared_ptr<Session> open(const OpenRequest& request, std::string_view service) const {
    std::lock_guard lock(mutex_);
    if (*leaving_) throw being_withdrawn(service);
    return open_ ? open_(request) : nullptr;
  }

  /// Empty once closed.
  std::string name_of(const Guid& strand) const {
    std::lock_guard lock(mutex_);
    return name_of_ && !closed_ ? name_of_(strand) : std::string();
  }

  void close() {
    std::lock_guard lock(mutex_);
    *leaving_ = closed_ = true;
  }

 private:
  const SessionFactory open_;
  const NameOf name_of_;
  const std::shared_ptr<std::atomic<bool>> leaving_;
  mutable std::mutex mutex_;  // held while the owner is asked
  bool closed_ = false;
};

}  // namespace skein::rpc
