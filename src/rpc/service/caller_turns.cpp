#include "caller_turns.hpp"

#include "core/clock_wait.hpp"

namespace skein::rpc {

void CallerTurns::close() {
  {
    std::lock_guard lock(mutex_);
    closed_ = true;
  }
  ended_.notify_all();
}

CallerTurns::Turn::Turn(CallerTurns* turns, Instant deadline) : turns_(turns) {
  if (!turns_) return;
  std::unique_lock lock(turns_->mutex_);
  waited_ = turns_->taken_;
  if (waited_) ++turns_->awaited_;
  came_ = wait_until(turns_->clock_, deadline, lock, turns_->ended_,
                     [&] { return !turns_->taken_ || turns_->closed_; }) &&
          !turns_->closed_;
  if (waited_) --turns_->awaited_;
  if (came_) turns_->taken_ = true;
}

CallerTurns::Turn::~Turn() {
  if (!turns_ || !came_) return;
  {
    std::lock_guard lock(turns_->mutex_);
    turns_->taken_ = false;
  }
  turns_->ended_.notify_one();
}

}  // namespace skein::rpc
