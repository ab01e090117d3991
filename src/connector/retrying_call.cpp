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
  while (const auto connection = channel->ready(moving->retries_.wanted())) {
    if (moving->try_at(*channel, *connection)) return;
  }
  moving->move(nullptr);
}

RetryingCall::RetryingCall(const std::shared_ptr<FailoverChannel>& channel,
                           std::shared_ptr<PendingCall> call, const void* in)
    : channel_(channel),
      clock_(channel->clock()),
      continuations_(channel->continuations()),
      call_(std::move(call)),
      in_(copy_of(*call_->operation().in, in)),
      hedged_(channel->hedge_after().has_value()),
      retries_(call_->deadline(), channel->budget()) {}

RetryingCall::~RetryingCall() {
  clock_.cancel(deadline_timer_);
  clock_.cancel(hedge_timer_);
}

// False where the connection had ended, so that nobody has got the call.
bool RetryingCall::try_at(const FailoverChannel& channel, const ProviderConnection& connection) {
  const TypeSupport& type = *call_->operation().out;
  std::shared_ptr<void> own;
  if (hedged_) own = {type.make(), type.destroy, std::pmr::polymorphic_allocator<>(&call_memory())};
  const auto attempt = make_shared_in_call_memory<Attempt>(call_, std::move(own));
  attempt->on_finished([self = shared_from_this(), attempt = attempt.get(),
                        provider = connection.provider] { self->ended(*attempt, provider); });
  if (!channel.sent(*connection.channel, attempt, in_.get())) return false;
  bool cancelled;
  {
    std::lock_guard lock(mutex_);
    attempts_.emplace_back(connection.provider, attempt);
    if (hedged_ && attempts_.size() == 1) hedge_later(*channel.hedge_after());
    cancelled = cancelled_;
  }
  if (cancelled) attempt->cancel();
  return true;
}

void RetryingCall::ended(Attempt& attempt, const Guid& provider) {
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
    again = retries_.admit(error, provider, clock_.now(), others);
    if (again && others) return;
  }
  if (again) {
    move(error);
  } else {
    call_->fail(std::move(error));
    cancel();
  }
}

bool RetryingCall::others_run() const {
  return std::any_of(attempts_.begin(), attempts_.end(),
                     [](const auto& attempt) { return !attempt.second->finished(); });
}

// Under the lock, once the first provider has it: the second is to be another one.
void RetryingCall::hedge_later(Duration delay) {
  hedge_timer_ = clock_.call_after(delay, [weak = weak_from_this()] {
    const auto self = weak.lock();
    if (self) self->continuations_.post([self] { self->hedge(); });
  });
}

// A second provider that is not to be had is no failure: the first one still has the call.
void RetryingCall::hedge() {
  const auto channel = channel_.lock();
  if (!channel || call_->finished()) return;
  ProviderQuery wanted;
  {
    std::lock_guard lock(mutex_);
    if (!retries_.hedge()) return;
    wanted = retries_.wanted();
    for (const auto& [provider, attempt] : attempts_) wanted.excluded.push_back(provider);
  }
  wanted.wait = false;
  try {
    if (try_at(*channel, channel->acquire(wanted))) return;
  } catch (const Error&) {
  }
  retries_.not_made();
}

// `why` is what the last provider failed with, null where there was none.
void RetryingCall::move(const std::exception_ptr& why) {
  {
    std::lock_guard lock(mutex_);
    // While no provider has the call, nobody else watches its deadline.
    if (deadline_timer_ == 0) {
      deadline_timer_ = clock_.call_at(call_->deadline(), [call = std::weak_ptr(call_)] {
        const auto late = call.lock();
        if (!late) return;
        late->fail(std::make_exception_ptr(
            TimedOut("no provider answered '" + std::string(late->operation().name) +
                     "' before its deadline; whether it ran is unknown")));
      });
    }
  }
  if (continuations_.post([self = shared_from_this(), why] { self->go_on(why); })) return;
  call_->fail(std::make_exception_ptr(Overloaded("too many calls wait for another provider")));
}

void RetryingCall::go_on(std::exception_ptr why) {
  const auto channel = channel_.lock();
  if (!channel) return call_->cancel();
  if (call_->finished()) return;
  ProviderQuery wanted;
  {
    std::lock_guard lock(mutex_);
    wanted = retries_.wanted();
  }
  std::exception_ptr failure;
  try {
    while (!try_at(*channel, channel->acquire(wanted))) {
    }
    return;
  } catch (...) {
    failure = std::current_exception();
  }
  if (why) retries_.not_made();
  call_->fail(why ? std::move(why) : std::move(failure));
}

void RetryingCall::cancel() {
  Attempts attempts;
  {
    std::lock_guard lock(mutex_);
    cancelled_ = true;
    attempts = attempts_;
  }
  for (const auto& [provider, attempt] : attempts) attempt->cancel();
}

}  // namespace skein::connector
