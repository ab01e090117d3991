#include "launch/child_state.hpp"

#include <algorithm>

namespace skein::launch {

using profile::RestartPolicy;

std::string_view to_string(ChildState state) noexcept {
  switch (state) {
    case ChildState::Idle:
      return "idle";
    case ChildState::Starting:
      return "starting";
    case ChildState::Ready:
      return "ready";
    case ChildState::Terminated:
      return "terminated";
    case ChildState::Killed:
      return "killed";
    case ChildState::Waiting:
      return "waiting";
    case ChildState::Ended:
      return "ended";
    case ChildState::Lost:
      return "lost";
  }
  return "unknown";
}

bool ChildStateMachine::is_final() const noexcept {
  return state_ == ChildState::Ended || state_ == ChildState::Lost;
}

bool ChildStateMachine::is_running() const noexcept {
  return state_ == ChildState::Starting || state_ == ChildState::Ready ||
         state_ == ChildState::Terminated || state_ == ChildState::Killed;
}

ChildAction ChildStateMachine::enter(ChildState state, std::optional<Time> due,
                                     ChildAction action) {
  state_ = state;
  due_ = due;
  return action;
}

ChildAction ChildStateMachine::begin(Time now) {
  return enter(ChildState::Starting, now + rules_.ready_timeout, ChildAction::Spawn);
}

ChildAction ChildStateMachine::start(Time now) {
  return state_ == ChildState::Idle ? begin(now) : ChildAction::None;
}

ChildAction ChildStateMachine::spawn_failed(Time) {
  if (!is_running()) return ChildAction::None;
  return enter(stopping_ ? ChildState::Ended : ChildState::Lost, std::nullopt, ChildAction::None);
}

ChildAction ChildStateMachine::ready(Time) {
  if (state_ != ChildState::Starting) return ChildAction::None;
  was_ready_ = true;
  return enter(ChildState::Ready, std::nullopt, ChildAction::None);
}

ChildAction ChildStateMachine::exited(bool failed, Time now) {
  if (!is_running()) return ChildAction::None;
  if (stopping_) return enter(ChildState::Ended, std::nullopt, ChildAction::None);
  // Killed without stop(): it did not become ready in time.
  return restart_or_give_up(failed || state_ == ChildState::Killed, now);
}

ChildAction ChildStateMachine::restart_or_give_up(bool failed, Time now) {
  const auto& restart = rules_.restart;
  const bool again = restart.policy == RestartPolicy::Always ||
                     (restart.policy == RestartPolicy::OnFailure && failed);
  if (!again) {
    return enter(failed ? ChildState::Lost : ChildState::Ended, std::nullopt, ChildAction::None);
  }
  while (!recent_restarts_.empty() && now - recent_restarts_.front() >= restart.window) {
    recent_restarts_.pop_front();
  }
  if (recent_restarts_.size() >= static_cast<std::size_t>(std::max(restart.max_restarts, 0))) {
    return enter(ChildState::Lost, std::nullopt, ChildAction::None);
  }
  auto delay = std::min(restart.delay, restart.max_delay);
  for (std::size_t i = 0; i < recent_restarts_.size() && delay < restart.max_delay; ++i) {
    delay = std::min(2 * delay, restart.max_delay);
  }
  recent_restarts_.push_back(now);
  return enter(ChildState::Waiting, now + delay, ChildAction::None);
}

ChildAction ChildStateMachine::stop(Time now) {
  const bool again = stopping_;
  stopping_ = true;
  switch (state_) {
    case ChildState::Idle:
    case ChildState::Waiting:
      return enter(ChildState::Ended, std::nullopt, ChildAction::None);
    case ChildState::Starting:
    case ChildState::Ready:
      return enter(ChildState::Terminated, now + rules_.stop_timeout, ChildAction::Terminate);
    case ChildState::Terminated:
      if (again) return enter(ChildState::Killed, std::nullopt, ChildAction::Kill);
      break;
    case ChildState::Killed:
    case ChildState::Ended:
    case ChildState::Lost:
      break;
  }
  return ChildAction::None;
}

ChildAction ChildStateMachine::tick(Time now) {
  if (!due_ || now < *due_) return ChildAction::None;
  if (state_ == ChildState::Waiting) {
    ++restarts_;
    return begin(now);
  }
  return enter(ChildState::Killed, std::nullopt, ChildAction::Kill);
}

}  // namespace skein::launch
