#include "failover_channel.hpp"

#include <algorithm>
#include <utility>

#include "moving_call.hpp"
#include "skein/core/call_memory.hpp"
#include "skein/core/error.hpp"

namespace skein::connector {
namespace {

bool contains(const std::vector<Guid>& providers, const Guid& provider) {
  return std::find(providers.begin(), providers.end(), provider) != providers.end();
}

bool suits(const Link& link, const Wanted& wanted) {
  return link.trusted() && !contains(wanted.excluded, link.provider);
}

}  // namespace

std::shared_ptr<void> copy_of(const TypeSupport& type, const void* value) {
  std::shared_ptr<void> copy(type.make(), type.destroy,
                             std::pmr::polymorphic_allocator<>(&call_memory()));
  type.assign(copy.get(), value);
  return copy;
}

FailoverChannel::FailoverChannel(Link first, Connect connect, std::optional<Duration> hedge_after)
    : connect_(std::move(connect)),
      hedge_after_(hedge_after),
      clock_(first.channel->clock()),
      continuations_(first.channel->continuations()),
      main_(std::move(first)) {}

void FailoverChannel::start(const std::shared_ptr<PendingCall>& call, const void* in) {
  const OperationInfo& operation = call->operation();
  if (operation.idempotent && !operation.oneway) {
    return call->attempt([&] { MovingCall::start(shared_from_this(), call, in); });
  }
  const Wanted wanted{call->deadline()};
  if (const auto link = ready(wanted)) return link->channel->start(call, in);
  // The caller does not wait, and connecting does: the request moves to a copy and another thread.
  const auto copy = copy_of(*operation.in, in);
  const bool posted = continuations_.post([self = shared_from_this(), call, copy, wanted] {
    call->attempt([&] { self->acquire(wanted).channel->start(call, copy.get()); });
  });
  if (!posted) {
    call->fail(std::make_exception_ptr(Overloaded("too many calls wait for a new provider")));
  }
}

void FailoverChannel::call(const OperationInfo& operation, const void* in, void* out,
                           const CallTime& time) {
  if (operation.idempotent && !operation.oneway) {
    if (hedge_after_) return Channel::call(operation, in, out, time);
    return call_idempotent(operation, in, out, time);
  }
  const auto main = main_if_trusted();
  (main ? main : acquire({time.deadline}).channel)->call(operation, in, out, time);
}

std::shared_ptr<Channel> FailoverChannel::main_if_trusted() const {
  std::lock_guard lock(mutex_);
  return closed_ || main_.trusted() ? main_.channel : nullptr;
}

// The caller waits anyway, so its own thread tries one provider after the other, without a copy.
void FailoverChannel::call_idempotent(const OperationInfo& operation, const void* in, void* out,
                                      const CallTime& time) {
  Retries retries(time.deadline);
  std::exception_ptr error;
  std::optional<Link> link;
  do {
    try {
      link = acquire(retries.wanted());
    } catch (...) {
      if (!error) error = std::current_exception();
      break;
    }
    try {
      return link->channel->call(operation, in, out, time);
    } catch (...) {
      error = std::current_exception();
    }
  } while (retries.admit(error, link->provider, clock_.now()));
  std::rethrow_exception(std::move(error));
}

std::string FailoverChannel::peer() const {
  std::lock_guard lock(mutex_);
  return main_.channel->peer();
}

bool FailoverChannel::connected() const {
  std::lock_guard lock(mutex_);
  return !closed_ && main_.channel->connected();
}

void FailoverChannel::disconnect() {
  for (const Link& link : close()) link.channel->disconnect();
}

void FailoverChannel::lose(const std::string& how) {
  for (const Link& link : close()) link.channel->lose(how);
}

std::vector<Link> FailoverChannel::close() {
  std::lock_guard lock(mutex_);
  closed_ = true;
  std::vector<Link> links = others_;
  links.push_back(main_);
  return links;
}

std::optional<Link> FailoverChannel::ready(const Wanted& wanted) {
  std::optional<Link> lost;  // destroyed outside the lock
  std::lock_guard lock(mutex_);
  if (closed_ || suits(main_, wanted)) return main_;
  const auto other = std::find_if(others_.begin(), others_.end(),
                                  [&](const Link& link) { return suits(link, wanted); });
  if (other == others_.end()) return std::nullopt;
  const Link link = *other;
  if (!main_.trusted()) {
    std::swap(main_, *other);
    if (!other->channel->connected()) {
      lost = std::move(*other);
      others_.erase(other);
    }
  }
  return link;
}

Link FailoverChannel::acquire(const Wanted& wanted) {
  if (auto link = ready(wanted)) return *link;
  std::lock_guard one_at_a_time(connecting_);
  if (auto link = ready(wanted)) return *link;
  const Link main = [&] {
    std::lock_guard lock(mutex_);
    return main_;
  }();
  // A suspect provider is better than none, but not worth waiting for another.
  const bool fall_back = main.channel->connected() && !contains(wanted.excluded, main.provider);
  Wanted next = wanted;
  if (fall_back) next.wait = false;
  if (!main.channel->connected()) next.last.push_back(main.provider);
  try {
    const Link link = connect_(next);
    keep(link);
    return link;
  } catch (const Unavailable&) {
    if (!fall_back) throw;
    return main;
  }
}

// A main link that is lost or suspect is replaced by the new one; beside one that stands, the new
// one is kept for the next call that needs it.
void FailoverChannel::keep(const Link& link) {
  std::vector<Link> ended;  // destroyed outside the lock
  std::lock_guard lock(mutex_);
  const auto lost = std::stable_partition(
      others_.begin(), others_.end(), [](const Link& other) { return other.channel->connected(); });
  ended.assign(std::make_move_iterator(lost), std::make_move_iterator(others_.end()));
  others_.erase(lost, others_.end());
  if (main_.trusted()) {
    others_.push_back(link);
  } else {
    const Link old = std::exchange(main_, link);
    (old.channel->connected() ? others_ : ended).push_back(old);
  }
  if (closed_) link.channel->disconnect();
}

}  // namespace skein::connector
