#include "supervised_child.hpp"

#include <algorithm>
#include <array>
#include <csignal>
#include <cstdio>

#include "core/printable.hpp"
#include "mission/process/ready.hpp"
#include "mission/process/wake_up.hpp"
#include "skein/error.hpp"

namespace skein::launch {
namespace {

// A pipe holds 64 KiB: what the process wrote before its end comes with the first reads. No process
// keeps the launcher from the others by saying more and more.
constexpr int kReadsAtOnce = 16;

}  // namespace

std::string seconds_text(std::chrono::nanoseconds time) {
  std::array<char, 32> text{};
  const double s = std::chrono::duration<double>(time).count();
  if (s < 0.01) {
    std::snprintf(text.data(), text.size(), "%.3g ms", s * 1000);
  } else {
    std::snprintf(text.data(), text.size(), "%.2f s", s);
  }
  return text.data();
}

void SupervisedChild::report(const std::string& text) const {
  options_.on_event({plan_.name, machine_.state(), text});
}

bool SupervisedChild::spawn(Time now) {
  signs_.clear();
  reason_.clear();
  loss_.clear();
  said_ready_ = false;
  try {
    process_ = std::make_unique<ChildProcess>(plan_, guard_);
  } catch (const SystemError& error) {
    spawn_error_ = error.what();
    spawn_may_succeed_later_ = error.is_passing();
    return false;
  } catch (const Error& error) {
    spawn_error_ = error.what();
    spawn_may_succeed_later_ = false;
    return false;
  }
  started_ = now;
  report("started as process " + std::to_string(process_->id()));
  return true;
}

void SupervisedChild::send(ChildAction action, bool overdue) {
  if (!process_) return;
  const auto limit = plan_.rules.stop_timeout;
  switch (action) {
    case ChildAction::Interrupt:
      process_->send(SIGINT);
      report("is asked to end");
      break;
    case ChildAction::Terminate:
      process_->send(SIGTERM);
      report("did not end within " + seconds_text(time_to_terminate(limit)) + ": SIGTERM");
      break;
    case ChildAction::Kill:
      process_->send(SIGKILL);
      report(machine_.hang() != Hang::None ? end_text() + last_reason() + ": killed"
             : overdue ? "did not end within " + seconds_text(limit) + ": killed"
                       : "killed");
      break;
    case ChildAction::None:
    case ChildAction::Spawn:
      break;
  }
}

void SupervisedChild::read_output() {
  if (!process_) return;
  std::array<char, 16 * 1024> buffer;
  for (int i = 0; i < kReadsAtOnce; ++i) {
    const auto size = ::read(process_->output().get(), buffer.data(), buffer.size());
    if (size == 0) process_->output().reset();  // The group closed it; it may live on.
    if (size <= 0) return;
    lines_.add({buffer.data(), static_cast<std::size_t>(size)},
               [&](std::string_view line) { options_.on_output(plan_.name, line); });
  }
}

Signs SupervisedChild::read_signs() {
  Signs signs;
  if (!process_) return signs;
  if (!plan_.tells_ready && !said_ready_) said_ready_ = signs.ready = true;
  std::array<char, 4096> buffer;
  for (int i = 0; i < kReadsAtOnce && process_->readiness(); ++i) {
    const auto size = ::read(process_->readiness().get(), buffer.data(), buffer.size());
    if (size < 0) break;
    if (size == 0) process_->readiness().reset();
    if (size > 0) take_signs({buffer.data(), static_cast<std::size_t>(size)}, signs);
  }
  return signs;
}

// A line that begins with '?' says what the process waits for; any other byte, that it is ready,
// and after that, that it makes progress.
void SupervisedChild::take_signs(std::string_view bytes, Signs& signs) {
  signs_ += bytes;
  while (!signs_.empty()) {
    if (signs_.front() != '?') {
      signs.progress = signs.progress || said_ready_;
      signs.ready = signs.ready || !said_ready_;
      said_ready_ = true;
      reason_.clear();
      signs_.erase(0, std::min(signs_.find('?'), signs_.size()));
      continue;
    }
    const auto end = signs_.find('\n');
    if (end == std::string::npos && signs_.size() <= kLongestReason + 1) return;
    reason_ = printable(std::string_view(signs_).substr(1, end - 1), kLongestReason);
    signs_.erase(0, end == std::string::npos ? end : end + 1);
  }
}

std::optional<ExitStatus> SupervisedChild::collect() {
  if (!process_) return std::nullopt;
  const auto status = process_->collect();
  if (!status) return std::nullopt;
  read_output();
  lines_.finish([&](std::string_view line) { options_.on_output(plan_.name, line); });
  last_status_ = status;
  return status;
}

void SupervisedChild::tell_ready(Time now) {
  report("ready after " + seconds_text(now - started_));
}

void SupervisedChild::tell_spawn_failed() {
  if (machine_.state() == ChildState::Lost)
    loss_ = spawn_fault() + (given_up().empty() ? "" : ", ") + given_up();
  report(spawn_error_ + next_step());
}

std::string SupervisedChild::spawn_fault() const {
  return plan_.name + " could not be started: " + spawn_error_;
}

void SupervisedChild::tell_end() {
  process_.reset();
  if (machine_.state() == ChildState::Lost)
    loss_ = plan_.name + " " + end_text() + last_reason() + (given_up().empty() ? "" : ", ") +
            given_up();
  report("ended " + to_text(*last_status_) + last_reason() + next_step());
}

std::string SupervisedChild::last_reason() const {
  return reason_.empty() ? "" : " (last it said: " + reason_ + ")";
}

std::string SupervisedChild::end_text() const {
  switch (machine_.hang()) {
    case Hang::Start:
      return "did not become ready within " + seconds_text(plan_.rules.ready_timeout);
    case Hang::Progress:
      return "made no progress for " + seconds_text(plan_.rules.progress_timeout);
    case Hang::None:
      break;
  }
  return last_status_ ? "ended " + to_text(*last_status_) : "";
}

std::string SupervisedChild::given_up() const {
  if (machine_.state() != ChildState::Lost || machine_.restarts() == 0) return "";
  return "given up after " + std::to_string(machine_.restarts()) + " restarts";
}

std::string SupervisedChild::next_step() const {
  switch (machine_.state()) {
    case ChildState::Lost:
      return given_up().empty() ? "" : "; " + given_up();
    case ChildState::Waiting:
      return "; restart number " + std::to_string(machine_.restarts() + 1) + " follows";
    case ChildState::Starting:
      return "; it is started anew, as was asked";
    default:
      return "";
  }
}

ProcessStatus SupervisedChild::status(Time now) const {
  ProcessStatus status;
  status.name = plan_.name;
  status.system = plan_.system;
  status.state = to_string(machine_.state());
  status.layer = static_cast<std::uint32_t>(plan_.layer);
  status.pid = process_ ? static_cast<std::uint32_t>(process_->id()) : 0;
  status.restarts = static_cast<std::uint32_t>(machine_.restarts());
  status.uptime = process_ ? std::chrono::duration<double>(now - started_).count() : 0;
  status.last_exit = last_status_ ? to_text(*last_status_) : "";
  status.reason = loss_.empty() ? reason_ : loss_;
  return status;
}

}  // namespace skein::launch
