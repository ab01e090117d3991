#include "rpc/service/service.hpp"

#include <algorithm>
#include <optional>
#include <utility>

#include "rpc/service/reception.hpp"
#include "rpc/wire/common.hpp"
#include "skein/error.hpp"
#include "skein/introspection.idl.hpp"

namespace skein::rpc {

Service::Service(std::shared_ptr<Servant> servant, Executor& executor, Clock& clock,
                 Options options)
    : servant_(std::move(servant)),
      executor_(executor),
      clock_(clock),
      options_(std::move(options)),
      circular_wait_{interface_info().name,
                     options_.strand.is_nil() ? options_.id : options_.strand,
                     std::max<std::size_t>(options_.threads, 1)},
      owner_(options_.open, options_.name_of, leaving_),
      accounts_{interface_info(), options_.journal, options_.recorder},
      calls_(leaving_),
      owed_(options_.queue),
      intake_(interface_info().name, options_.queue, calls_, owed_),
      caller_turns_(options_.thread == CallThread::Caller ? std::make_unique<CallerTurns>(clock)
                                                          : nullptr),
      execution_({*this, *servant_, clock_, circular_wait_.strand, options_.keeps, accounts_,
                  calls_, owed_, [this] {
                    return intake_.size() > 0 || (caller_turns_ && caller_turns_->awaited() > 0);
                  }}) {
  if (options_.thread == CallThread::Caller && options_.threads > 1) {
    throw InvalidArgument(std::string(interface_info().name) +
                          " is to run on its callers' threads, "
                          "one call at a time, and to have " +
                          std::to_string(options_.threads) +
                          " threads of its own; give it one, or CallThread::Own");
  }
  if (options_.thread == CallThread::Caller && servant_->answers_later()) {
    throw InvalidArgument(std::string(interface_info().name) +
                          " answers later, and cannot run on its callers' threads, which would "
                          "wait all the same; give it CallThread::Own");
  }
}

Service::~Service() { *leaving_ = true; }

void Service::submit(const std::shared_ptr<Invocation>& invocation,
                     const std::function<bool()>& may_run) {
  const OperationInfo& operation = *invocation->operation;
  const bool answered_later = execution_.answers_later(operation);
  invocation->arrived = clock_.now();
  OperationMeter& meter = accounts_.received(operation, *invocation);
  if (operation.stream) stream_submitted_ = true;
  std::optional<CallerTurns::Turn> turn;
  // Queued calls came earlier, perhaps from the same client, and go first. After a long call all
  // calls that have come meanwhile are queued first: a message behind them may cancel some of
  // them.
  if (may_run && Reception::is_of(*this) && !operation.stream && !answered_later &&
      calls_.none_accepted() && !execution_.latest_was_long()) {
    turn.emplace(caller_turns_.get(), Instant::min());  // if the turn is taken, the call queues
  }
  bool here = false;
  try {
    circular_wait_.refuse(*invocation, owner_);
    here = turn && turn->came() && may_run();
    if (!here) intake_.add(invocation, answered_later);
  } catch (const Error&) {
    OperationMeter::count(meter.refused);
    accounts_.ended(operation, *invocation, std::current_exception());
    throw;
  }
  // An exception there ends the process on the executor's thread, too; on this one it would be
  // reported to a client that may be gone.
  if (here) return [&]() noexcept { execution_.run(invocation, true, invocation->arrived); }();
  // Unlocked: on one processor the thread that it wakes runs at once, and needs the lock. The
  // executor ends after close(), which leaves nothing in the queue.
  executor_.post_or_run([self = shared_from_this()] {
    const auto next = self->intake_.take();
    if (!next) return;
    {
      const CallerTurns::Turn turn(self->caller_turns_.get(), next->deadline);
      self->execution_.run(next, turn.came(), self->clock_.now());
    }
    self->calls_.note_done();
  });
  // Again: the service's own thread may have left for something else meanwhile.
  if (operation.stream) stream_submitted_ = true;
}

void Service::call_here(const OperationInfo& operation, const void* in, void* out,
                        Invocation& frame) {
  OperationMeter& meter = accounts_.received(operation, frame);
  try {
    try {
      circular_wait_.refuse(frame, owner_);
    } catch (const Error&) {
      OperationMeter::count(meter.refused);
      throw;
    }
    const Instant arrived = frame.begun;
    const CallerTurns::Turn turn(caller_turns_.get(), frame.deadline);
    if (turn.waited()) {
      frame.begun = clock_.now();
      meter.waited.record(frame.begun - arrived);
    }
    if (!turn.came()) {
      const bool closed = calls_.closed();
      OperationMeter::count(closed ? meter.refused : meter.expired);
      if (closed) throw being_withdrawn(interface_info().name);
      throw TimedOut("the deadline passed while other calls of " +
                     std::string(interface_info().name) + " ran; " + quoted(operation) +
                     " was not executed");
    }
    execution_.call(operation, in, out, frame);
    execution_.refuse_too_late(operation, frame);
  } catch (...) {
    accounts_.ended(operation, frame, std::current_exception());
    throw;
  }
  accounts_.ended(operation, frame, nullptr);
}

void Service::close() {
  owner_.close();
  calls_.close(std::string(interface_info().name) + " was withdrawn");
  if (caller_turns_) caller_turns_->close();
  execution_.withdraw_owed();
  while (const auto waiting = intake_.take()) {
    execution_.withdraw(*waiting);
    calls_.note_done();
  }
}

introspection::ServiceStatistics Service::statistics() const {
  introspection::ServiceStatistics statistics;
  statistics.provider = id().bytes;
  statistics.service = interface_info().name;
  statistics.operations = accounts_.meter.read();
  statistics.waiting = static_cast<std::uint32_t>(intake_.size());
  statistics.running =
      static_cast<std::uint32_t>(owed_.size() + calls_.count([&](const Invocation& each) {
        return !execution_.answers_later(*each.operation);
      }));
  return statistics;
}

std::size_t Service::overdue() const {
  std::optional<Instant> now;
  return calls_.count([&](const Invocation& each) {
    if (!now) now = clock_.now();
    return each.deadline <= *now;
  });
}

}  // namespace skein::rpc
