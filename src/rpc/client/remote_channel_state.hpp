#pragma once

#include <atomic>
#include <condition_variable>
#include <exception>
#include <memory>
#include <mutex>
#include <span>
#include <string>
#include <vector>

#include "rpc/client/remote_calls.hpp"
#include "rpc/client/remote_channel.hpp"

namespace skein::rpc {

/// Opening and ending of a connection, and who may speak on it; its calls are RemoteCalls'.
struct RemoteChannel::State : std::enable_shared_from_this<State> {
  enum class Phase { Opening, Open, Lost, Closed };

  State(calls::ClientPort& port_, Executor& control_, std::shared_ptr<Executor> continuations_,
        std::shared_ptr<Clock> clock_, const calls::Address& address_, Options options_);

  calls::ClientPort& port;
  Executor& control;
  const std::shared_ptr<Executor> continuations;
  const std::shared_ptr<Clock> owned_clock;
  Clock& clock;
  const calls::Address address;
  const Options options;
  const std::shared_ptr<RequestPath> path;
  const std::shared_ptr<RefusedReplies> refused;
  std::shared_ptr<RemoteCalls> calls;  // from open() on

  mutable std::mutex mutex;
  std::condition_variable changed;
  std::atomic<Phase> phase{Phase::Opening};  // changed under the lock
  std::string lost_how;
  std::atomic<bool> retiring{false};       // the session ends with the last call on its way
  std::shared_ptr<RemoteChannel> channel;  // itself, as long as it retires
  std::exception_ptr refusal;
  std::vector<Guid> servers;  // their request receivers
  std::shared_ptr<calls::Receiver> replies;
  std::shared_ptr<CallerAnswers> answers;  // of `replies`; null if callers cannot take them
  std::shared_ptr<void> companion;

  // ---- opening
  void create_endpoints();
  void await_open();
  void on_server(const Guid& receiver, bool found);
  void on_message(const calls::Message& message);
  bool is_provider(const Guid& sender) const;
  void on_opened(std::span<const std::byte> message, const wire::ReplyHead& head);
  void dismissed(const std::string& how);

  /// Throws unless it is open: NotSent if it was lost.
  void check_open() const;

  // ---- ending
  void lose(const std::string& how);
  void retire(const std::string& how, std::shared_ptr<RemoteChannel> itself);
  void part_later();
  void part();
  void close();
};

}  // namespace skein::rpc
