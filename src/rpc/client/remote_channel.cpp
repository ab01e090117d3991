#include "rpc/client/remote_channel.hpp"

#include <algorithm>
#include <utility>

#include "core/clock_wait.hpp"
#include "remote_channel_state.hpp"
#include "rpc/wire/common.hpp"
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

template <class MakeError>
void RemoteChannel::State::fail_all(MakeError make_error) {
  Entries failed{&call_memory()};
  {
    std::lock_guard lock(mutex);
    failed.swap(entries);
  }
  for (auto& [number, call] : failed) {
    auto error = make_error(call->operation());
    note_end(number, call->operation(), error);
    call->fail(std::move(error));
  }
}

void RemoteChannel::State::create_endpoints() {
  auto sender =
      SharedUse::share(port.send_requests(
                               address,
                               [state = weak_from_this()](const Guid& receiver, bool found) {
                                 if (const auto self = state.lock())
                                   self->on_server(receiver, found);
                               },
                               [state = weak_from_this()] {
                                 if (const auto self = state.lock()) self->on_full();
                               }),
                           senders.hold());
  {
    std::lock_guard lock(mutex);
    client = sender->identity();
    requests = std::move(sender);
  }
  auto receiver =
      port.receive_replies(address, client, {[state = weak_from_this()](const auto& message) {
                             if (const auto self = state.lock()) self->on_message(message);
                           }});
  std::lock_guard lock(mutex);
  if (auto delivery = receiver->caller_delivery())
    answers = std::make_shared<CallerAnswers>(std::move(delivery));
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
          what_came_malformed());
    }
    greeted = servers.size();
    lock.unlock();
    if (options.stands && !options.stands()) {
      throw Unavailable(options.peer + " left while it was being connected");
    }
    if (greeted > 0) send_open();
    lock.lock();
    const Instant next = clock.now() + (greeted > 0 ? interval : kLastOpenInterval);
    wait_until(clock, std::min(deadline, next), lock, changed,
               [&] { return phase != Phase::Opening || refusal || servers.size() != greeted; });
    if (greeted > 0) interval = std::min(2 * interval, kLastOpenInterval);
  }
  if (refusal) std::rethrow_exception(refusal);
  if (phase != Phase::Open) throw Unavailable("no connection to " + options.peer + ": " + lost_how);
}

void RemoteChannel::State::send_open() {
  std::shared_ptr<calls::Sender> sender;
  {
    std::lock_guard lock(mutex);
    if (phase != Phase::Opening) return;
    sender = requests;
  }
  Bytes message;
  wire::begin_request(message, {client, 0}, wire::kOpen, address.representation);
  wire::append_default_branch(message);
  wire::append_trailer(
      message, wire::RequestTrailer{
                   options.timeout, 0, {}, options.strategy, 0, clock.now().time_since_epoch()});
  sender->send(message);
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

void RemoteChannel::State::lose(const std::string& how) {
  {
    std::lock_guard lock(mutex);
    if (phase == Phase::Lost || phase == Phase::Closed) return;
    if (retiring) part_later();
    phase = Phase::Lost;
    if (!retiring) lost_how = how;
    changed.notify_all();
  }
  fail_all([&](const OperationInfo& operation) {
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
  if (answers) answers->hand_over();
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
  std::shared_ptr<RemoteChannel> itself;  // goes last
  std::shared_ptr<calls::Sender> sender;
  std::shared_ptr<calls::Receiver> receiver;
  std::shared_ptr<CallerAnswers> answering;
  {
    std::lock_guard lock(mutex);
    if (phase == Phase::Open) sender = requests;
  }
  if (sender && !sender->await_taken(std::chrono::milliseconds(0))) {
    clock.call_after(kPartInterval, [state = weak_from_this()] {
      const auto self = state.lock();
      if (!self) return;
      std::lock_guard lock(self->mutex);
      if (self->phase != Phase::Closed) self->part_later();
    });
    return;
  }
  sender.reset();
  std::lock_guard lock(mutex);
  if (phase == Phase::Open && !entries.empty()) return;
  itself.swap(channel);
  if (phase != Phase::Open) return;
  phase = Phase::Lost;
  sender.swap(requests);
  receiver.swap(replies);
  answering.swap(answers);
  changed.notify_all();
}

// Nothing of the port is in use any more when this returns.
void RemoteChannel::State::close() {
  std::shared_ptr<calls::Sender> sender;
  std::shared_ptr<calls::Receiver> receiver;
  std::shared_ptr<CallerAnswers> answering;
  std::shared_ptr<void> follower;
  std::shared_ptr<RemoteChannel> itself;
  TimerId outdated;
  {
    std::lock_guard lock(mutex);
    if (phase == Phase::Closed) return;
    phase = Phase::Closed;
    sender.swap(requests);
    receiver.swap(replies);
    answering.swap(answers);
    follower.swap(companion);
    itself.swap(channel);
    outdated = std::exchange(timer, 0);
    changed.notify_all();
  }
  clock.cancel(outdated);
  fail_all([&](const OperationInfo& operation) {
    return std::make_exception_ptr(
        Cancelled("the connection to " + options.peer + " was closed during " + quoted(operation)));
  });
  sender.reset();
  senders.await_end();
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
  state_->start(call, in);
}

void RemoteChannel::start_here(const std::shared_ptr<PendingCall>& call, const void* in) {
  state_->start_here(call, in);
}

void RemoteChannel::call(const OperationInfo& operation, const void* in, void* out,
                         const CallTime& time) {
  state_->call(operation, in, out, time);
}

Clock& RemoteChannel::clock() const noexcept { return state_->clock; }
Executor& RemoteChannel::continuations() const noexcept { return *state_->continuations; }
std::string RemoteChannel::peer() const { return state_->options.peer; }
std::optional<ConnectionInfo> RemoteChannel::info() const {
  ConnectionInfo info{state_->address.service, state_->address.provider, state_->options.transport,
                      state_->options.not_faster, pending()};
  std::lock_guard lock(state_->mutex);
  info.calls = state_->last_number;
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

std::size_t RemoteChannel::pending() const {
  std::lock_guard lock(state_->mutex);
  return state_->entries.size();
}

std::uint64_t RemoteChannel::malformed() const {
  std::lock_guard lock(state_->mutex);
  return state_->malformed;
}

std::uint64_t RemoteChannel::forged() const {
  std::lock_guard lock(state_->mutex);
  return state_->forged;
}

}  // namespace skein::rpc
