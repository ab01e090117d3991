#pragma once

#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <vector>

#include "provider_connection.hpp"
#include "retry_budget.hpp"
#include "skein/clock.hpp"
#include "skein/detail/channel.hpp"
#include "skein/executor.hpp"

namespace skein::connector {

/// A connection that outlives its provider: `connect` is asked for a new connection when the
/// present one is found lost, or when its provider is suspect; a suspect provider has calls only
/// where no other is available. A call to an idempotent operation whose provider is lost or refuses
/// it is made again at the next one, within its deadline. Any other that was on its way when its
/// provider died ends as Disconnected; it is not repeated, since whether it ran is unknown. One
/// that was not sent, as its connection had ended, is made elsewhere, whatever it does.
///
/// What that costs an idempotent call whose caller does not wait: one more object, and a copy of
/// its in struct.
class FailoverChannel final : public Channel, public std::enable_shared_from_this<FailoverChannel> {
 public:
  /// Blocks until the deadline at most; throws Unavailable, or why the last one refused.
  using Connect = std::function<ProviderConnection(const ProviderQuery& wanted)>;

  FailoverChannel(ProviderConnection first, Connect connect,
                  std::optional<Duration> hedge_after = std::nullopt);

  void start(const std::shared_ptr<PendingCall>& call, const void* in) override;
  void call(const OperationInfo& operation, const void* in, void* out,
            const CallTime& time) override;
  Clock& clock() const noexcept override { return clock_; }
  Executor& continuations() const noexcept override { return continuations_; }
  std::string peer() const override;
  bool connected() const override;
  void disconnect() override;
  void lose(const std::string& how) override;

  /// Of all its calls to idempotent operations.
  const std::shared_ptr<RetryBudget>& budget() const noexcept { return budget_; }

  /// See ConnectOptions.
  const std::optional<Duration>& hedge_after() const noexcept { return hedge_after_; }

  /// A connection to a trusted provider that stands now, or nothing.
  std::optional<ProviderConnection> ready(const ProviderQuery& wanted);

  /// A connection, newly opened where none stands; a suspect one where that cannot be had. Blocks;
  /// throws what `connect` throws.
  ProviderConnection acquire(const ProviderQuery& wanted);

  /// Starts the call there. Returns false, with the call as it was, where that connection has ended
  /// and another may be had.
  bool sent(Channel& channel, const std::shared_ptr<PendingCall>& call, const void* in) const;

 private:
  std::shared_ptr<Channel> main_if_trusted() const;
  bool is_closed() const;
  void call_idempotent(const OperationInfo& operation, const void* in, void* out,
                       const CallTime& time);
  void keep(const ProviderConnection& connection);
  std::vector<ProviderConnection> close();

  Connect connect_;
  const std::optional<Duration> hedge_after_;
  const std::shared_ptr<RetryBudget> budget_ = std::make_shared<RetryBudget>();
  Clock& clock_;
  Executor& continuations_;
  std::mutex connecting_;
  mutable std::mutex mutex_;                // guards what follows
  ProviderConnection main_;                 // where calls go as long as it stands
  std::vector<ProviderConnection> others_;  // opened for calls that the main one failed
  bool closed_ = false;
};

/// A copy that lives as long as the pointer.
std::shared_ptr<void> copy_of(const TypeSupport& type, const void* value);

}  // namespace skein::connector
