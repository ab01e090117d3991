#include "rpc/service/service.hpp"

#include <algorithm>
#include <optional>

#include "core/clock_wait.hpp"
#include "core/log.hpp"
#include "rpc/service/reception.hpp"
#include "rpc/wire/common.hpp"
#include "servant_call.hpp"
#include "skein/detail/pending_reply.hpp"
#include "skein/error.hpp"
#include "skein/introspection.idl.hpp"

namespace skein::rpc {
namespace {

constexpr std::chrono::milliseconds kLong{1};

}  // namespace

void Invocation::on_cancel(Action action) {
  {
    std::lock_guard lock(action_mutex_);
    if (!cancelled) {
      action_ = std::move(action);
      return;
    }
  }
  if (action) action();
}

void Invocation::tell_cancelled() {
  Action action;
  {
    std::lock_guard lock(action_mutex_);
    action = std::move(action_);
  }
  if (action) action();
}

/// Notes that an invocation is inside the implementation; none enters a service that is closed.
class Service::Running {
 public:
  Running(Service& service, Invocation& invocation) : service_(service), invocation_(invocation) {
    std::lock_guard lock(service_.mutex_);
    admitted_ = !service_.closed_;
    if (!admitted_) return;
    next_ = service_.running_;
    if (next_) next_->before_ = this;
    service_.running_ = this;
  }
  ~Running() {
    if (!admitted_) return;
    std::lock_guard lock(service_.mutex_);
    (before_ ? before_->next_ : service_.running_) = next_;
    if (next_) next_->before_ = before_;
    if (*service_.leaving_ && !service_.running_) service_.less_to_do_.notify_all();
  }
  Running(const Running&) = delete;
  Running& operator=(const Running&) = delete;

  bool admitted() const noexcept { return admitted_; }
  const Running* next() const noexcept { return next_; }
  Invocation& invocation() const noexcept { return invocation_; }

 private:
  Service& service_;
  Invocation& invocation_;
  bool admitted_ = false;
  Running* before_ = nullptr;
  Running* next_ = nullptr;
};

/// A call that its implementation answers later. It outlives the service where the implementation
/// keeps it for longer, and refers to it weakly: the service has the implementation.
class Service::Deferred final : public PendingReply {
 public:
  Deferred(Service& service, const std::shared_ptr<Invocation>& invocation)
      : service_(service.weak_from_this()),
        name_(service.interface_info().name),
        keeps_(service.options_.keeps),
        invocation_(invocation),
        out_(invocation->operation->out->make(), invocation->operation->out->destroy),
        call_(service.clock_, invocation->deadline, invocation->caller,
              {nullptr, invocation->chain, Guid()}, invocation->session.get(),
              &invocation->cancelled),
        tap_(service.options_.recorder.get(), service.interface_info(), *invocation->operation,
             {invocation->connection, invocation->number}, invocation->in.get()) {}
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
    if (const auto service = service_.lock()) service->end(*this, std::move(error));
  }

  /// The service ends before the answer has come.
  void withdraw(const std::exception_ptr& why) {
    Ending none = Ending::None;
    if (!ending_.compare_exchange_strong(none, Ending::Withdrawn)) return;
    invocation_->cancel();
    finish(why);
  }

  Invocation& invocation() const noexcept { return *invocation_; }
  const OperationInfo& operation() const noexcept { return *invocation_->operation; }
  CallRecorder::Tap& tap() noexcept { return tap_; }

 private:
  enum class Ending { None, Answered, Withdrawn };

  const std::weak_ptr<Service> service_;
  const std::string_view name_;
  const std::shared_ptr<const void> keeps_;  // the clock of call_
  const std::shared_ptr<Invocation> invocation_;
  const std::unique_ptr<void, void (*)(void*)> out_;
  const CallContext call_;
  CallRecorder::Tap tap_;
  std::atomic<Ending> ending_{Ending::None};
};

