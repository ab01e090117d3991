#include "provider_changes.hpp"

#include <utility>

#include "core/clock_wait.hpp"
#include "waiting_call.hpp"

namespace skein::connector {

void ProviderChanges::follow(std::shared_ptr<void> source) {
  std::lock_guard lock(mutex_);
  if (!closed_) source_.swap(source);
}

void ProviderChanges::on_change() {
  WeakList<WaitingCall>::List waiting;
  {
    std::lock_guard lock(mutex_);
    ++count_;
    waiting = waiting_.take_all();
    changed_.notify_all();
  }
  wake(std::move(waiting));
}

std::uint64_t ProviderChanges::count() const {
  std::lock_guard lock(mutex_);
  return count_;
}

bool ProviderChanges::await(std::uint64_t seen, Instant deadline) {
  std::unique_lock lock(mutex_);
  return wait_until(clock_, deadline, lock, changed_, [&] { return closed_ || count_ != seen; }) &&
         !closed_;
}

bool ProviderChanges::tell(std::uint64_t seen, std::weak_ptr<WaitingCall> call) {
  {
    std::lock_guard lock(mutex_);
    if (closed_) return false;
    if (count_ == seen) {
      waiting_.push(std::move(call));
      return true;
    }
  }
  wake({std::move(call)});
  return true;
}

void ProviderChanges::close() {
  std::shared_ptr<void> source;  // destroyed outside the lock, which its last report may wait for
  WeakList<WaitingCall>::List waiting;
  {
    std::lock_guard lock(mutex_);
    closed_ = true;
    source.swap(source_);
    waiting = waiting_.take_all();
    changed_.notify_all();
  }
  wake(std::move(waiting));
}

// They were admitted when they began.
void ProviderChanges::wake(WeakList<WaitingCall>::List calls) {
  for (std::weak_ptr<WaitingCall>& call : calls) {
    continuations_.post_or_run([weak = std::move(call)] {
      if (const auto waiting = weak.lock()) waiting->look();
    });
  }
}

}  // namespace skein::connector
