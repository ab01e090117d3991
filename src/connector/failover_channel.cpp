#include "failover_channel.hpp"

#include <algorithm>
#include <utility>

#include "skein/core/error.hpp"

namespace skein {

FailoverChannel::FailoverChannel(std::shared_ptr<Channel> first, ConnectNext connect_next)
    : connect_next_(std::move(connect_next)),
      clock_(first->clock()),
      continuations_(first->continuations()),
      channel_(std::move(first)) {}

void FailoverChannel::start(const std::shared_ptr<PendingCall>& call, const void* in) {
  if (const auto channel = current()) return channel->start(call, in);
  if (call->blocking()) {
    call->attempt([&] { reconnect(call->deadline())->start(call, in); });
    return;
  }
  // The caller does not wait, and connecting does: the request moves to a copy and another thread.
  const TypeSupport& type = *call->operation().in;
  const std::shared_ptr<void> copy(type.make(), type.destroy);
  type.assign(copy.get(), in);
  const bool posted = continuations_.post([self = shared_from_this(), call, copy] {
    call->attempt([&] { self->reconnect(call->deadline())->start(call, copy.get()); });
  });
  if (!posted) {
    call->fail(std::make_exception_ptr(Overloaded("too many calls wait for a new provider")));
  }
}

std::string FailoverChannel::peer() const {
  std::lock_guard lock(mutex_);
  return channel_->peer();
}

bool FailoverChannel::connected() const {
  std::lock_guard lock(mutex_);
  return !closed_ && channel_->connected();
}

void FailoverChannel::disconnect() {
  std::shared_ptr<Channel> channel;
  {
    std::lock_guard lock(mutex_);
    closed_ = true;
    channel = channel_;
  }
  channel->disconnect();
}

// The present connection, or nullptr where it is lost and another must be found.
std::shared_ptr<Channel> FailoverChannel::current() const {
  std::lock_guard lock(mutex_);
  return closed_ || channel_->connected() ? channel_ : nullptr;
}

std::shared_ptr<Channel> FailoverChannel::reconnect(Instant deadline) {
  std::lock_guard one_at_a_time(reconnecting_);
  if (auto channel = current()) return channel;
  auto next = connect_next_(std::max(Duration::zero(), deadline - clock_.now()));
  std::shared_ptr<Channel> old;  // destroyed outside the lock
  std::lock_guard lock(mutex_);
  old = std::exchange(channel_, next);
  return next;
}

}  // namespace skein
