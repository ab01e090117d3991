#include "skein/detail/channel.hpp"

#include <chrono>
#include <string>
#include <thread>
#include <utility>

#include "core/log.hpp"
#include "skein/call.hpp"
#include "skein/detail/call_memory.hpp"
#include "skein/error.hpp"

namespace skein {

void report_thrown_by_continuation(const std::exception_ptr& thrown) noexcept {
  const auto tell = [](const std::string& what) {
    log(LogLevel::Error, "call", "a continuation of Call::then threw: " + what);
  };
  try {
    std::rethrow_exception(thrown);
  } catch (const std::exception& error) {
    tell(error.what());
  } catch (...) {
    tell("something that is no std::exception");
  }
}

void ProxyBase::throw_no_connection() {
  throw InvalidArgument(
      "this proxy is not connected: it was made without a connection, or moved from; assign what "
      "connect() returns");
}

void ProxyBase::set_timeout(Duration timeout) {
  if (timeout < Duration::zero()) {
    const auto ms = std::chrono::duration_cast<std::chrono::milliseconds>(timeout).count();
    throw InvalidArgument(
        "within() is given " + std::to_string(ms) +
        " ms; a call takes a time limit from 0 on, and ends as TimedOut after it");
  }
  timeout_ = timeout;
}

void PendingCall::finish(std::exception_ptr error) {
  Action action;
  // Both dropped outside the lock: they own parts of the transport.
  Action canceller;
  std::shared_ptr<Answers> answers;
  bool attended = false;
  bool taken_here = false;
  {
    std::lock_guard lock(mutex_);
    error_ = std::move(error);
    finished_ = true;
    action = std::move(action_);
    canceller = std::move(canceller_);
    answers = std::move(answers_);
    attended = attended_ && answers;
    taken_here = taken_here_ && answers;
  }
  changed_.notify_all();  // unlocked: on one processor it may run at once, and needs the lock
  if (attended) answers->leave();
  if (taken_here) answers->wake();
  if (answers) answers->end();
  if (action) action();
}

bool PendingCall::fail(std::exception_ptr error) {
  if (!claim()) return false;
  finish(std::move(error));
  return true;
}

bool PendingCall::finished() const {
  if (!finished_) attend();
  return finished_;
}

void PendingCall::set_answers(const std::shared_ptr<Answers>& answers) {
  std::shared_ptr<Answers> before;
  bool attended = false;
  {
    std::lock_guard lock(mutex_);
    if (finished_) return;
    before = std::exchange(answers_, answers);
    if (answers) answers->begin(blocking_);
    attended = attended_;
  }
  if (attended && answers) answers->attend();
  if (attended && before) before->leave();
  if (before) before->end();
}

// No thread takes the answer in wait(), and the call's end matters.
void PendingCall::attend() const {
  std::shared_ptr<Answers> answers;
  {
    std::lock_guard lock(mutex_);
    if (finished_ || std::exchange(attended_, true) || !answers_) return;
    answers = answers_;
  }
  answers->attend();
}

void PendingCall::wait() const {
  std::shared_ptr<Answers> answers;
  {
    std::lock_guard lock(mutex_);
    if (finished_) return;
    answers = answers_;
    taken_here_ = answers != nullptr;
  }
  if (answers) answers->take_until(finished_);
  if (finished_) return;
  attend();
  if (const auto spin = spin_.load(); spin.count() > 0) {
    const auto end = saturating_sum(std::chrono::steady_clock::now(), spin);
    while (!finished_.load(std::memory_order_acquire) && std::chrono::steady_clock::now() < end) {
      std::this_thread::yield();
    }
  }
  std::unique_lock lock(mutex_);
  changed_.wait(lock, [&] { return finished_.load(); });
}

std::exception_ptr PendingCall::take_error() {
  std::lock_guard lock(mutex_);
  return std::exchange(error_, nullptr);
}

void PendingCall::on_finished(Action action) {
  attend();
  {
    std::lock_guard lock(mutex_);
    if (!finished_) {
      action_ = std::move(action);
      return;
    }
  }
  action();
}

void PendingCall::set_canceller(Action canceller) {
  std::lock_guard lock(mutex_);
  if (!finished_) canceller_ = std::move(canceller);
}

void PendingCall::cancel() {
  abandon(std::make_exception_ptr(
      Cancelled("the call of " + std::string(operation_.name) + " was cancelled by its caller")));
}

void PendingCall::abandon(std::exception_ptr error) {
  Action canceller;
  {
    std::lock_guard lock(mutex_);
    canceller = std::move(canceller_);
  }
  if (fail(std::move(error)) && canceller) canceller();
}

void Channel::call(const OperationInfo& operation, const void* in, void* out,
                   const CallTime& time) {
  const auto pending = make_shared_in_call_memory<PendingCall>(operation, out, time.deadline, true);
  start_here(pending, in);
  pending->wait();
  if (auto error = pending->take_error()) std::rethrow_exception(std::move(error));
}

}  // namespace skein
