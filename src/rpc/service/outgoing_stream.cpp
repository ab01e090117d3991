#include "rpc/service/outgoing_stream.hpp"

#include <algorithm>
#include <utility>

#include "core/clock_wait.hpp"

namespace skein::rpc {
namespace {

// No caller has room for more, whatever it claims.
constexpr std::uint32_t kMaxCredit = PendingStream::kWindow;
// Once the caller's time is over, how soon it is looked again whether other calls wait.
constexpr std::chrono::milliseconds kLookAgain{250};

}  // namespace

OutgoingStream::OutgoingStream(const OperationInfo& operation, Clock& clock, Instant deadline,
                               std::uint32_t credit, Send send)
    : operation_(operation),
      clock_(clock),
      deadline_(deadline),
      send_(std::move(send)),
      last_only_(credit == 0),
      last_(nullptr, operation.out->destroy),
      credit_(std::min(credit, kMaxCredit)) {}

bool OutgoingStream::put(const void* out, bool wait) {
  {
    std::unique_lock lock(mutex_);
    if (wait && !last_only_ && credit_ == 0) await_credit(lock);
    refuse_if_over();
    if (last_only_) {
      if (!last_) last_.reset(operation_.out->make());
      operation_.out->assign(last_.get(), out);
      return true;
    }
    if (credit_ == 0) return false;
    --credit_;
  }
  try {
    send_(out, sent_);
  } catch (...) {
    grant(1);
    throw;
  }
  ++sent_;
  return true;
}

void OutgoingStream::set_others_wait(std::function<bool()> others_wait) {
  others_wait_ = std::move(others_wait);
}

void OutgoingStream::await_credit(std::unique_lock<std::mutex>& lock) {
  const Instant begun = clock_.now();
  Instant look = begun + kPatience;
  while (!wait_until(clock_, std::min(look, deadline_), lock, changed_,
                     [&] { return credit_ > 0 || stopped_; })) {
    const Instant now = clock_.now();
    if (now >= deadline_) return;
    if (others_wait_ && others_wait_()) {
      stopped_ = true;
      code_ = ErrorCode::Overloaded;
      why_ = "its caller took no result for " +
             std::to_string(std::chrono::duration_cast<std::chrono::seconds>(now - begun).count()) +
             " s while other calls waited for the service's thread; take the results faster, or "
             "begin the stream again";
      return;
    }
    look = now + kLookAgain;
  }
}

void OutgoingStream::refuse_if_over() const {
  const std::string name(operation_.name);
  if (stopped_) throw_error(code_, "the stream of " + name + " was stopped: " + why_);
  if (clock_.now() >= deadline_) {
    throw TimedOut("the deadline passed before the stream of " + name + " came to its end");
  }
}

void OutgoingStream::grant(std::uint32_t credit) {
  std::lock_guard lock(mutex_);
  credit_ += std::min(credit, kMaxCredit - credit_);
  changed_.notify_all();
}

void OutgoingStream::stop(ErrorCode code, const std::string& why) {
  std::lock_guard lock(mutex_);
  if (std::exchange(stopped_, true)) return;
  code_ = code;
  why_ = why;
  changed_.notify_all();
}

const void* OutgoingStream::finish() const {
  if (last_only_ && !last_) {
    throw Internal("the stream of " + std::string(operation_.name) +
                   " ended without a result, and the caller, which knows no streams, needs one");
  }
  return last_.get();
}

}  // namespace skein::rpc
