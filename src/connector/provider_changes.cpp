#include "provider_changes.hpp"

#include <algorithm>
#include <utility>

#include "core/clock_wait.hpp"
#include "waiting_call.hpp"

namespace skein::connector {

void ProviderChanges::follow(std::shared_ptr<void> source) {
  std::lock_guard lock(mutex_);
  if (!closed_) source_.swap(source);
}

void ProviderChanges::on_change() {
  std::vector<std::weak_ptr<WaitingCall>> waiting;
  {
    std::lock_guard lock(mutex_);
    ++count_;
    waiting.swap(waiting_);
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
      if (waiting_.size() >= look_at_) {
        std::erase_if(waiting_, [](const auto& weak) { return weak.expired(); });
        look_at_ = std::max<std::size_t>(16, 2 * waiting_.size());
      }
      waiting_.push_back(std::move(call));
      return true;
    }
  }
  wake({std::move(call)});
  return true;
}

void ProviderChanges::close() {
  std::shared_ptr<void> source;  // destroyed outside the lock, which its last report may wait for
  std::vector<std::weak_ptr<WaitingCall>> waiting;
  {
    std::lock_guard lock(mutex_);
    closed_ = true;
    source.swap(source_);
    waiting.swap(waiting_);
    changed_.notify_all();
  }
  wake(std::move(waiting));
}

// They were admitted when they began.
void ProviderChanges::wake(std::vector<std::weak_ptr<WaitingCall>> calls) {
  for (std::weak_ptr<WaitingCall>& call : calls) {
    continuations_.post_or_run([weak = std::move(call)] {
      if (const auto waiting = weak.lock()) waiting->look();
    });
  }
}

}  // namespace skein::connector
