#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "provider_changes.hpp"
#include "provider_pool.hpp"
#include "reconnector.hpp"
#include "retry_rule.hpp"
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
/// Where no provider stands, calls and repeats wait for one until their deadlines. A provider that
/// has refused a call and still stands is not waited for: its word is the answer.
///
/// What that costs an idempotent call whose caller does not wait: one more object, and a copy of
/// its in struct.
class FailoverChannel final : public Channel, public std::enable_shared_from_this<FailoverChannel> {
 public:
  using Connect = Reconnector::Connect;

  FailoverChannel(ProviderConnection first, Connect connect,
                  std::optional<Duration> hedge_after = std::nullopt);
  ~FailoverChannel() override;

  void start(const std::shared_ptr<PendingCall>& call, const void* in) override;
  void call(const OperationInfo& operation, const void* in, void* out,
            const CallTime& time) override;
  Clock& clock() const noexcept override { return clock_; }
  Executor& continuations() const noexcept override { return continuations_; }
  std::string peer() const override;
  bool connected() const override;
  void disconnect() override;
  void lose(const std::string& how) override;

  /// Of a new call. The calls of the connection share a budget.
  RetryRule rule_for(const OperationInfo& operation, Instant deadline) const {
    return {operation, deadline, budget_, hedge_after_};
  }

  ProviderPool& pool() noexcept { return pool_; }
  ProviderChanges& changes() noexcept { return changes_; }
  Reconnector& reconnector() noexcept { return reconnector_; }

  /// Starts the call there. Returns false, with the call as it was, where that connection has ended
  /// and another may be had.
  bool sent(Channel& channel, const std::shared_ptr<PendingCall>& call, const void* in) const;

 private:
  ProviderConnection acquire(const ProviderQuery& wanted);
  std::vector<ProviderConnection> close();

  const std::optional<Duration> hedge_after_;  // see ConnectOptions
  const std::shared_ptr<RetryBudget> budget_ = std::make_shared<RetryBudget>();
  Clock& clock_;
  Executor& continuations_;
  ProviderPool pool_;
  ProviderChanges changes_;
  Reconnector reconnector_;
};

}  // namespace skein::connector
