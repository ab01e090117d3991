#include "mission/supervise/child_state.hpp"

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
    case ChildState::Interrupted:
      return "interrupted";
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

std::chrono::nanoseconds time_to_terminate(std::chrono::nanoseconds stop_timeout) noexcept {
  return stop_timeout * 2 / 3;
}

bool ChildStateMachine::is_final() const noexcept {
  return state_ == ChildState::Ended || state_ == ChildState::Lost;
}

bool ChildStateMachine::is_running() const noexcept {
  switch (state_) {
    case ChildState::Starting:
    case ChildState::Ready:
    case ChildState::Interrupted:
    case ChildState::Terminated:
    case ChildState::Killed:
      return true;
    default:
      return false;
  }
}

ChildAction ChildStateMachine::enter(ChildState state, std::optional<Time> due,
                                     ChildAction action) {
  state_ = state;
  due_ = due;
  return action;
}

ChildAction ChildStateMachine::begin(Time now) {
  hang_ = Hang::None;
  is_sound_ = false;
  return enter(ChildState::Starting, now + rules_.ready_timeout, ChildAction::Spawn);
}

ChildAction ChildStateMachine::begin_anew(Time now) {
  restarting_ = false;
  recent_restarts_.clear();
  restarts_ = 0;
  return begin(now);
}

ChildAction ChildStateMachine::start(Time now) {
  return state_ == ChildState::Idle ? begin(now) : ChildAction::None;
}

ChildAction ChildStateMachine::spawn_failed(bool passing, Time now) {
  if (passing) return exited(true, now);
  if (!is_running()) return ChildAction::None;
  restarting_ = false;
  return enter(stopping_ ? ChildState::Ended : ChildState::Lost, std::nullopt, ChildAction::None);
}

ChildAction ChildStateMachine::ready(Time now) {
  if (state_ != ChildState::Starting) return ChildAction::None;
  is_sound_ = was_ready_ = true;
  enter(ChildState::Ready, std::nullopt, ChildAction::None);
  return progress(now);
}

ChildAction ChildStateMachine::progress(Time now) {
  if (state_ == ChildState::Ready && rules_.progress_timeout > rules_.progress_timeout.zero())
    due_ = now + rules_.progress_timeout;
  return ChildAction::None;
}

ChildAction ChildStateMachine::exited(bool failed, Time now, bool misconfigured) {
  if (!is_running()) return ChildAction::None;
  if (stopping_) return enter(ChildState::Ended, std::nullopt, ChildAction::None);
  if (restarting_) return begin_anew(now);
  return restart_or_give_up(failed || hang_ != Hang::None, !misconfigured, now);
}

ChildAction ChildStateMachine::restart_or_give_up(bool failed, bool may_help, Time now) {
  const auto& restart = rules_.restart;
  const bool again = may_help && (restart.policy == RestartPolicy::Always ||
                                  (restart.policy == RestartPolicy::OnFailure && failed));
  if (!again) {
    return enter(failed ? ChildState::Lost : ChildState::Ended, std::nullopt, ChildAction::None);
  }
  // A start that hangs may take as long as the window: it must not wash the others out of it.
  while (is_sound_ && !recent_restarts_.empty() &&
         now - recent_restarts_.front() >= restart.window) {
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

ChildAction ChildStateMachine::interrupt(Time now) {
  return enter(ChildState::Interrupted, now + time_to_terminate(rules_.stop_timeout),
               ChildAction::Interrupt);
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
      return interrupt(now);
    case ChildState::Interrupted:
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

ChildAction ChildStateMachine::restart(Time now) {
  if (stopping_) return ChildAction::None;
  switch (state_) {
    case ChildState::Idle:
      break;
    case ChildState::Starting:
    case ChildState::Ready:
      restarting_ = true;
      return interrupt(now);
    case ChildState::Interrupted:
    case ChildState::Terminated:
    case ChildState::Killed:
      restarting_ = true;
      break;
    case ChildState::Waiting:
    case ChildState::Ended:
    case ChildState::Lost:
      return begin_anew(now);
  }
  return ChildAction::None;
}

ChildAction ChildStateMachine::tick(Time now) {
  if (!due_ || now < *due_) return ChildAction::None;
  switch (state_) {
    case ChildState::Waiting:
      ++restarts_;
      return begin(now);
    case ChildState::Interrupted:
      return enter(ChildState::Terminated,
                   now + (rules_.stop_timeout - time_to_terminate(rules_.stop_timeout)),
                   ChildAction::Terminate);
    case ChildState::Starting:
      hang_ = Hang::Start;
      break;
    case ChildState::Ready:
      hang_ = Hang::Progress;
      break;
    default:  // Terminated: the others are due at no time
      break;
  }
  return enter(ChildState::Killed, std::nullopt, ChildAction::Kill);
}

}  // namespace skein::launch
