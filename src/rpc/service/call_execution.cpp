#include "rpc/service/call_execution.hpp"

#include <chrono>
#include <string>
#include <utility>

#include "core/log.hpp"
#include "rpc/service/service.hpp"
#include "rpc/service/service_owner.hpp"
#include "rpc/wire/common.hpp"
#include "servant_call.hpp"
#include "skein/detail/call_memory.hpp"
#include "skein/detail/pending_reply.hpp"
#include "skein/error.hpp"

namespace skein::rpc {
namespace {

constexpr std::chrono::milliseconds kLong{1};

}  // namespace

/// A call that its implementation answers later. It outlives the service if the implementation
/// keeps it for longer, and refers to it weakly: the service has the implementation.
class CallExecution::Deferred final : public PendingReply {
 public:
  Deferred(CallExecution& execution, const std::shared_ptr<Invocation>& invocation)
      : service_(execution.parts_.service.weak_from_this()),
        execution_(execution),
        name_(execution.parts_.accounts.interface.name),
        keeps_(execution.parts_.keeps),
        invocation_(invocation),
        out_(invocation->operation->out->make(), invocation->operation->out->destroy),
        call_(execution.parts_.clock, invocation->deadline, invocation->caller,
              {nullptr, invocation->chain, Guid()}, invocation->session.get(),
              &invocation->cancelled),
        tap_(execution.parts_.accounts.tap(*invocation->operation, *invocation,
                                           invocation->in.get())) {}
  ~Deferred() override {
    if (ending_ != Ending::None) return;
    finish(std::make_exception_ptr(
        Internal(quoted(operation()) + " was not answered: its implementation dropped the Reply")));
  }

  void* out() noexcept override { return out_.get(); }
  const CallContext& call() const noexcept override { return call_; }
  void on_cancel(Action action) override {
    if (ending_ == Ending::None) invocation_->on_cancel(std::move(action));
  }

  bool claim() override {
    Ending before = Ending::None;
    if (ending_.compare_exchange_strong(before, Ending::Answered)) return true;
    log(LogLevel::Warning, std::string(name_),
        "an answer to " + quoted(operation()) + " goes nowhere: " +
            (before == Ending::Answered ? "it was answered before" : "its service was withdrawn"));
    return false;
  }

  void finish(std::exception_ptr error) override {
    if (const auto service = service_.lock()) execution_.end(*this, std::move(error));
  }

  /// The service ends before the answer has come.
  void withdraw(const std::exception_ptr& why) {
    Ending none = Ending::None;
    if (!ending_.compare_exchange_strong(none, Ending::Withdrawn)) return;
    invocation_->cancel();
    finish(why);
  }

  bool withdrawn() const noexcept { return ending_ == Ending::Withdrawn; }
  Invocation& invocation() const noexcept { return *invocation_; }
  const OperationInfo& operation() const noexcept { return *invocation_->operation; }
  CallRecorder::Tap& tap() noexcept { return tap_; }

 private:
  enum class Ending { None, Answered, Withdrawn };

