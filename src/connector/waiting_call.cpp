#include "waiting_call.hpp"

#include <string>
#include <utility>

#include "failover_channel.hpp"
#include "skein/detail/call_memory.hpp"
#include "skein/error.hpp"

namespace skein::connector {
namespace {

// Lives as long as the pointer.
std::shared_ptr<void> copy_of(const TypeSupport& type, const void* value) {
  std::shared_ptr<void> copy(type.make(), type.destroy,
                             std::pmr::polymorphic_allocator<>(&call_memory()));
  type.assign(copy.get(), value);
  return copy;
}

}  // namespace

void WaitingCall::start(const std::shared_ptr<FailoverChannel>& channel,
                        const std::shared_ptr<PendingCall>& call, const void* in) {
  const auto waiting = make_shared_in_call_memory<WaitingCall>(channel, call, in);
  waiting->own();
  waiting->seek();
}

WaitingCall::WaitingCall(const std::shared_ptr<FailoverChannel>& channel,
                         std::shared_ptr<PendingCall> call, const void* in)
    : channel_(channel),
      clock_(channel->clock()),
      continuations_(channel->continuations()),
      call_(std::move(call)),
      in_(copy_of(*call_->operation().in, in)),
      rule_(channel->rule_for(call_->operation(), call_->deadline())) {}

WaitingCall::~WaitingCall() { clock_.cancel(deadline_timer_); }

ProviderQuery WaitingCall::wanted() {
  RetryRule::Failures failures;
  {
    std::lock_guard lock(mutex_);
    failures = rule_.failures();
  }
  return wanted_after(failures, call_->deadline());
}

bool WaitingCall::try_at(const FailoverChannel& channel, const ProviderConnection& connection) {
  if (channel.sent(*connection.channel, call_, in_.get())) return true;
  own();  // the connection's own canceller is gone
  return false;
}

void WaitingCall::own() {
  call_->set_canceller([self = shared_from_this()] {});
}

void WaitingCall::seek() {
  {
    std::lock_guard lock(mutex_);
    lack_ = nullptr;
    watch_deadline();
  }
  if (continuations_.post([self = shared_from_this()] { self->look(); })) return;
  call_->fail(std::make_exception_ptr(Overloaded("too many calls wait for another provider")));
}

// Under the lock. While no provider has the call, nobody else watches its deadline.
void WaitingCall::watch_deadline() {
  if (deadline_timer_ != 0) return;
  deadline_timer_ = clock_.call_at(call_->deadline(), [weak = weak_from_this()] {
    if (const auto self = weak.lock()) self->expire();
  });
}

void WaitingCall::expire() {
  std::exception_ptr lack;
  {
    std::lock_guard lock(mutex_);
    lack = std::exchange(lack_, nullptr);
  }
  if (lack) return give_up(lack, true);
  call_->fail(std::make_exception_ptr(
      TimedOut("no provider answered '" + std::string(call_->operation().name) +
               "' before its deadline; whether it ran is unknown")));
}

void WaitingCall::look() {
  const auto channel = channel_.lock();
  if (!channel) return call_->cancel();
  if (call_->finished()) return;
  bool waits = note_lack(nullptr);
  const std::uint64_t seen = channel->changes().count();
  std::exception_ptr lack;
  try {
    channel->pool().refuse_if_closed();
    for (;;) {
      const ProviderConnection connection = channel->reconnector().acquire(wanted());
      leave_deadline();  // first: an attempt that fails at once seeks again, and watches it anew
      if (try_at(*channel, connection)) return;
      std::lock_guard lock(mutex_);
      watch_deadline();
    }
  } catch (const NoProvider&) {
    lack = std::current_exception();
    note_lack(lack);
    if (channel->changes().tell(seen, weak_from_this())) return;
    waits = true;
  } catch (...) {
    lack = std::current_exception();
  }
  give_up(lack, waits);
}

// Whether it was waiting.
bool WaitingCall::note_lack(const std::exception_ptr& lack) {
  std::lock_guard lock(mutex_);
  return std::exchange(lack_, lack) != nullptr;
}

// Its provider's connection watches it from now on. Unlocked: the action may be running.
void WaitingCall::leave_deadline() {
  TimerId timer = 0;
  {
    std::lock_guard lock(mutex_);
    timer = std::exchange(deadline_timer_, 0);
  }
  clock_.cancel(timer);
}

void WaitingCall::give_up(const std::exception_ptr& lack, bool waited) {
  std::exception_ptr error;
  {
    std::lock_guard lock(mutex_);
    error = rule_.none_found(lack, waited);
  }
  call_->fail(std::move(error));
}

}  // namespace skein::connector
