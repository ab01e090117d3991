#include "callback_gate.hpp"

#include <utility>

namespace skein::c {

thread_local const CallbackGate::Frame* CallbackGate::innermost_ = nullptr;

CallbackGate::Frame::Frame(const CallbackGate& gate_)
    : gate(gate_), outer(std::exchange(innermost_, this)) {}

CallbackGate::Frame::~Frame() { innermost_ = outer; }

bool CallbackGate::is_inside() const noexcept {
  for (const Frame* frame = innermost_; frame; frame = frame->outer) {
    if (&frame->gate == this) return true;
  }
  return false;
}

bool CallbackGate::is_inside(std::uint64_t entity) noexcept {
  for (const Frame* frame = innermost_; frame; frame = frame->outer) {
    if (frame->gate.entity_ == entity) return true;
  }
  return false;
}

bool CallbackGate::enter() {
  std::lock_guard lock(mutex_);
  if (closed_) return false;
  ++running_;
  return true;
}

void CallbackGate::leave() {
  {
    std::lock_guard lock(mutex_);
    if (--running_ > 0 || !closed_) return;
  }
  if (on_close_) on_close_(user_);
}

void CallbackGate::close() {
  {
    std::lock_guard lock(mutex_);
    if (std::exchange(closed_, true) || running_ > 0) return;
  }
  if (on_close_) on_close_(user_);
}

}  // namespace skein::c
