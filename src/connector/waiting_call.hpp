#pragma once

#include <exception>
#include <memory>
#include <mutex>

#include "retry_rule.hpp"
#include "skein/detail/channel.hpp"

namespace skein::connector {

class FailoverChannel;

/// A call whose caller does not wait, and for which a provider is looked for. It keeps a copy of
/// its in struct. While no provider stands it waits for one until its deadline, without a thread:
/// each look is a task of the connection's continuations. Its PendingCall owns it until that ends.
class WaitingCall : public std::enable_shared_from_this<WaitingCall> {
 public:
  /// Makes the call at the first provider that takes it.
  static void start(const std::shared_ptr<FailoverChannel>& channel,
                    const std::shared_ptr<PendingCall>& call, const void* in);

  WaitingCall(const std::shared_ptr<FailoverChannel>& channel, std::shared_ptr<PendingCall> call,
              const void* in);
  virtual ~WaitingCall();
  WaitingCall(const WaitingCall&) = delete;
  WaitingCall& operator=(const WaitingCall&) = delete;

  /// Posts a look.
  void seek();

  /// Looks for a provider now, and waits for the next change where none stands.
  void look();

 protected:
  ProviderQuery wanted();
  /// Hands the call to that provider. Returns false if the connection had ended, so that the
  /// provider has not got it.
  virtual bool try_at(const FailoverChannel& channel, const ProviderConnection& connection);

  // Weak: the last to let go of a call may be a vendor's thread, which must not end a connection.
  const std::weak_ptr<FailoverChannel> channel_;
  Clock& clock_;
  Executor& continuations_;
  const std::shared_ptr<PendingCall> call_;
  const std::shared_ptr<void> in_;

  std::mutex mutex_;  // guards the members that are not const
  RetryRule rule_;

 private:
  void own();
  void watch_deadline();
  void leave_deadline();
  bool note_lack(const std::exception_ptr& lack);
  void expire();
  void give_up(const std::exception_ptr& lack, bool waited);

  std::exception_ptr lack_;  // while it waits: why no provider was found
  TimerId deadline_timer_ = 0;
};

}  // namespace skein::connector
