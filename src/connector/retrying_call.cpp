#include "retrying_call.hpp"

#include <algorithm>
#include <utility>
#include <vector>

#include "failover_channel.hpp"
#include "skein/detail/call_memory.hpp"
#include "skein/error.hpp"

namespace skein::connector {

void RetryingCall::start(const std::shared_ptr<FailoverChannel>& channel,
                         const std::shared_ptr<PendingCall>& call, const void* in) {
  const auto moving = make_shared_in_call_memory<RetryingCall>(channel, call, in);
  call->set_canceller([moving] { moving->cancel(); });
  while (const auto connection = channel->pool().ready(moving->wanted())) {
    if (moving->try_at(*channel, *connection)) return;
  }
  moving->seek();
}

RetryingCall::RetryingCall(const std::shared_ptr<FailoverChannel>& channel,
                           std::shared_ptr<PendingCall> call, const void* in)
    : WaitingCall(channel, std::move(call), in), hedged_(rule_.hedge_after().has_value()) {}

RetryingCall::~RetryingCall() { clock_.cancel(hedge_timer_); }

// A call that is over is not sent.
bool RetryingCall::try_at(const FailoverChannel& channel, const ProviderConnection& connection) {
  if (call_->claimed()) return true;
  const TypeSupport& type = *call_->operation().out;
  std::shared_ptr<void> own;
  if (hedged_) own = {type.make(), type.destroy, std::pmr::polymorphic_allocator<>(&call_memory())};
  const auto attempt = make_shared_in_call_memory<Attempt>(connection, call_, std::move(own));
  attempt->on_finished([self = shared(), attempt = attempt.get()] { self->ended(*attempt); });
  if (!channel.sent(*connection.channel, attempt, in_.get())) return false;
  bool cancelled;
  {
    std::lock_guard lock(mutex_);
    attempts_.push_back(attempt);
    if (hedged_ && attempts_.size() == 1) hedge_later(*rule_.hedge_after());
    cancelled = cancelled_;
  }
  if (cancelled) attempt->cancel();
  return true;
}

void RetryingCall::ended(Attempt& attempt) {
  auto error = attempt.take_error();
  if (!error) {
    rule_.answered();
    if (!call_->claim()) return;
    if (hedged_) call_->operation().out->assign(call_->out(), attempt.out());
    call_->finish();
    if (hedged_) cancel();
    return;
  }
  bool again;
  {
    std::lock_guard lock(mutex_);
    if (cancelled_) return;
    const bool others = others_run();
    again = rule_.admit(error, attempt.asked, clock_.now(), others);
    if (again && others) return;
  }
  if (again) return seek();
  call_->fail(std::move(error));
  cancel();
}

bool RetryingCall::others_run() const {
  return std::any_of(attempts_.begin(), attempts_.end(),
                     [](const auto& attempt) { return !attempt->finished(); });
}

// Under the lock, once the first provider has it: the second is to be another one.
void RetryingCall::hedge_later(Duration delay) {
  hedge_timer_ = clock_.call_after(delay, [weak = std::weak_ptr(shared())] {
    const auto self = weak.lock();
    if (self) self->continuations_.post([self] { self->hedge(); });
  });
}

// A second provider that is not to be had is no failure: the first one still has the call.
void RetryingCall::hedge() {
  const auto channel = channel_.lock();
  if (!channel || call_->finished()) return;
  RetryRule::Failures failures;
  std::vector<Guid> tried;
  {
    std::lock_guard lock(mutex_);
    if (!rule_.hedge()) return;
    failures = rule_.failures();
    for (const auto& attempt : attempts_) tried.push_back(attempt->asked.provider);
  }
  try {
    const ProviderQuery wanted = wanted_beside(tried, failures, call_->deadline());
    if (try_at(*channel, channel->reconnector().acquire(wanted))) return;
  } catch (const Error&) {
  }
  rule_.not_hedged();
}

void RetryingCall::cancel() {
  Attempts attempts;
  {
    std::lock_guard lock(mutex_);
    cancelled_ = true;
    attempts = attempts_;
  }
  for (const auto& attempt : attempts) attempt->cancel();
}

}  // namespace skein::connector
