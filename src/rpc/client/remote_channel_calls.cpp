#include <algorithm>
#include <optional>
#include <utility>

#include "dds/port/sample_format.hpp"
#include "idl/encode_value.hpp"
#include "idl/left_out.hpp"
#include "remote_channel_state.hpp"
#include "rpc/wire/common.hpp"
#include "skein/error.hpp"
#include "skein/introspection.idl.hpp"

namespace skein::rpc {
namespace {

// So long before its deadline a call stops waiting for room: it has not been sent, and its caller
// hears that before the deadline's timer says that whether it ran is unknown.
constexpr std::chrono::milliseconds kToTellOfRoom{20};

}  // namespace

void RemoteChannel::State::start(const std::shared_ptr<PendingCall>& call, const void* in) {
  try {
    start_here(call, in);
  } catch (...) {
    call->fail(std::current_exception());
  }
}

void RemoteChannel::State::call(const OperationInfo& operation, const void* in, void* out,
                                const CallTime& time) {
  const auto call = make_shared_in_call_memory<PendingCall>(operation, out, time.deadline, true);
  start_here(call, in);
  call->wait();
  if (auto error = call->take_error()) std::rethrow_exception(std::move(error));
}

void RemoteChannel::State::start_here(const std::shared_ptr<PendingCall>& call, const void* in) {
  if (options.spin.count() > 0) call->set_spin(options.spin);
  bool sent = false;
  Entered entered;
  try {
    entered = enter(call);
  } catch (const NotSent&) {
    throw;
  } catch (...) {
    call->fail(std::current_exception());
    return;
  }
  const std::uint64_t number = entered.number;
  call->attempt([&] {
    const std::uint64_t told_before = told;
    sent = send(*entered.sender, *call, number, in);
    // The call ended while it was sent: the server may have heard of its end first.
    if (sent && told != told_before && call->claimed()) tell_server(number);
  });
  if (!sent || call->operation().oneway) remove(number);
  if (!sent || !call->operation().oneway || !call->claim()) return;
  note_end(number, call->operation(), nullptr);
  call->finish();
}

// The call is known before its request leaves: a reply may be here before send() returns.
RemoteChannel::State::Entered RemoteChannel::State::enter(
    const std::shared_ptr<PendingCall>& call) {
  std::unique_lock lock(mutex);
  if (phase == Phase::Lost) throw NotSent("no connection to " + options.peer + ": " + lost_how);
  if (phase != Phase::Open)
    throw Unavailable("no connection to " + options.peer +
                      ": it was disconnected, or the entity that had connected has ended");
  if (entries.size() >= options.calls_in_flight) {
    if (answers) answers->hand_over();  // some of them may have come
    throw Overloaded(std::to_string(options.calls_in_flight) + " calls to " + options.peer +
                     " already wait for their answers; the call was not sent");
  }
  const std::uint64_t number = ++last_number;
  entries.emplace(number, call);
  const TimerId outdated = look_at(call->deadline());
  if (!call->blocking()) {
    call->set_canceller([state = weak_from_this(), number] {
      if (const auto self = state.lock()) self->abandon(number);
    });
  }
  if (call->operation().stream) {
    static_cast<PendingStream&>(*call).set_granter(
        [state = weak_from_this(), number](std::uint32_t count) {
          if (const auto self = state.lock()) self->grant(number, count);
        });
  }
  if (answers && !call->operation().oneway) call->set_answers(answers);
  Entered entered{number, requests};
  lock.unlock();
  if (outdated != 0) clock.cancel(outdated);  // unlocked: it may be running
  return entered;
}

// Before a request waits for room. The other side may wait, too, until somebody has taken answers
// to earlier ones, and nobody does who is here.
void RemoteChannel::State::on_full() {
  std::lock_guard lock(mutex);
  if (answers && entries.size() > 1) answers->hand_over();
}

// Under the lock: expire_due() will run then, or before. Returns a timer that nobody needs any
// more.
TimerId RemoteChannel::State::look_at(Instant deadline) {
  if (deadline >= timer_due) return 0;
  timer_due = deadline;
  return std::exchange(timer, clock.call_at(deadline, [state = weak_from_this()] {
    if (const auto self = state.lock()) self->expire_due();
  }));
}

void RemoteChannel::State::expire_due() {
  std::vector<std::uint64_t> due;
  {
    std::lock_guard lock(mutex);
    const Instant now = clock.now();
    timer = 0;
    timer_due = Instant::max();
    Instant next = Instant::max();
    for (const auto& [number, call] : entries) {
      if (call->deadline() <= now) {
        due.push_back(number);
      } else {
        next = std::min(next, call->deadline());
      }
    }
    look_at(next);
  }
  for (const std::uint64_t number : due) expire(number);
}

// A caller that waits for the answer also waits for room, as long as it has time; others are told.
// The sender itself waits before it throws: tries are counted, too, for a clock that may stand
// still. The last one is over before the deadline is: what was not sent does not end as TimedOut.
template <class Send>
auto RemoteChannel::State::in_time(const PendingCall& call, Send send) const {
  const Duration a_try = calls::kPatience;
  for (std::optional<Duration> left;; *left -= a_try) {
    try {
      return send();
    } catch (const Overloaded&) {
      if (!call.blocking()) throw;
      // The clock is asked only now that there is need.
      left = std::min(left.value_or(Duration::max()), call.deadline() - clock.now());
      if (*left <= a_try || !is_open()) throw;
    }
  }
}

// False, and nothing is sent, if the call has ended: its server would be told of its end first.
bool RemoteChannel::State::send(calls::Sender& sender, const PendingCall& call,
                                std::uint64_t number, const void* in) {
  thread_local Bytes message;
  std::shared_ptr<LoanMemory> lent;
  std::size_t position = 0;
  {
    idl::LeavingOut leaving_out;
    put_request(message, call, number, in);
    lent = leaving_out.memory();
    position = leaving_out.position();
  }
  if (call.claimed()) return false;
  if (options.journal) {
    options.journal->note(introspection::CallStep::Sent, client, number, address.service,
                          call.operation());
  }
  const bool sent =
      lent && in_time(call, [&] { return sender.send_lending(message, lent, position); });
  if (lent && !sent) put_request(message, call, number, in);
  if (!sent) {
    const auto left = [this, &call] { return call.deadline() - clock.now() - kToTellOfRoom; };
    in_time(call, [&] { return sender.send(message, left); });
  }
  if (message.capacity() > kKeptCapacity) message = Bytes();
  return true;
}

void RemoteChannel::State::put_request(Bytes& message, const PendingCall& call,
                                       std::uint64_t number, const void* in) const {
  wire::begin_request(message, {client, number}, call.operation().hash, address.representation);
  idl::encode_value(*call.operation().in, in, message);
  if (message.size() > dds::kLargestSample) {
    const std::size_t size = std::exchange(message, Bytes()).size();
    dds::check_size(size, "the request of " + quoted(call.operation()));
  }
  const Instant now = clock.now();
  if (now >= call.deadline()) {
    throw TimedOut("the deadline of " + quoted(call.operation()) +
                   " passed before it was sent to " + options.peer + "; it did not run" +
                   kMoreTime);
  }
  wire::append_trailer(
      message, wire::RequestTrailer{call.deadline() - now,
                                    0,
                                    call.blocking() ? inherited_chain() : std::vector<Guid>(),
                                    {},
                                    call.operation().stream ? PendingStream::kWindow : 0,
                                    now.time_since_epoch()});
}

bool RemoteChannel::State::is_open() const { return phase == Phase::Open; }

// The call, which is not known by its number any more; a stream stays known until its last reply.
std::shared_ptr<PendingCall> RemoteChannel::State::remove(std::uint64_t number, Keep keep) {
  std::lock_guard lock(mutex);
  const auto found = entries.find(number);
  if (found == entries.end()) return nullptr;
  if (keep == Keep::Streams && found->second->operation().stream) return found->second;
  auto call = std::move(found->second);
  entries.erase(found);
  if (retiring && entries.empty() && phase == Phase::Open) part_later();
  return call;
}

void RemoteChannel::State::expire(std::uint64_t number) {
  const auto call = remove(number);
  if (!call || !call->claim()) return;
  std::string hint;
  {
    std::lock_guard lock(mutex);
    hint = what_came_malformed();
  }
  auto error = std::make_exception_ptr(
      TimedOut(options.peer + " did not answer " + quoted(call->operation()) +
               " before its deadline; whether it ran is unknown" + hint + kMoreTime));
  note_end(number, call->operation(), error);
  call->finish(std::move(error));
  tell_server(number);
}

void RemoteChannel::State::abandon(std::uint64_t number) {
  const auto call = remove(number);
  if (!call) return;
  note_end(number, call->operation(),
           std::make_exception_ptr(Cancelled("its caller waits no longer")));
  tell_server(number);
}

void RemoteChannel::State::tell_server(std::uint64_t number) {
  ++told;                       // before it is
  std::lock_guard lock(mutex);  // once closed, `control` may be gone
  if (phase != Phase::Open) return;
  control.post([state = weak_from_this(), number] {
    const auto self = state.lock();
    if (!self) return;
    try {
      self->send_reserved(wire::kCancel, {.target = number});
    } catch (const Error&) {
      // The server will find the call expired; cancelling early is a courtesy.
    }
  });
}

// On the thread that takes the results: one that is held up here takes none anyway.
void RemoteChannel::State::grant(std::uint64_t number, std::uint32_t count) {
  try {
    send_reserved(wire::kCredit, {.target = number, .credit = count});
  } catch (const Unavailable&) {
    // The connection has just ended: whoever tells of that ends the stream, as Disconnected.
  }
}

// About a call; nothing is to be said to a server that is gone.
void RemoteChannel::State::send_reserved(std::uint32_t operation,
                                         const wire::RequestTrailer& trailer) {
  std::shared_ptr<calls::Sender> sender;
  {
    std::lock_guard lock(mutex);
    if (phase != Phase::Open) return;
    sender = requests;
  }
  Bytes message;
  wire::begin_request(message, {client, 0}, operation, address.representation);
  wire::append_default_branch(message);
  wire::append_trailer(message, trailer);
  sender->send(message);
}

void RemoteChannel::State::note_end(std::uint64_t number, const OperationInfo& operation,
                                    const std::exception_ptr& error) {
  if (options.journal)
    options.journal->note_end(false, client, number, address.service, operation, error);
}

}  // namespace skein::rpc