  const std::weak_ptr<Service> service_;
  CallExecution& execution_;  // the service's
  const std::string_view name_;
  const std::shared_ptr<const void> keeps_;  // the clock of call_
  const std::shared_ptr<Invocation> invocation_;
  const std::unique_ptr<void, void (*)(void*)> out_;
  const CallContext call_;
  CallRecorder::Tap tap_;
  std::atomic<Ending> ending_{Ending::None};
};

bool CallExecution::answers_later(const OperationInfo& operation) const noexcept {
  return parts_.servant.answers_later() && !operation.stream && !operation.oneway;
}

void CallExecution::run(const std::shared_ptr<Invocation>& invocation, bool turn_came,
                        Instant now) {
  OperationMeter& meter = parts_.accounts.meter.of(*invocation->operation);
  invocation->begun = now;
  meter.waited.record(now - invocation->arrived);
  if (parts_.calls.closed()) return withdraw(*invocation);
  if (!turn_came || invocation->cancelled || now >= invocation->deadline) {
    OperationMeter::count(meter.expired);
    answer(*invocation, nullptr,
           std::make_exception_ptr(TimedOut("the deadline passed before " +
                                            std::string(parts_.accounts.interface.name) +
                                            " could begin; not executed")));
    return;
  }
  if (answers_later(*invocation->operation)) return run_deferred(invocation);
  run_now(*invocation);
}

void CallExecution::run_now(Invocation& invocation) {
  const TypeSupport& type = *invocation.operation->out;
  OutgoingStream* const stream = invocation.stream.get();
  if (stream) stream->set_others_wait(parts_.others_wait);
  const std::unique_ptr<void, void (*)(void*)> out(stream ? nullptr : type.make(), type.destroy);
  const void* result = out.get();
  std::exception_ptr error;
  try {
    void* const target = stream ? static_cast<StreamWriter*>(stream) : out.get();
    call(*invocation.operation, invocation.in.get(), target, invocation);
    if (stream) result = stream->finish();
    refuse_too_late(*invocation.operation, invocation);
  } catch (...) {
    error = std::current_exception();
    result = nullptr;
  }
  if (!stream) {
    const bool was_long = invocation.ended - invocation.begun > kLong;
    if (was_long != latest_was_long_) latest_was_long_ = was_long;
  }
  answer(invocation, result, std::move(error));
}

void CallExecution::withdraw(Invocation& invocation) {
  OperationMeter::count(parts_.accounts.meter.of(*invocation.operation).refused);
  answer(invocation, nullptr,
         std::make_exception_ptr(being_withdrawn(parts_.accounts.interface.name)));
}

void CallExecution::withdraw_owed() {
  for (const auto& each : parts_.owed.close()) {
    auto& deferred = static_cast<Deferred&>(*each);
    deferred.withdraw(std::make_exception_ptr(
        Disconnected(std::string(parts_.accounts.interface.name) + " was withdrawn; whether " +
                     quoted(deferred.operation()) + " ran is unknown")));
  }
}

void CallExecution::answer(Invocation& invocation, const void* out, std::exception_ptr error) {
  parts_.accounts.ended(*invocation.operation, invocation, error);
  invocation.respond(out, std::move(error));
}

void CallExecution::refuse_too_late(const OperationInfo& operation, const Invocation& frame) const {
  if (frame.ended < frame.deadline) return;
  throw TimedOut(std::string(parts_.accounts.interface.name) + " finished " + quoted(operation) +
                 " too late");
}

void CallExecution::call(const OperationInfo& operation, const void* in, void* out,
                         Invocation& frame) {
  enter(operation, frame, [&] {
    CallRecorder::Tap tap = parts_.accounts.tap(operation, frame, in);
    account(operation, out, frame, tap,
            [&] { call_servant(parts_.servant, operation, in, tap.passing(out)); });
  });
}

// Runs `action`, which is inside the implementation; refuses if the service is closed.
template <class Action>
void CallExecution::enter(const OperationInfo& operation, Invocation& frame, Action action) {
  const CallContext context(parts_.clock, frame.deadline, frame.caller,
                            {frame.outer, frame.chain, parts_.strand}, frame.session.get(),
                            &frame.cancelled);
  const CallContextScope scope(context);
  const UnfinishedCalls::Running running(parts_.calls, frame);
  if (!running.admitted()) {
    OperationMeter::count(parts_.accounts.meter.of(operation).refused);
    throw being_withdrawn(parts_.accounts.interface.name);
  }
  action();
}

// Runs `action`, which ends the call: meters and recorder hear how.
template <class Action>
void CallExecution::account(const OperationInfo& operation, const void* out, Invocation& frame,
                            CallRecorder::Tap& tap, Action action) {
  OperationMeter& meter = parts_.accounts.meter.of(operation);
  OperationMeter::Counter* outcome = &meter.answered;
  const auto end = [&] {
    frame.ended = parts_.clock.now();
    meter.ran.record(frame.ended - frame.begun);
    OperationMeter::count(*outcome);
  };
  try {
    action();
  } catch (const Cancelled& error) {
    outcome = &meter.failed;
    end();
    tap.failed(error);
    refuse_too_late(operation, frame);
    throw;
  } catch (const UserException& exception) {
    outcome = &meter.raised;
    end();
    tap.raised(exception);
    throw;
  } catch (const std::exception& error) {  // call_servant() throws nothing else
    outcome = &meter.failed;
    end();
    tap.failed(error);
    throw;
  }
  end();
  tap.returned(out);
}

// The implementation may answer before it returns; an exception after that is only logged.
void CallExecution::run_deferred(const std::shared_ptr<Invocation>& invocation) {
  try {
    enter(*invocation->operation, *invocation, [&] {
      const auto deferred = make_shared_in_call_memory<Deferred>(*this, invocation);
      // A call that close() has not found here was not begun, and may be made elsewhere.
      if (parts_.calls.closed() || !parts_.owed.add(*deferred, invocation->connection))
        return deferred->withdraw(
            std::make_exception_ptr(being_withdrawn(parts_.accounts.interface.name)));
      try {
        call_servant(parts_.servant, *invocation->operation, invocation->in.get(),
                     static_cast<PendingReply*>(deferred.get()));
      } catch (...) {
        if (deferred->claim()) deferred->finish(std::current_exception());
      }
    });
  } catch (const Unavailable&) {
    answer(*invocation, nullptr, std::current_exception());
  }
}

void CallExecution::end(Deferred& deferred, std::exception_ptr error) {
  Invocation& invocation = deferred.invocation();
  const OperationInfo& operation = *invocation.operation;
  invocation.on_cancel(nullptr);
  parts_.calls.accept();  // until the answer has left
  parts_.owed.remove(deferred, invocation.connection);
  const void* result = deferred.out();
  try {
    account(operation, result, invocation, deferred.tap(), [&] {
      if (error && deferred.withdrawn()) std::rethrow_exception(error);
      if (error) throw_for_caller(operation, error);
    });
    refuse_too_late(operation, invocation);
  } catch (...) {
    error = std::current_exception();
    result = nullptr;
  }
  answer(invocation, result, std::move(error));
  parts_.calls.note_done();
}

}  // namespace skein::rpc
