#pragma once

#include <condition_variable>
#include <cstdint>
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

class WaitingCall;

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
  /// Blocks while it connects, until the deadline at most. Throws NoProvider, which may change, or
  /// why the last one refused.
  using Connect = std::function<ProviderConnection(const ProviderQuery& wanted)>;

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

  /// Keeps something until the connection ends.
  void attach(std::shared_ptr<void> companion);

  /// Other providers stand than before: calls that wait for one look again. Does not block.
  void on_change();

  /// How often that was so.
  std::uint64_t changes() const;

  /// Lets the call look again at the first change after `seen`, or when the connection ends. False
  /// if it has ended.
  bool tell_of_change(std::uint64_t seen, std::weak_ptr<WaitingCall> call);

  /// Throws Unavailable if the connection has ended for good.
  void refuse_if_closed() const;

  /// Of all its calls to idempotent operations.
  const std::shared_ptr<RetryBudget>& budget() const noexcept { return budget_; }

  /// See ConnectOptions.
  const std::optional<Duration>& hedge_after() const noexcept { return hedge_after_; }

  /// A connection to a trusted provider that stands now, or nothing.
  std::optional<ProviderConnection> ready(const ProviderQuery& wanted);

  /// A connection, newly opened where none stands; a suspect one where that cannot be had. Blocks
  /// while it connects, and throws what `connect` throws: NoProvider only where waiting helps.
  ProviderConnection acquire_now(ProviderQuery wanted);

  /// As acquire_now(), but waits for a provider until the deadline.
  ProviderConnection acquire(const ProviderQuery& wanted);

  /// Starts the call there. Returns false, with the call as it was, where that connection has ended
  /// and another may be had.
  bool sent(Channel& channel, const std::shared_ptr<PendingCall>& call, const void* in) const;

 private:
  std::shared_ptr<Channel> main_if_trusted() const;
  bool is_closed() const;
  void call_idempotent(const OperationInfo& operation, const void* in, void* out,
                       const CallTime& time);
  bool await_change(std::uint64_t seen, Instant deadline);
  void keep(const ProviderConnection& connection);
  void tell(std::vector<std::weak_ptr<WaitingCall>> calls);
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
  std::uint64_t changes_ = 0;
  std::condition_variable changed_;
  std::vector<std::weak_ptr<WaitingCall>>
      waiting_;  // and those that have ended since the last look
  std::size_t look_at_ = 16;
  std::shared_ptr<void> companion_;
};

/// A copy that lives as long as the pointer.
std::shared_ptr<void> copy_of(const TypeSupport& type, const void* value);

}  // namespace skein::connector
