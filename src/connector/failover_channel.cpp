#include "failover_channel.hpp"

#include <utility>

#include "retrying_call.hpp"
#include "skein/error.hpp"
#include "waiting_call.hpp"

namespace skein::connector {

FailoverChannel::FailoverChannel(ProviderConnection first, Connect connect,
                                 std::optional<Duration> hedge_after)
    : hedge_after_(hedge_after),
      clock_(first.channel->clock()),
      continuations_(first.channel->continuations()),
      pool_(std::move(first)),
      changes_(clock_, continuations_),
      reconnector_(pool_, std::move(connect)) {}

FailoverChannel::~FailoverChannel() { close(); }

void FailoverChannel::start(const std::shared_ptr<PendingCall>& call, const void* in) {
  if (RetryRule::repeats(call->operation())) {
    return call->attempt([&] { RetryingCall::start(shared_from_this(), call, in); });
  }
  const ProviderQuery wanted{call->deadline()};
  while (const auto connection = pool_.ready(wanted)) {
    if (sent(*connection->channel, call, in)) return;
  }
  // The caller does not wait, and connecting does: the request moves to a copy and another thread.
  call->attempt([&] { WaitingCall::start(shared_from_this(), call, in); });
}

// The caller waits anyway, so its own thread tries one provider after the other, without a copy. It
// does not leave the wait for a provider to the continuations: it may run on their only thread.
void FailoverChannel::call(const OperationInfo& operation, const void* in, void* out,
                           const CallTime& time) {
  if (hedge_after_ && RetryRule::repeats(operation)) {
    return Channel::call(operation, in, out, time);
  }
  RetryRule rule = rule_for(operation, time.deadline);
  std::optional<ProviderConnection> connection;
  for (;;) {
    try {
      connection = acquire(wanted_after(rule.failures(), time.deadline));
    } catch (const NoProvider&) {
      std::rethrow_exception(rule.none_found(std::current_exception(), true));
    } catch (...) {
      std::rethrow_exception(rule.none_found(std::current_exception(), false));
    }
    try {
      connection->channel->call(operation, in, out, time);
      return rule.answered();
    } catch (const NotSent&) {
      if (pool_.closed()) throw;
    } catch (...) {
      if (!RetryRule::repeats(operation)) throw;
      std::exception_ptr error = std::current_exception();
      const Asked asked{connection->provider, connection->channel};
      if (!rule.admit(error, asked, clock_.now())) std::rethrow_exception(std::move(error));
    }
  }
}

bool FailoverChannel::sent(Channel& channel, const std::shared_ptr<PendingCall>& call,
                           const void* in) const {
  try {
    channel.start_here(call, in);
  } catch (const NotSent&) {
    if (!pool_.closed()) return false;
    call->fail(std::current_exception());
  }
  return true;
}

// Waits for a provider until the deadline.
ProviderConnection FailoverChannel::acquire(const ProviderQuery& wanted) {
  if (auto connection = pool_.ready(wanted)) return *connection;
  for (;;) {
    const std::uint64_t seen = changes_.count();
    std::exception_ptr lack;
    try {
      return reconnector_.acquire(wanted);
    } catch (const NoProvider&) {
      lack = std::current_exception();
    }
    if (changes_.await(seen, wanted.deadline)) continue;
    pool_.refuse_if_closed();
    std::rethrow_exception(std::move(lack));
  }
}

std::string FailoverChannel::peer() const { return pool_.main().channel->peer(); }

bool FailoverChannel::connected() const { return pool_.connected(); }

void FailoverChannel::disconnect() {
  for (const ProviderConnection& connection : close()) connection.channel->disconnect();
}

void FailoverChannel::lose(const std::string& how) {
  for (const ProviderConnection& connection : close()) connection.channel->lose(how);
}

// In this order: a call that ceases to wait finds the pool closed.
std::vector<ProviderConnection> FailoverChannel::close() {
  auto connections = pool_.close();
  changes_.close();
  return connections;
}

}  // namespace skein::connector
