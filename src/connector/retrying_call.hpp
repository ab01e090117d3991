#pragma once

#include <memory>
#include <mutex>
#include <utility>
#include <vector>

#include "retries.hpp"
#include "skein/detail/call_memory.hpp"
#include "skein/detail/channel.hpp"

namespace skein::connector {

class FailoverChannel;

/// One try of a call, at one provider. Without an out struct of its own it fills the call's.
class Attempt final : public PendingCall {
 public:
  Attempt(std::shared_ptr<PendingCall> call, std::shared_ptr<void> own_out)
      : PendingCall(call->operation(), own_out ? own_out.get() : call->out(), call->deadline(),
                    false),
        call_(std::move(call)),
        own_out_(std::move(own_out)) {}

 private:
  std::shared_ptr<PendingCall> call_;  // may own the out struct
  std::shared_ptr<void> own_out_;
};

/// A call to an idempotent operation that keeps a copy of its in struct: where a provider fails it
/// moves to the next one, and where one is slow it is made at a second one, too, if the connection
/// wants that. A failure arrives on whichever thread tells of it (a vendor's, the timer's); what
/// connects and sends again is a task of the connection's continuations.
class RetryingCall final : public std::enable_shared_from_this<RetryingCall> {
 public:
  static void start(const std::shared_ptr<FailoverChannel>& channel,
                    const std::shared_ptr<PendingCall>& call, const void* in);

  RetryingCall(const std::shared_ptr<FailoverChannel>& channel, std::shared_ptr<PendingCall> call,
               const void* in);
  ~RetryingCall();

 private:
  using Attempts = std::pmr::vector<std::pair<Guid, std::shared_ptr<Attempt>>>;

  bool try_at(const FailoverChannel& channel, const ProviderConnection& connection);
  void ended(Attempt& attempt, const Guid& provider);
  bool others_run() const;
  void hedge_later(Duration delay);
  void hedge();
  void move(const std::exception_ptr& why);
  void go_on(std::exception_ptr why);
  void cancel();

  // Weak: the last to let go of a call may be a vendor's thread, which must not end a connection.
  const std::weak_ptr<FailoverChannel> channel_;
  Clock& clock_;
  Executor& continuations_;
  const std::shared_ptr<PendingCall> call_;
  const std::shared_ptr<void> in_;
  const bool hedged_;  // then two tries may be made at once, and each has an out struct of its own
  std::mutex mutex_;   // guards what follows
  Retries retries_;
  Attempts attempts_{&call_memory()};
  TimerId deadline_timer_ = 0;
  TimerId hedge_timer_ = 0;
  bool cancelled_ = false;
};

}  // namespace skein::connector
