#include "request_path.hpp"

#include <algorithm>
#include <optional>
#include <utility>

#include "dds/port/sample_format.hpp"
#include "idl/encode_value.hpp"
#include "idl/left_out.hpp"
#include "rpc/wire/common.hpp"
#include "skein/error.hpp"
#include "skein/introspection.idl.hpp"
#include "skein/stream.hpp"

namespace skein::rpc {
namespace {

// So long before its deadline a call stops waiting for room: it has not been sent, and its caller
// hears that before the deadline's timer says that whether it ran is unknown.
constexpr std::chrono::milliseconds kToTellOfRoom{20};

}  // namespace

RequestPath::RequestPath(calls::Address address, Clock& clock, std::string peer, bool lends,
                         std::shared_ptr<CallJournal> journal)
    : address_(std::move(address)),
      clock_(clock),
      peer_(std::move(peer)),
      lends_(lends),
      journal_(std::move(journal)) {}

void RequestPath::open(std::unique_ptr<calls::Sender> sender) {
  client_ = sender->identity();
  std::lock_guard lock(mutex_);
  sender_ = SharedUse::share(std::move(sender), senders_.hold());
}

std::shared_ptr<calls::Sender> RequestPath::close() {
  std::lock_guard lock(mutex_);
  given_up_ = true;
  return std::exchange(sender_, nullptr);
}

std::shared_ptr<calls::Sender> RequestPath::sender() const {
  std::lock_guard lock(mutex_);
  return sender_;
}

bool RequestPath::all_taken() const {
  const auto sender = this->sender();
  return !sender || sender->await_taken(std::chrono::milliseconds(0));
}

// A caller that waits for the answer also waits for room, as long as it has time; others are told.
// The sender itself waits before it throws: tries are counted, too, for a clock that may stand
// still. The last one is over before the deadline is: what was not sent does not end as TimedOut.
template <class Send>
auto RequestPath::in_time(const PendingCall& call, Send send) const {
  const Duration a_try = calls::kPatience;
  for (std::optional<Duration> left;; *left -= a_try) {
    try {
      return send();
    } catch (const Overloaded&) {
      if (!call.blocking()) throw;
      // The clock is asked only now that there is need.
      left = std::min(left.value_or(Duration::max()), call.deadline() - clock_.now());
      if (*left <= a_try || given_up_) throw;
    }
  }
}

// If the call has ended, its server would be told of its end first.
bool RequestPath::send(const PendingCall& call, std::uint64_t number, const void* in) const {
  thread_local Bytes message;
  std::shared_ptr<LoanMemory> lent;
  std::size_t position = 0;
  if (!lends_) {
    put_request(message, call, number, in);
  } else {
    idl::LeavingOut leaving_out;
    put_request(message, call, number, in);
    lent = leaving_out.memory();
    position = leaving_out.position();
  }
  const auto sender = this->sender();
  if (call.claimed()) return false;
  if (!sender) throw NotSent("the connection to " + peer_ + " has ended; nothing was sent");
  if (journal_) {
    journal_->note(introspection::CallStep::Sent, client_, number, address_.service,
                   call.operation());
  }
  const bool sent =
      lent && in_time(call, [&] { return sender->send_lending(message, lent, position); });
  if (lent && !sent) put_request(message, call, number, in);
  if (!sent) {
    const auto left = [this, &call] { return call.deadline() - clock_.now() - kToTellOfRoom; };
    in_time(call, [&] { return sender->send(message, left); });
  }
  if (message.capacity() > kKeptCapacity) message = Bytes();
  return true;
}

void RequestPath::put_request(Bytes& message, const PendingCall& call, std::uint64_t number,
                              const void* in) const {
  wire::begin_request(message, {client_, number}, call.operation().hash, address_.representation);
  idl::encode_value(*call.operation().in, in, message);
  if (message.size() > dds::kLargestSample) {
    const std::size_t size = std::exchange(message, Bytes()).size();
    dds::check_size(size, "the request of " + quoted(call.operation()));
  }
  const Instant now = clock_.now();
  if (now >= call.deadline()) {
    throw TimedOut("the deadline of " + quoted(call.operation()) +
                   " passed before it was sent to " + peer_ + "; it did not run" + kMoreTime);
  }
  wire::append_trailer(
      message, wire::RequestTrailer{call.deadline() - now,
                                    0,
                                    call.blocking() ? inherited_chain() : std::vector<Guid>(),
                                    {},
                                    call.operation().stream ? PendingStream::kWindow : 0,
                                    now.time_since_epoch()});
}

void RequestPath::send_reserved(std::uint32_t operation,
                                const wire::RequestTrailer& trailer) const {
  const auto sender = this->sender();
  if (!sender || given_up_) return;
  Bytes message;
  wire::begin_request(message, {client_, 0}, operation, address_.representation);
  wire::append_default_branch(message);
  wire::append_trailer(message, trailer);
  sender->send(message);
}

void RequestPath::note_end(std::uint64_t number, const OperationInfo& operation,
                           const std::exception_ptr& error) const {
  if (journal_) journal_->note_end(false, client_, number, address_.service, operation, error);
}

}  // namespace skein::rpc
