#include "failover_channel.hpp"

#include <algorithm>
#include <utility>

#include "retrying_call.hpp"
#include "skein/detail/call_memory.hpp"
#include "skein/error.hpp"

namespace skein::connector {
namespace {

bool contains(const std::vector<Guid>& providers, const Guid& provider) {
  return std::find(providers.begin(), providers.end(), provider) != providers.end();
}

bool suits(const ProviderConnection& connection, const ProviderQuery& wanted) {
  return connection.trusted() && !contains(wanted.excluded, connection.provider);
}

}  // namespace

std::shared_ptr<void> copy_of(const TypeSupport& type, const void* value) {
  std::shared_ptr<void> copy(type.make(), type.destroy,
                             std::pmr::polymorphic_allocator<>(&call_memory()));
  type.assign(copy.get(), value);
  return copy;
}

FailoverChannel::FailoverChannel(ProviderConnection first, Connect connect,
                                 std::optional<Duration> hedge_after)
    : connect_(std::move(connect)),
      hedge_after_(hedge_after),
      clock_(first.channel->clock()),
      continuations_(first.channel->continuations()),
      main_(std::move(first)) {}

void FailoverChannel::start(const std::shared_ptr<PendingCall>& call, const void* in) {
  const OperationInfo& operation = call->operation();
  if (operation.idempotent && !operation.oneway) {
    return call->attempt([&] { RetryingCall::start(shared_from_this(), call, in); });
  }
  const ProviderQuery wanted{call->deadline()};
  const auto ready_channel = [&]() -> std::shared_ptr<Channel> {
    if (auto main = main_if_trusted()) return main;
    const auto connection = ready(wanted);
    return connection ? connection->channel : nullptr;
  };
  while (const auto channel = ready_channel()) {
    if (sent(*channel, call, in)) return;
  }
  // The caller does not wait, and connecting does: the request moves to a copy and another thread.
  const auto copy = copy_of(*operation.in, in);
  const bool posted = continuations_.post([self = shared_from_this(), call, copy, wanted] {
    call->attempt([&] {
      while (!self->sent(*self->acquire(wanted).channel, call, copy.get())) {
      }
    });
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
  for (;;) {
    const auto main = main_if_trusted();
    const auto channel = main ? main : acquire({time.deadline}).channel;
    try {
      return channel->call(operation, in, out, time);
    } catch (const NotSent&) {
      if (is_closed()) throw;
    }
  }
}

bool FailoverChannel::sent(Channel& channel, const std::shared_ptr<PendingCall>& call,
                           const void* in) const {
  try {
    channel.start_here(call, in);
  } catch (const NotSent&) {
    if (!is_closed()) return false;
    call->fail(std::current_exception());
  }
  return true;
}

bool FailoverChannel::is_closed() const {
  std::lock_guard lock(mutex_);
  return closed_;
}

std::shared_ptr<Channel> FailoverChannel::main_if_trusted() const {
  std::lock_guard lock(mutex_);
  return closed_ || main_.trusted() ? main_.channel : nullptr;
}

// The caller waits anyway, so its own thread tries one provider after the other, without a copy.
void FailoverChannel::call_idempotent(const OperationInfo& operation, const void* in, void* out,
                                      const CallTime& time) {
  Retries retries(time.deadline, budget_);
  std::exception_ptr error;
  std::optional<ProviderConnection> connection;
  for (;;) {
    try {
      connection = acquire(retries.wanted());
    } catch (...) {
      if (!error) throw;
      retries.not_made();
      break;
    }
    try {
      connection->channel->call(operation, in, out, time);
      return retries.answered();
    } catch (const NotSent&) {
      if (is_closed()) throw;
      continue;
    } catch (...) {
      error = std::current_exception();
    }
    if (!retries.admit(error, connection->provider, clock_.now())) break;
  }
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
  for (const ProviderConnection& connection : close()) connection.channel->disconnect();
}

void FailoverChannel::lose(const std::string& how) {
  for (const ProviderConnection& connection : close()) connection.channel->lose(how);
}

std::vector<ProviderConnection> FailoverChannel::close() {
  std::lock_guard lock(mutex_);
  closed_ = true;
  std::vector<ProviderConnection> connections = others_;
  connections.push_back(main_);
  return connections;
}

std::optional<ProviderConnection> FailoverChannel::ready(const ProviderQuery& wanted) {
  std::optional<ProviderConnection> lost;  // destroyed outside the lock
  std::lock_guard lock(mutex_);
  if (closed_ || suits(main_, wanted)) return main_;
  const auto other =
      std::find_if(others_.begin(), others_.end(),
                   [&](const ProviderConnection& connection) { return suits(connection, wanted); });
  if (other == others_.end()) return std::nullopt;
  const ProviderConnection connection = *other;
  if (!main_.trusted()) {
    std::swap(main_, *other);
    if (!other->channel->connected()) {
      lost = std::move(*other);
      others_.erase(other);
    }
  }
  return connection;
}

ProviderConnection FailoverChannel::acquire(const ProviderQuery& wanted) {
  if (auto connection = ready(wanted)) return *connection;
  std::lock_guard one_at_a_time(connecting_);
  if (auto connection = ready(wanted)) return *connection;
  ProviderConnection main = [&] {
    std::lock_guard lock(mutex_);
    return main_;
  }();
  // A suspect provider is better than none, but not worth waiting for another.
  const bool fall_back = main.channel->connected() && !contains(wanted.excluded, main.provider);
  ProviderQuery next = wanted;
  if (fall_back) next.wait = false;
  if (!main.channel->connected()) next.last.push_back(main.provider);
  try {
    ProviderConnection connection = connect_(next);
    keep(connection);
    return connection;
  } catch (const Error& error) {
    if (!fall_back || !is_refusal(error.code())) throw;
    return main;
  }
}

// A main connection that is lost or suspect is replaced by the new one; beside one that stands, the
// new one is kept for the next call that needs it.
void FailoverChannel::keep(const ProviderConnection& connection) {
  std::vector<ProviderConnection> ended;  // destroyed outside the lock
  std::lock_guard lock(mutex_);
  const auto lost = std::stable_partition(
      others_.begin(), others_.end(),
      [](const ProviderConnection& other) { return other.channel->connected(); });
  ended.assign(std::make_move_iterator(lost), std::make_move_iterator(others_.end()));
  others_.erase(lost, others_.end());
  if (main_.trusted()) {
    others_.push_back(connection);
  } else {
    const ProviderConnection old = std::exchange(main_, connection);
    (old.channel->connected() ? others_ : ended).push_back(old);
  }
  if (closed_) connection.channel->disconnect();
}

}  // namespace skein::connector
