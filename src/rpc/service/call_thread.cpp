// Which thread runs a call: the service's own, which takes it from the queue or from the port
// itself; or the caller's.
#include <optional>

#include "core/clock_wait.hpp"
#include "rpc/service/reception.hpp"
#include "rpc/service/service.hpp"
#include "rpc/wire/common.hpp"
#include "skein/error.hpp"

namespace skein::rpc {

void Service::submit(const std::shared_ptr<Invocation>& invocation,
                     const std::function<bool()>& may_run) {
  OperationMeter& meter = meter_.of(*invocation->operation);
  OperationMeter::count(meter.received);
  invocation->arrived = clock_.now();
  note_begin(*invocation->operation, *invocation);
  if (invocation->operation->stream) stream_submitted_ = true;
  std::optional<CallerTurns::Turn> turn;
  if (may_run && runs_on_arrival(*invocation->operation)) {
    turn.emplace(caller_turns_.get(), Instant::min());  // who would have to wait for it queues
  }
  bool here = false;
  try {
    refuse_self_wait(*invocation);
    here = turn && turn->came() && may_run();
    if (!here) enqueue(invocation);
    // Again: the service's own thread may have left for something else meanwhile.
    if (invocation->operation->stream) stream_submitted_ = true;
  } catch (const Error&) {
    OperationMeter::count(meter.refused);
    note_end(*invocation->operation, *invocation, std::current_exception());
    throw;
  }
  // What is thrown there ends the process on the executor's thread, too; on this one it would be
  // told to who may be gone.
  if (here) [&]() noexcept { execute_in_turn(invocation, true, invocation->arrived); }();
}

// What waits in the queue has come earlier, from the same client perhaps. After a long call
// everything queues first that has come meanwhile: some of it may be cancelled by what comes next.
bool Service::runs_on_arrival(const OperationInfo& operation) const {
  return Reception::is_of(*this) && !operation.stream && !is_deferred(operation) &&
         accepted_ == 0 && !latest_was_long_.load(std::memory_order_relaxed);
}

void Service::enqueue(std::shared_ptr<Invocation> invocation) {
  {
    std::lock_guard lock(queue_mutex_);
    if (closed_) throw being_withdrawn();
    if (!queue_.has_room(invocation->connection)) {
      throw Overloaded("the queue of " + std::string(interface_info().name) +
                       " is full; the call was not executed");
    }
    if (is_deferred(*invocation->operation) && !may_owe(invocation->connection)) {
      throw Overloaded(std::string(interface_info().name) +
                       " owes as many answers as it may; the call was not executed");
    }
    queue_.push(std::move(invocation));
    ++accepted_;
  }
  // Unlocked: on one processor the thread that it wakes runs at once, and needs the lock. The
  // executor ends after close(), which leaves nothing in the queue.
  executor_.post_or_run([self = shared_from_this()] { self->execute_next(); });
}

void Service::execute_next() {
  const auto next = take_next();
  if (!next) return;
  execute(next);
  note_done();
}

void Service::execute(const std::shared_ptr<Invocation>& invocation) {
  const CallerTurns::Turn turn(caller_turns_.get(), invocation->deadline);
  execute_in_turn(invocation, turn.came(), clock_.now());
}

void Service::call_here(const OperationInfo& operation, const void* in, void* out,
                        Invocation& frame) {
  OperationMeter& meter = meter_.of(operation);
  OperationMeter::count(meter.received);
  note_begin(operation, frame);
  try {
    begin_here(meter, frame);
    const Instant arrived = frame.begun;
    const CallerTurns::Turn turn(caller_turns_.get(), frame.deadline);
    if (turn.waited()) {
      frame.begun = clock_.now();
      meter.waited.record(frame.begun - arrived);
    }
    if (!turn.came()) refuse_turn(meter, operation);
    dispatch(operation, in, out, frame);
    refuse_too_late(operation, frame);
  } catch (...) {
    note_end(operation, frame, std::current_exception());
    throw;
  }
  note_end(operation, frame, nullptr);
}

void Service::begin_here(OperationMeter& meter, const Invocation& frame) const {
  try {
    refuse_self_wait(frame);
  } catch (const Error&) {
    OperationMeter::count(meter.refused);
    throw;
  }
}

void Service::refuse_turn(OperationMeter& meter, const OperationInfo& operation) const {
  if (closed_) {
    OperationMeter::count(meter.refused);
    throw being_withdrawn();
  }
  OperationMeter::count(meter.expired);
  throw TimedOut("the deadline passed while other calls of " + std::string(interface_info().name) +
                 " ran; " + quoted(operation) + " was not executed");
}

}  // namespace skein::rpc
