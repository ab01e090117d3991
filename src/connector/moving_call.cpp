#include "moving_call.hpp"

#include <utility>

#include "failover_channel.hpp"
#include "skein/core/error.hpp"

namespace skein {

void MovingCall::start(const std::shared_ptr<FailoverChannel>& channel,
                       const std::shared_ptr<PendingCall>& call, const void* in) {
  const auto moving = std::make_shared<MovingCall>(channel, call, in);
  call->set_canceller([moving] { moving->cancel(); });
  if (const auto link = channel->ready(moving->retries_.wanted())) {
    moving->try_at(*link);
  } else {
    moving->move(nullptr);
  }
}

MovingCall::MovingCall(const std::shared_ptr<FailoverChannel>& channel,
                       std::shared_ptr<PendingCall> call, const void* in)
    : channel_(channel),
      clock_(channel->clock()),
      continuations_(channel->continuations()),
      call_(std::move(call)),
      in_(copy_of(*call_->operation().in, in)),
      retries_(call_->deadline()) {}

MovingCall::~MovingCall() { clock_.cancel(deadline_timer_); }

void MovingCall::try_at(const Link& link) {
  const auto attempt = std::make_shared<Attempt>(call_, false);
  attempt->on_finished([self = shared_from_this(), attempt = attempt.get(), provider = link.provider] {
    self->ended(*attempt, provider);
  });
  link.channel->start(attempt, in_.get());
  bool cancelled;
  {
    std::lock_guard lock(mutex_);
    attempts_.push_back(attempt);
    cancelled = cancelled_;
  }
  if (cancelled) attempt->cancel();
}

void MovingCall::ended(Attempt& attempt, const Guid& provider) {
  auto error = attempt.take_error();
  if (!error) {
    if (call_->claim()) call_->finish();
    return;
  }
  bool again;
  {
    std::lock_guard lock(mutex_);
    again = !cancelled_ && retries_.admit(error, provider, clock_.now());
  }
  if (again) {
    move(std::move(error));
  } else {
    call_->fail(std::move(error));
  }
}

// `why` is what the last provider failed with, null where there was none.
void MovingCall::move(std::exception_ptr why) {
  {
    std::lock_guard lock(mutex_);
    // While no provider has the call, nobody else watches its deadline.
    if (deadline_timer_ == 0) {
      deadline_timer_ = clock_.call_at(call_->deadline(), [call = std::weak_ptr(call_)] {
        const auto late = call.lock();
        if (!late) return;
        late->fail(std::make_exception_ptr(
            TimedOut("no provider answered " + std::string(late->operation().name) +
                     " before its deadline; whether it ran is unknown")));
      });
    }
  }
  if (continuations_.post([self = shared_from_this(), why] { self->go_on(why); })) return;
  call_->fail(std::make_exception_ptr(Overloaded("too many calls wait for another provider")));
}

void MovingCall::go_on(std::exception_ptr why) {
  const auto channel = channel_.lock();
  if (!channel || call_->finished()) return cancel();
  Wanted wanted;
  {
    std::lock_guard lock(mutex_);
    wanted = retries_.wanted();
  }
  std::exception_ptr failure;
  try {
    return try_at(channel->acquire(wanted));
  } catch (...) {
    failure = std::current_exception();
  }
  call_->fail(why ? std::move(why) : std::move(failure));
}

void MovingCall::cancel() {
  std::vector<std::shared_ptr<Attempt>> attempts;
  {
    std::lock_guard lock(mutex_);
    cancelled_ = true;
    attempts = attempts_;
  }
  for (const auto& attempt : attempts) attempt->cancel();
}

}  // namespace skein
