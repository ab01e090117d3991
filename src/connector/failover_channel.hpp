#pragma once

#include <functional>
#include <memory>
#include <mutex>

#include "skein/core/channel.hpp"
#include "skein/core/clock.hpp"
#include "skein/core/executor.hpp"

namespace skein {

/// A connection that outlives its provider: `connect_next` is asked for a new one when the present one
/// is found lost. A call that was on its way when the provider died ends as Disconnected; it is not
/// repeated, since whether it ran is unknown.
class FailoverChannel final : public Channel, public std::enable_shared_from_this<FailoverChannel> {
 public:
  /// Blocks for at most the given time; throws Unavailable.
  using ConnectNext = std::function<std::shared_ptr<Channel>(Duration timeout)>;

  FailoverChannel(std::shared_ptr<Channel> first, ConnectNext connect_next);

  void start(const std::shared_ptr<PendingCall>& call, const void* in) override;
  Clock& clock() const noexcept override { return clock_; }
  Executor& continuations() const noexcept override { return continuations_; }
  std::string peer() const override;
  bool connected() const override;
  void disconnect() override;

 private:
  std::shared_ptr<Channel> current() const;
  std::shared_ptr<Channel> reconnect(Instant deadline);

  ConnectNext connect_next_;
  Clock& clock_;
  Executor& continuations_;
  std::mutex reconnecting_;
  mutable std::mutex mutex_;
  std::shared_ptr<Channel> channel_;
  bool closed_ = false;
};

}  // namespace skein