Service::Service(std::shared_ptr<Servant> servant, Executor& executor, Clock& clock,
                 Options options)
    : servant_(std::move(servant)),
      executor_(executor),
      clock_(clock),
      options_(std::move(options)),
      meter_(servant_->interface_info()),
      queue_(options_.queue),
      caller_turns_(options_.thread == CallThread::Caller ? std::make_unique<CallerTurns>(clock)
                                                          : nullptr) {
  if (options_.strand.is_nil()) options_.strand = options_.id;
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

std::shared_ptr<Session> Service::open(const OpenRequest& request) const {
  std::lock_guard lock(owner_mutex_);
  if (*leaving_) throw being_withdrawn();
  return options_.open ? options_.open(request) : nullptr;
}

void Service::note_begin(const OperationInfo& operation, const Invocation& frame) {
  if (!options_.journal) return;
  options_.journal->note(introspection::CallStep::Received, frame.connection, frame.number,
                         interface_info().name, operation);
}

void Service::note_end(const OperationInfo& operation, const Invocation& frame,
                       const std::exception_ptr& error) {
  if (!options_.journal) return;
  options_.journal->note_end(true, frame.connection, frame.number, interface_info().name, operation,
                             error);
}

void Service::answer(Invocation& invocation, const void* out, std::exception_ptr error) {
  note_end(*invocation.operation, invocation, error);
  invocation.respond(out, std::move(error));
}

void Service::note_done() {
  --accepted_;
  if (!*leaving_) return;
  std::lock_guard lock(mutex_);
  less_to_do_.notify_all();
}

bool Service::others_wait() const {
  std::lock_guard lock(queue_mutex_);
  return queue_.size() > 0 || (caller_turns_ && caller_turns_->awaited() > 0);
}

void Service::leave() { *leaving_ = true; }

// Between the look and the end no invocation slips in, neither by the queue nor on its caller's
// thread.
bool Service::finish(Instant deadline) {
  for (;;) {
    {
      std::unique_lock lock(mutex_);
      if (!wait_until(clock_, deadline, lock, less_to_do_, [&] { return is_idle(); })) return false;
    }
    std::scoped_lock lock(mutex_, queue_mutex_);
    if (!is_idle()) continue;
    closed_ = true;
    return true;
  }
}

void Service::refuse_self_wait(const Invocation& invocation) const {
  const auto& named = invocation.chain;
  const auto blocked =
      static_cast<std::size_t>(std::count(named.begin(), named.end(), options_.strand)) +
      (invocation.outer ? invocation.outer->waits(options_.strand) : 0);
  if (blocked < std::max<std::size_t>(options_.threads, 1)) return;
  throw Unavailable(
      "the call to " + std::string(interface_info().name) + " would wait for itself (" +
      circle(invocation.outer ? invocation.outer->chain() : named) +
      "): every thread that could answer it is blocked in a call that led to this one; "
      "make the inner call asynchronous or give the service more threads");
}

// What an implementation returns, or gives up, because it saw its deadline pass is no result.
void Service::refuse_too_late(const OperationInfo& operation, const Invocation& frame) const {
  if (frame.ended < frame.deadline) return;
  throw TimedOut(std::string(interface_info().name) + " finished " + quoted(operation) +
                 " too late");
}

// From where the chain first enters this service, back to it.
std::string Service::circle(const std::vector<Guid>& chain) const {
  std::string text;
  std::lock_guard lock(owner_mutex_);
  const auto first = std::find(chain.begin(), chain.end(), options_.strand);
  for (auto strand = first; strand != chain.end(); ++strand) {
    const bool ask = options_.name_of && !closed_;
    const std::string name = ask ? options_.name_of(*strand) : std::string();
    text += (name.empty() ? "service " + strand->hex() : name) + " -> ";
  }
  return text + "the first again";
}

NotSent Service::being_withdrawn() const {
  return NotSent(std::string(interface_info().name) + " is being withdrawn");
}

void Service::close() {
  std::vector<std::shared_ptr<PendingReply>> owed;
  {
    std::scoped_lock lock(owner_mutex_, mutex_);
    *leaving_ = closed_ = true;
    for (const Running* each = running_; each; each = each->next()) stop(each->invocation());
    for (Deferred* const each : deferred_) owed.push_back(each->weak_from_this().lock());
  }
  if (caller_turns_) caller_turns_->close();
  for (const auto& each : owed) {
    if (!each) continue;  // its last copy goes just now
    auto& deferred = static_cast<Deferred&>(*each);
    deferred.withdraw(std::make_exception_ptr(
        Disconnected(std::string(interface_info().name) + " was withdrawn; whether " +
                     quoted(deferred.operation()) + " ran is unknown")));
  }
  while (const auto waiting = take_next()) {
    withdraw(*waiting);
    --accepted_;
  }
}

bool Service::await_end(std::chrono::steady_clock::time_point deadline) const {
  std::unique_lock lock(mutex_);
  return less_to_do_.wait_until(lock, deadline, [&] { return running_ == nullptr; });
}

// Under the queue's lock an invocation is queued or refused: none comes after those that close()
// took.
std::shared_ptr<Invocation> Service::take_next() {
  std::lock_guard lock(queue_mutex_);
  return queue_.pop();
}

void Service::withdraw(Invocation& invocation) {
  OperationMeter::count(meter_.of(*invocation.operation).refused);
  answer(invocation, nullptr, std::make_exception_ptr(being_withdrawn()));
}

void Service::stop(Invocation& invocation) const {
  invocation.stop(ErrorCode::Disconnected, std::string(interface_info().name) + " was withdrawn");
}

bool Service::is_deferred(const OperationInfo& operation) const noexcept {
  return servant_->answers_later() && !operation.stream && !operation.oneway;
}

void Service::execute_in_turn(const std::shared_ptr<Invocation>& invocation, bool turn_came,
                              Instant now) {
  OperationMeter& meter = meter_.of(*invocation->operation);
  invocation->begun = now;
  meter.waited.record(now - invocation->arrived);
  if (closed_) return withdraw(*invocation);
  if (!turn_came || invocation->cancelled || now >= invocation->deadline) {
    OperationMeter::count(meter.expired);
    answer(*invocation, nullptr,
           std::make_exception_ptr(TimedOut("the deadline passed before " +
                                            std::string(interface_info().name) +
                                            " could begin; not executed")));
    return;
  }
  if (is_deferred(*invocation->operation)) return execute_deferred(invocation);
  execute_now(*invocation);
}

void Service::execute_now(Invocation& invocation) {
  const TypeSupport& type = *invocation.operation->out;
  OutgoingStream* const stream = invocation.stream.get();
  if (stream) stream->set_others_wait([this] { return others_wait(); });
  const std::unique_ptr<void, void (*)(void*)> out(stream ? nullptr : type.make(), type.destroy);
  const void* result = out.get();
  std::exception_ptr error;
  try {
    void* const target = stream ? static_cast<StreamWriter*>(stream) : out.get();
    dispatch(*invocation.operation, invocation.in.get(), target, invocation);
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

void Service::dispatch(const OperationInfo& operation, const void* in, void* out,
                       Invocation& frame) {
  enter(operation, frame, [&] {
    CallRecorder::Tap tap(options_.recorder.get(), interface_info(), operation,
                          {frame.connection, frame.number}, in);
    account(operation, out, frame, tap,
            [&] { call_servant(*servant_, operation, in, tap.passing(out)); });
  });
}

// Runs `action`, which is inside the implementation; refuses where the service is closed.
template <class Action>
void Service::enter(const OperationInfo& operation, Invocation& frame, Action action) {
  const CallContext context(clock_, frame.deadline, frame.caller,
                            {frame.outer, frame.chain, options_.strand}, frame.session.get(),
                            &frame.cancelled);
  const CallContextScope scope(context);
  const Running running(*this, frame);
  if (!running.admitted()) {
    OperationMeter::count(meter_.of(operation).refused);
    throw being_withdrawn();
  }
  action();
}

// Runs `action`, which ends the call: meters and recorder hear how.
template <class Action>
void Service::account(const OperationInfo& operation, const void* out, Invocation& frame,
                      CallRecorder::Tap& tap, Action action) {
  OperationMeter& meter = meter_.of(operation);
  OperationMeter::Counter* outcome = &meter.answered;
  const auto end = [&] {
    frame.ended = clock_.now();
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

// The implementation may answer before it returns, and what it does then is nobody's concern.
void Service::execute_deferred(const std::shared_ptr<Invocation>& invocation) {
  try {
    enter(*invocation->operation, *invocation, [&] {
      const auto deferred = make_shared_in_call_memory<Deferred>(*this, invocation);
      if (!owe(*deferred, invocation->connection))
        return deferred->withdraw(std::make_exception_ptr(being_withdrawn()));
      try {
        call_servant(*servant_, *invocation->operation, invocation->in.get(),
                     static_cast<PendingReply*>(deferred.get()));
      } catch (...) {
        if (deferred->claim()) deferred->finish(std::current_exception());
      }
    });
  } catch (const Unavailable&) {
    answer(*invocation, nullptr, std::current_exception());
  }
}

// By the rule of FairQueue: a peer may be owed no more than there is room left.
bool Service::may_owe(const Guid& connection) const {
  std::lock_guard lock(mutex_);
  const auto of_peer = owed_.find(connection.participant());
  return (of_peer == owed_.end() ? 0 : of_peer->second) <
         options_.queue - std::min(options_.queue, deferred_.size());
}

// False once the service is closed: close() would not find it.
bool Service::owe(Deferred& deferred, const Guid& connection) {
  std::lock_guard lock(mutex_);
  if (closed_) return false;
  deferred_.insert(&deferred);
  ++owed_[connection.participant()];
  return true;
}

void Service::settle(Deferred& deferred, const Guid& connection) {
  std::lock_guard lock(mutex_);
  if (deferred_.erase(&deferred) == 0) return;
  const auto of_peer = owed_.find(connection.participant());
  if (--of_peer->second == 0) owed_.erase(of_peer);
}

void Service::end(Deferred& deferred, std::exception_ptr error) {
  Invocation& invocation = deferred.invocation();
  const OperationInfo& operation = *invocation.operation;
  invocation.on_cancel(nullptr);
  ++accepted_;  // until the answer has left
  settle(deferred, invocation.connection);
  const void* result = deferred.out();
  try {
    account(operation, result, invocation, deferred.tap(), [&] {
      if (error) throw_for_caller(operation, error);
    });
    refuse_too_late(operation, invocation);
  } catch (...) {
    error = std::current_exception();
    result = nullptr;
  }
  answer(invocation, result, std::move(error));
  note_done();
}

introspection::ServiceStatistics Service::statistics() const {
  introspection::ServiceStatistics statistics;
  statistics.provider = id().bytes;
  statistics.service = interface_info().name;
  statistics.operations = meter_.read();
  {
    std::lock_guard lock(queue_mutex_);
    statistics.waiting = static_cast<std::uint32_t>(queue_.size());
  }
  std::lock_guard lock(mutex_);
  statistics.running = static_cast<std::uint32_t>(deferred_.size());
  for (const Running* each = running_; each; each = each->next()) {
    if (!is_deferred(*each->invocation().operation)) ++statistics.running;
  }
  return statistics;
}

std::size_t Service::count_overdue() const {
  std::lock_guard lock(mutex_);
  if (!running_) return 0;
  const Instant now = clock_.now();
  std::size_t count = 0;
  for (const Running* each = running_; each; each = each->next()) {
    if (each->invocation().deadline <= now) ++count;
  }
  return count;
}

bool Service::overdue() const { return count_overdue() > 0; }

bool Service::is_stuck() const { return count_overdue() >= options_.threads; }

}  // namespace skein::rpc
