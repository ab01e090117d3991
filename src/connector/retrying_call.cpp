#include "retrying_call.hpp"

#include <algorithm>
#include <utility>

#include "failover_channel.hpp"
#include "skein/detail/call_memory.hpp"
#include "skein/error.hpp"

namespace skein::connector {

void RetryingCall::start(const std::shared_ptr<FailoverChannel>& channel,
                         const std::shared_ptr<PendingCall>& call, const void* in) {
  const auto moving = make_shared_in_call_memory<RetryingCall>(channel, call, in);
  call->set_canceller([moving] { moving->cancel(); });
  while (const auto connection = channel->ready(moving->wanted())) {
    if (moving->try_at(*channel, *connection)) return;
  }
  moving->seek(nullptr);
}

RetryingCall::RetryingCall(const std::shared_ptr<FailoverChannel>& channel,
                           std::shared_ptr<PendingCall> call, const void* in)
    : WaitingCall(channel, std::move(call), in),
      hedged_(channel->hedge_after().has_value()),
      retries_(call_->deadline(), channel->budget()) {}

RetryingCall::~RetryingCall() { clock_.cancel(hedge_timer_); }

ProviderQuery RetryingCall::wanted() {
  RetryRule::Failures failures;
  {
    std::lock_guard lock(mutex_);
    failures = retries_.failures();
  }
  return wanted_after(failures, call_->deadline());
}

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
    if (hedged_ && attempts_.size() == 1) hedge_later(*channel.hedge_after());
    cancelled = cancelled_;
  }
  if (cancelled) attempt->cancel();
  return true;
}

void RetryingCall::ended(Attempt& attempt) {
  auto error = attempt.take_error();
  if (!error) {
    retries_.answered();
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
    again = retries_.admit(error, attempt.asked, clock_.now(), others);
    if (again && others) return;
  }
  if (again) return seek(error);
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
  ProviderQuery wanted = this->wanted();
  wanted.wait = false;
  {
    std::lock_guard lock(mutex_);
    if (!retries_.hedge()) return;
    for (const auto& attempt : attempts_) wanted.excluded.push_back(attempt->asked.provider);
  }
  try {
    if (try_at(*channel, channel->acquire_now(wanted))) return;
  } catch (const Error&) {
  }
  retries_.not_made();
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
