#include "skein/stream.hpp"

namespace skein {

PendingStream::PendingStream(const OperationInfo& operation, Instant deadline)
    : PendingCall(operation, nullptr, deadline, false) {
  on_finished([this] { end(); });
}

void PendingStream::set_granter(std::function<void(std::uint32_t)> granter) {
  std::lock_guard lock(items_mutex_);
  granter_ = std::move(granter);
}

bool PendingStream::deliver(Item item) {
  std::function<void()> waiter;
  {
    std::lock_guard lock(items_mutex_);
    if (ended_) return true;
    if (items_.size() >= kWindow) return false;
    items_.push_back(std::move(item));
    ++delivered_;
    waiter.swap(waiter_);
    arrived_.notify_one();
  }
  if (waiter) waiter();
  return true;
}

void PendingStream::end() {
  std::function<void()> waiter;
  {
    std::lock_guard lock(items_mutex_);
    ended_ = true;
    waiter.swap(waiter_);
    arrived_.notify_all();
  }
  if (waiter) waiter();
}

std::uint64_t PendingStream::delivered() const {
  std::lock_guard lock(items_mutex_);
  return delivered_;
}

bool PendingStream::ready() const {
  std::lock_guard lock(items_mutex_);
  return ended_ || !items_.empty();
}

PendingStream::Item PendingStream::next() {
  Item item{nullptr, operation().out->destroy};
  bool at_once = false;
  {
    std::unique_lock lock(items_mutex_);
    arrived_.wait(lock, [&] { return ended_ || !items_.empty(); });
    if (items_.size() == kWindow) at_once = is_slow();
    if (!items_.empty()) {
      item = std::move(items_.front());
      items_.pop_front();
      ++taken_;
    }
  }
  if (item) {
    grant_taken(at_once);
  } else if (auto error = take_error()) {
    std::rethrow_exception(std::move(error));
  }
  return item;
}

// Under the lock: whether the provider waits, and this reader takes so few results that the
// provider should hear of each.
bool PendingStream::is_slow() {
  constexpr std::chrono::milliseconds kSlow{100};
  const Instant now = std::chrono::steady_clock::now();
  return now - std::exchange(taken_at_, now) > kSlow;
}

// By halves of the window: one message of credit for several results, and no pause between them.
void PendingStream::grant_taken(bool at_once) {
  std::function<void(std::uint32_t)> granter;
  std::uint32_t count = 0;
  {
    std::lock_guard lock(items_mutex_);
    if (ended_ || (taken_ < kWindow / 2 && !at_once)) return;
    count = std::exchange(taken_, 0);
    granter = granter_;
  }
  attempt([&] { granter(count); });
}

void PendingStream::on_ready(std::function<void()> action) {
  {
    std::lock_guard lock(items_mutex_);
    if (!ended_ && items_.empty()) {
      waiter_ = std::move(action);
      return;
    }
  }
  action();
}

void PendingStream::drop() {
  cancel();
  std::deque<Item> dropped;  // destroyed outside the lock
  std::lock_guard lock(items_mutex_);
  dropped.swap(items_);
}

}  // namespace skein
