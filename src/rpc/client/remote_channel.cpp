#include "rpc/client/remote_channel.hpp"

#include <algorithm>
#include <utility>

#include "core/clock_wait.hpp"
#include "remote_channel_state.hpp"
#include "rpc/wire/common.hpp"
#include "rpc/wire/reply_reading.hpp"
#include "skein/error.hpp"

namespace skein::rpc {
namespace {

// No port tells that the other side has found this one, so `open` is repeated until it is answered:
// soon at first, since the other side is mostly about to, then less often.
constexpr std::chrono::milliseconds kFirstOpenInterval{1};
constexpr std::chrono::milliseconds kLastOpenInterval{20};
// How soon it is looked again whether the last requests have arrived: no port tells.
constexpr std::chrono::milliseconds kPartInterval{5};

}  // namespace

RemoteChannel::State::State(calls::ClientPort& port_, Executor& control_,
                            std::shared_ptr<Executor> continuations_, std::shared_ptr<Clock> clock_,
                            const calls::Address& address_, Options options_)
    : port(port_),
      control(control_),
      continuations(std::move(continuations_)),
      owned_clock(std::move(clock_)),
      clock(*owned_clock),
      address(address_),
      options(std::move(options_)),
      path(std::make_shared<RequestPath>(address, clock, options.peer, options.lends,
                                         options.journal)),
      refused(std::make_shared<RefusedReplies>(address.service, options.peer)) {}

void RemoteChannel::State::create_endpoints() {
  calls = RemoteCalls::make({owned_clock, path, refused, control, options.peer, options.spin,
                             options.calls_in_flight, [state = weak_from_this()] {
                               const auto self = state.lock();
                               if (!self || !self->retiring) return;
                               std::lock_guard lock(self->mutex);
                               if (self->phase == Phase::Open) self->part_later();
                             }});
  // Before a request waits for room. The other side may wait, too, until a thread has taken answers
  // to earlier ones, and none does that is here.
  const auto on_full = [waiting = std::weak_ptr(calls)] {
    const auto self = waiting.lock();
    if (self && self->pending().size() > 1) self->hand_over();
  };
  path->open(port.send_requests(
      address,
      [state = weak_from_this()](const Guid& receiver, bool found) {
        if (const auto self = state.lock()) self->on_server(receiver, found);
      },
      on_full));
  std::shared_ptr<calls::Receiver> receiver = port.receive_replies(
      address, path->client(), {[state = weak_from_this()](const calls::Message& message) {
        if (const auto self = state.lock()) self->on_message(message);
      }});
  refused->watch(receiver.get());
  std::lock_guard lock(mutex);
  if (auto delivery = receiver->caller_delivery()) {
    answers = std::make_shared<CallerAnswers>(std::move(delivery));
    calls->set_answers(answers);
  }
  replies = std::move(receiver);
}

void RemoteChannel::State::await_open() {
  const Instant deadline = clock.after(options.timeout);
  std::unique_lock lock(mutex);
  std::size_t greeted = 0;
  auto interval = kFirstOpenInterval;
  while (phase == Phase::Opening && !refusal) {
    if (clock.now() >= deadline) {
      throw Unavailable(
          options.peer + " did not answer within " +
          std::to_string(
              std::chrono::duration_cast<std::chrono::milliseconds>(options.timeout).count()) +
          " ms" +
          (servers.empty() ? ": no provider's endpoint was found on this domain"
                           : ": its endpoint was found, but it does not reply") +
          refused->what_came_malformed());
    }
    greeted = servers.size();
    lock.unlock();
    if (options.stands && !options.stands()) {
      throw Unavailable(options.peer + " left while it was being connected");
    }
    if (greeted > 0 && phase == Phase::Opening) {
      path->send_reserved(
          wire::kOpen,
          {options.timeout, 0, {}, options.strategy, 0, clock.now().time_since_epoch()});
    }
    lock.lock();
    const Instant next = clock.now() + (greeted > 0 ? interval : kLastOpenInterval);
    wait_until(clock, std::min(deadline, next), lock, changed,
               [&] { return phase != Phase::Opening || refusal || servers.size() != greeted; });
    if (greeted > 0) interval = std::min(2 * interval, kLastOpenInterval);
  }
  if (refusal) std::rethrow_exception(refusal);
  if (phase != Phase::Open) throw Unavailable("no connection to " + options.peer + ": " + lost_how);
}

// Others may read a provider's requests, too: they are not it, and their end is not its end.
void RemoteChannel::State::on_server(const Guid& receiver, bool found) {
  if (!options.participant.is_nil() && receiver.participant() != options.participant) return;
  std::unique_lock lock(mutex);
  if (found) {
    servers.push_back(receiver);
  } else {
    std::erase(servers, receiver);
  }
  changed.notify_all();
  if (found || !servers.empty() || phase != Phase::Open) return;
  lock.unlock();
  lose(options.gone);
}

void RemoteChannel::State::on_message(const calls::Message& message) {
  if (!is_provider(message.sender)) return refused->note_forged(message.sender);
  try {
    const wire::ReplyHead head = wire::read_reply_head(message.bytes);
    if (head.related.client != path->client()) return;
    if (head.related.number == 0) {
      on_opened(message.bytes, head);
    } else if (head.operation == wire::kOpen) {
      dismissed("it had ended the session before the call arrived");
    } else {
      calls->on_reply(message.bytes, head);
    }
  } catch (const std::exception& error) {
    calls->on_unreadable(message.bytes, error);
  }
}

// Over DDS, whoever knows a client's identity can send to it.
bool RemoteChannel::State::is_provider(const Guid& sender) const {
  const Guid participant = sender.participant();
  if (!options.participant.is_nil()) return participant == options.participant;
  std::lock_guard lock(mutex);
  return std::any_of(servers.begin(), servers.end(),
                     [&](const Guid& receiver) { return receiver.participant() == participant; });
}

void RemoteChannel::State::on_opened(std::span<const std::byte> message,
                                     const wire::ReplyHead& head) {
  std::exception_ptr refused_with;
  // A server that is not built with Skein does not know `open`; that it says so proves it ready.
  // One that is refuses with a trailer.
  const bool unknown = head.exception == wire::RemoteException::UnknownOperation ||
                       (head.exception == wire::RemoteException::Unsupported &&
                        !wire::read_reply_trailer(message, head.result + 1));
  if (head.exception != wire::RemoteException::Ok && !unknown) {
    refused_with = error_in(message, head, "open", options.peer);
  }
  {
    std::lock_guard lock(mutex);
    if (phase == Phase::Opening) {
      if (refused_with) {
        refusal = refused_with;
      } else {
        phase = Phase::Open;
      }
      changed.notify_all();
      return;
    }
  }
  if (refused_with)
    dismissed("it has ended the session, as this side was not heard of for its lease");
}

// In the default partition one of several servers may not know this client, and others do.
void RemoteChannel::State::dismissed(const std::string& how) {
  if (!address.provider.is_nil()) lose(how);
}

void RemoteChannel::State::check_open() const {
  if (phase == Phase::Open) return;
  std::lock_guard lock(mutex);
  if (phase == Phase::Lost) throw NotSent("no connection to " + options.peer + ": " + lost_how);
  throw Unavailable("no connection to " + options.peer +
                    ": it was disconnected, or the entity that had connected has ended");
}

void RemoteChannel::State::lose(const std::string& how) {
  {
    std::lock_guard lock(mutex);
    if (phase == Phase::Lost || phase == Phase::Closed) return;
    if (retiring) part_later();
    phase = Phase::Lost;
    if (!retiring) lost_how = how;
    changed.notify_all();
  }
  path->give_up();
  calls->fail_all([this](const OperationInfo& operation) {
    return std::make_exception_ptr(Disconnected(options.peer + " is gone (" + lost_how +
                                                "); whether " + quoted(operation) +
                                                " ran is unknown"));
  });
}

void RemoteChannel::State::retire(const std::string& how, std::shared_ptr<RemoteChannel> itself) {
  std::lock_guard lock(mutex);
  if (phase != Phase::Open || retiring) return;
  retiring = true;
  lost_how = how;
  calls->hand_over();
  channel = std::move(itself);
  part_later();
}

// Under the lock, and not once closed: `control` may be gone then.
void RemoteChannel::State::part_later() {
  control.post([state = weak_from_this()] {
    if (const auto self = state.lock()) self->part();
  });
}

// The endpoints go here, and with them the session, once no call is on its way, a oneway one
// either: the provider waits for that.
void RemoteChannel::State::part() {
  if (phase == Phase::Open && !path->all_taken()) {
    clock.call_after(kPartInterval, [state = weak_from_this()] {
      const auto self = state.lock();
      if (!self) return;
      std::lock_guard lock(self->mutex);
      if (self->phase != Phase::Closed) self->part_later();
    });
    return;
  }
  std::shared_ptr<RemoteChannel> itself;  // goes last
  std::shared_ptr<calls::Sender> sender;
  std::shared_ptr<calls::Receiver> receiver;
  std::shared_ptr<CallerAnswers> answering;
  std::lock_guard lock(mutex);
  if (phase == Phase::Open && !calls->pending().close_if_empty()) return;
  itself.swap(channel);
  if (phase != Phase::Open) return;
  phase = Phase::Lost;
  sender = path->close();
  refused->watch(nullptr);
  receiver.swap(replies);
  answering.swap(answers);
  changed.notify_all();
}

// Nothing of the port is in use any more when this returns.
void RemoteChannel::State::close() {
  std::shared_ptr<calls::Receiver> receiver;
  std::shared_ptr<CallerAnswers> answering;
  std::shared_ptr<void> follower;
  std::shared_ptr<RemoteChannel> itself;
  {
    std::lock_guard lock(mutex);
    if (phase == Phase::Closed) return;
    phase = Phase::Closed;
    receiver.swap(replies);
    answering.swap(answers);
    follower.swap(companion);
    itself.swap(channel);
    changed.notify_all();
  }
  path->give_up();
  calls->fail_all([this](const OperationInfo& operation) {
    return std::make_exception_ptr(
        Cancelled("the connection to " + options.peer + " was closed during " + quoted(operation)));
  });
  path->close();  // only now: a request that finds no sender has ended
  path->await_end();
  refused->watch(nullptr);
}

std::shared_ptr<RemoteChannel> RemoteChannel::open(calls::ClientPort& port, Executor& control,
                                                   std::shared_ptr<Executor> continuations,
                                                   std::shared_ptr<Clock> clock,
                                                   const calls::Address& address, Options options) {
  auto state = std::make_shared<State>(port, control, std::move(continuations), std::move(clock),
                                       address, std::move(options));
  std::shared_ptr<RemoteChannel> channel(new RemoteChannel(state));
  state->create_endpoints();
  if (state->options.begun) state->options.begun(channel);
  state->await_open();
  return channel;
}

RemoteChannel::~RemoteChannel() { state_->close(); }

void RemoteChannel::start(const std::shared_ptr<PendingCall>& call, const void* in) {
  call->attempt([&] { start_here(call, in); });
}

void RemoteChannel::start_here(const std::shared_ptr<PendingCall>& call, const void* in) {
  try {
    for (;;) {
      state_->check_open();
      if (state_->calls->start(call, in)) break;
      std::lock_guard lock(state_->mutex);  // under it the phase changes, too
    }
  } catch (const NotSent&) {
    retire(state_->options.gone);  // the next call is not made here
    throw;
  } catch (...) {
    call->fail(std::current_exception());
  }
}

void RemoteChannel::call(const OperationInfo& operation, const void* in, void* out,
                         const CallTime& time) {
  const auto call = make_shared_in_call_memory<PendingCall>(operation, out, time.deadline, true);
  start_here(call, in);
  call->wait();
  if (auto error = call->take_error()) std::rethrow_exception(std::move(error));
}

Clock& RemoteChannel::clock() const noexcept { return state_->clock; }
Executor& RemoteChannel::continuations() const noexcept { return *state_->continuations; }
std::string RemoteChannel::peer() const { return state_->options.peer; }
std::optional<ConnectionInfo> RemoteChannel::info() const {
  ConnectionInfo info{state_->address.service, state_->address.provider, state_->options.transport,
                      state_->options.not_faster, pending()};
  info.calls = state_->calls->pending().total();
  return info;
}
void RemoteChannel::disconnect() { state_->close(); }
void RemoteChannel::lose(const std::string& how) { state_->lose(how); }
void RemoteChannel::retire(const std::string& how) { state_->retire(how, shared_from_this()); }

bool RemoteChannel::connected() const {
  return state_->phase == State::Phase::Open && !state_->retiring;
}

void RemoteChannel::attach(std::shared_ptr<void> companion) {
  std::lock_guard lock(state_->mutex);
  state_->companion = std::move(companion);
}

std::size_t RemoteChannel::pending() const { return state_->calls->pending().size(); }
std::uint64_t RemoteChannel::malformed() const { return state_->refused->malformed(); }
std::uint64_t RemoteChannel::forged() const { return state_->refused->forged(); }

}  // namespace skein::rpc
