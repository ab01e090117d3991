#pragma once

#include <memory>
#include <utility>
#include <vector>

#include "skein/detail/call_memory.hpp"
#include "waiting_call.hpp"

namespace skein::connector {

/// One try of a RetryingCall, at one provider. Without its own out struct it fills the call's.
class Attempt final : public PendingCall {
 public:
  Attempt(const ProviderConnection& connection, std::shared_ptr<PendingCall> call,
          std::shared_ptr<void> own_out)
      : PendingCall(call->operation(), own_out ? own_out.get() : call->out(), call->deadline(),
                    false),
        asked{connection.provider, connection.channel},
        call_(std::move(call)),
        own_out_(std::move(own_out)) {}

  const Asked asked;

 private:
  std::shared_ptr<PendingCall> call_;  // may own the out struct
  std::shared_ptr<void> own_out_;
};

/// A call to an idempotent operation: if a provider fails, it moves to the next; if one is slow, it
/// is made at a second one, too, if the connection wants that. RetryRule (retry_rule.hpp) decides;
/// FailoverChannel starts it, or repeats a blocking, unhedged call itself. A failure arrives on any
/// thread (a vendor's, the timer's); a task of the connection's continuations connects and resends.
class RetryingCall final : public WaitingCall {
 public:
  static void start(const std::shared_ptr<FailoverChannel>& channel,
                    const std::shared_ptr<PendingCall>& call, const void* in);

  RetryingCall(const std::shared_ptr<FailoverChannel>& channel, std::shared_ptr<PendingCall> call,
               const void* in);
  ~RetryingCall() override;

 private:
  using Attempts = std::pmr::vector<std::shared_ptr<Attempt>>;

  bool try_at(const FailoverChannel& channel, const ProviderConnection& connection) override;
  std::shared_ptr<RetryingCall> shared() {
    return std::static_pointer_cast<RetryingCall>(shared_from_this());
  }
  void ended(Attempt& attempt);
  bool others_run() const;
  void hedge_later(Duration delay);
  void hedge();
  void cancel();

  const bool hedged_;  // then two tries may be made at once, and each has an out struct of its own
  // The lock guards the members below, too.
  Attempts attempts_{&call_memory()};
  TimerId hedge_timer_ = 0;
  bool cancelled_ = false;
};

}  // namespace skein::connector
