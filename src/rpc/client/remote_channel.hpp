#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "call_port/call_port.hpp"
#include "rpc/service/call_journal.hpp"
#include "skein/detail/channel.hpp"

namespace skein::rpc {

/// A connection to a provider in another process. Replies are decoded on the port's thread, or on
/// the caller's if the port lends its delivery to it, straight into the caller's result.
class RemoteChannel final : public Channel, public std::enable_shared_from_this<RemoteChannel> {
 public:
  struct Options {
    std::string strategy;           ///< See OpenRequest.
    std::string peer;               ///< For messages.
    std::string transport = "DDS";  ///< See ConnectionInfo, as the next.
    std::string not_faster{};
    /// Whether the provider reads parameters that are lent to it; otherwise all are copied.
    bool lends = false;
    /// The text for a provider whose endpoint is gone, until a better reason is known.
    std::string gone = "it left, or it was not heard of for longer than its lease";
    /// The provider's participant, which alone is believed. Nil: whoever serves the address is.
    Guid participant;
    Duration timeout = std::chrono::seconds(5);
    /// How long a thread that waits for an answer looks for it before it sleeps.
    std::chrono::microseconds spin{0};
    /// Calls that may wait for their answers; beyond it a call is refused as Overloaded, unsent.
    std::size_t calls_in_flight = 4096;
    std::shared_ptr<CallJournal> journal;  ///< May be null.
    /// Asked while opening: whether the provider is still known to exist. An exception from it ends
    /// the attempt. Empty: it exists.
    std::function<bool()> stands;
    /// Called with the channel before the provider has answered: ending the channel then ends the
    /// attempt.
    std::function<void(const std::shared_ptr<RemoteChannel>&)> begun;
  };

  /// Connects: repeats `open` until the provider answers, which proves that both directions work.
  /// Blocks for `options.timeout` of the clock at most. Throws Unavailable where no answer came or
  /// the channel was ended meanwhile, and what the provider's Head threw where it refused.
  /// `port` and `control` stand until the channel is disconnected or destroyed. Not from a
  /// listener.
  static std::shared_ptr<RemoteChannel> open(calls::ClientPort& port, Executor& control,
                                             std::shared_ptr<Executor> continuations,
                                             std::shared_ptr<Clock> clock,
                                             const calls::Address& address, Options options);
  ~RemoteChannel() override;

  void start(const std::shared_ptr<PendingCall>& call, const void* in) override;
  void start_here(const std::shared_ptr<PendingCall>& call, const void* in) override;
  void call(const OperationInfo& operation, const void* in, void* out,
            const CallTime& time) override;
  Clock& clock() const noexcept override;
  Executor& continuations() const noexcept override;
  std::string peer() const override;
  std::optional<ConnectionInfo> info() const override;
  bool connected() const override;
  void disconnect() override;
  void lose(const std::string& how) override;

  /// The provider is about to leave: connected() is false from now on. Calls on their way end as
  /// they would, and the session with the last of them, also where nobody else holds the channel.
  void retire(const std::string& how);

  /// Keeps something alive for as long as the connection (what calls lose(), say).
  void attach(std::shared_ptr<void> companion);

  /// Calls without an answer yet.
  std::size_t pending() const;

  /// Replies dropped, or calls failed, because what came could not be read.
  std::uint64_t malformed() const;

  /// Replies dropped because another than the provider wrote them.
  std::uint64_t forged() const;

 private:
  struct State;
  explicit RemoteChannel(std::shared_ptr<State> state) : state_(std::move(state)) {}
  std::shared_ptr<State> state_;
};

}  // namespace skein::rpc
