#include "rpc/service/unfinished_calls.hpp"

#include "core/clock_wait.hpp"
#include "rpc/service/owed_answers.hpp"

namespace skein::rpc {

// close() closes before it takes the lock: it finds each invocation that is admitted here.
UnfinishedCalls::Running::Running(UnfinishedCalls& calls, Invocation& invocation)
    : calls_(calls), invocation_(invocation) {
  std::lock_guard lock(calls_.mutex_);
  admitted_ = !calls_.closed();
  if (!admitted_) return;
  next_ = calls_.running_;
  if (next_) next_->before_ = this;
  calls_.running_ = this;
}

UnfinishedCalls::Running::~Running() {
  if (!admitted_) return;
  std::lock_guard lock(calls_.mutex_);
  (before_ ? before_->next_ : calls_.running_) = next_;
  if (next_) next_->before_ = before_;
  if (*calls_.leaving_ && !calls_.running_) calls_.less_to_do_.notify_all();
}

void UnfinishedCalls::note_done() {
  --accepted_;
  if (!*leaving_) return;
  std::lock_guard lock(mutex_);
  less_to_do_.notify_all();
}

// Under the lock none enters the implementation, so none is owed an answer that was not before. An
// answer on its way is accepted before it ceases to be owed.
bool UnfinishedCalls::finish(Clock& clock, Instant deadline, const OwedAnswers& owed) {
  bool finished = false;
  std::unique_lock lock(mutex_);
  return wait_until(clock, deadline, lock, less_to_do_, [&] {
    if (finished || running_ || owed.size() > 0) return finished;
    std::size_t none = 0;
    finished = accepted_.compare_exchange_strong(none, kClosed) || none == kClosed;
    return finished;
  });
}

void UnfinishedCalls::close(const std::string& why) {
  accepted_ |= kClosed;
  std::lock_guard lock(mutex_);
  for (const Running* each = running_; each; each = each->next_) {
    each->invocation_.stop(ErrorCode::Disconnected, why);
  }
}

bool UnfinishedCalls::await_end(std::chrono::steady_clock::time_point deadline) const {
  std::unique_lock lock(mutex_);
  return less_to_do_.wait_until(lock, deadline, [&] { return running_ == nullptr; });
}

}  // namespace skein::rpc
