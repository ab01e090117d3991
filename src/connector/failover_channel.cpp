#include "failover_channel.hpp"

#include <algorithm>
#include <utility>

#include "core/clock_wait.hpp"
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

FailoverChannel::~FailoverChannel() { close(); }

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
  call->attempt([&] { WaitingCall::start(shared_from_this(), call, in); });
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
  RetryRule retries(time.deadline, budget_);
  std::exception_ptr error;
  std::optional<ProviderConnection> connection;
  for (;;) {
    try {
      connection = acquire(wanted_after(retries.failures(), time.deadline));
    } catch (const NoProvider&) {
      if (!error) throw;
      retries.not_made();
      error = waited_in_vain(error, std::current_exception());
      break;
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
    if (!retries.admit(error, {connection->provider, connection->channel}, clock_.now())) break;
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
  std::shared_ptr<void> companion;
  std::vector<std::weak_ptr<WaitingCall>> waiting;
  std::vector<ProviderConnection> connections;
  {
    std::lock_guard lock(mutex_);
    closed_ = true;
    companion.swap(companion_);
    waiting.swap(waiting_);
    connections = others_;
    connections.push_back(main_);
    changed_.notify_all();
  }
  tell(std::move(waiting));
  return connections;
}

void FailoverChannel::attach(std::shared_ptr<void> companion) {
  std::lock_guard lock(mutex_);
  if (!closed_) companion_.swap(companion);
}

void FailoverChannel::on_change() {
  std::vector<std::weak_ptr<WaitingCall>> waiting;
  {
    std::lock_guard lock(mutex_);
    ++changes_;
    waiting.swap(waiting_);
    changed_.notify_all();
  }
  tell(std::move(waiting));
}

std::uint64_t FailoverChannel::changes() const {
  std::lock_guard lock(mutex_);
  return changes_;
}

bool FailoverChannel::tell_of_change(std::uint64_t seen, std::weak_ptr<WaitingCall> call) {
  {
    std::lock_guard lock(mutex_);
    if (closed_) return false;
    if (changes_ == seen) {
      if (waiting_.size() >= look_at_) {
        std::erase_if(waiting_, [](const auto& weak) { return weak.expired(); });
        look_at_ = std::max<std::size_t>(16, 2 * waiting_.size());
      }
      waiting_.push_back(std::move(call));
      return true;
    }
  }
  tell({std::move(call)});
  return true;
}

// They were admitted when they began.
void FailoverChannel::tell(std::vector<std::weak_ptr<WaitingCall>> calls) {
  for (std::weak_ptr<WaitingCall>& call : calls) {
    continuations_.post_or_run([weak = std::move(call)] {
      if (const auto waiting = weak.lock()) waiting->look();
    });
  }
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
  for (;;) {
    const std::uint64_t seen = changes();
    std::exception_ptr lack;
    try {
      return acquire_now(wanted);
    } catch (const NoProvider&) {
      lack = std::current_exception();
    }
    if (await_change(seen, wanted.deadline)) continue;
    refuse_if_closed();
    std::rethrow_exception(std::move(lack));
  }
}

void FailoverChannel::refuse_if_closed() const {
  if (is_closed())
    throw Unavailable("no new connection: it was disconnected, or this side's entity has ended");
}

// False where the deadline came first, or the connection has ended.
bool FailoverChannel::await_change(std::uint64_t seen, Instant deadline) {
  std::unique_lock lock(mutex_);
  return wait_until(clock_, deadline, lock, changed_,
                    [&] { return closed_ || changes_ != seen; }) &&
         !closed_;
}

ProviderConnection FailoverChannel::acquire_now(ProviderQuery wanted) {
  if (auto connection = ready(wanted)) return *connection;
  std::lock_guard one_at_a_time(connecting_);
  if (auto connection = ready(wanted)) return *connection;
  ProviderConnection main = [&] {
    std::lock_guard lock(mutex_);
    return main_;
  }();
  // A suspect provider is better than none, but not worth waiting for another.
  const bool fall_back = main.channel->connected() && !contains(wanted.excluded, main.provider);
  if (fall_back) wanted.wait = false;
  if (!main.channel->connected()) wanted.last.push_back(main.provider);
  try {
    ProviderConnection connection = connect_(wanted);
    keep(connection);
    return connection;
  } catch (const NoProvider& lack) {
    if (fall_back) return main;
    if (wanted.wait) throw;
    throw Unavailable(lack.what());
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
