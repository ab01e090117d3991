#include "supervised_child.hpp"

#include <algorithm>
#include <array>
#include <csignal>
#include <cstdio>

#include "core/printable.hpp"
#include "launch/ready.hpp"

namespace skein::launch {
namespace {

// A pipe holds 64 KiB: what the process wrote before its end comes with the first reads.
constexpr int kReadsAtOnce = 16;

}  // namespace

std::string seconds_text(std::chrono::nanoseconds time) {
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%.2f s", std::chrono::duration<double>(time).count());
  return text.data();
}

void SupervisedChild::report(const std::string& text) const {
  options_.on_event({plan_.name, machine_.state(), text});
}

void SupervisedChild::perform(ChildAction action, Time now) {
  switch (action) {
    case ChildAction::None:
      break;
    case ChildAction::Spawn:
      spawn(now);
      break;
    case ChildAction::Terminate:
      if (process_) process_->send(SIGTERM);
      break;
    case ChildAction::Kill:
      if (process_) process_->send(SIGKILL);
      break;
  }
}

void SupervisedChild::spawn(Time now) {
  try {
    process_ = std::make_unique<ChildProcess>(plan_, guard_);
    started_ = now;
    hung_at_start_ = false;
    readiness_.clear();
    reason_.clear();
    report("started as process " + std::to_string(process_->id()));
  } catch (const Error& error) {
    loss_ = plan_.name + " could not be started: " + error.what();
    machine_.spawn_failed(now);
    report(error.what());
  }
}

void SupervisedChild::stop(Time now) {
  const auto action = machine_.stop(now);
  perform(action, now);
  if (action == ChildAction::Kill) report("killed");
}

void SupervisedChild::tick(Time now) {
  const auto before = machine_.state();
  const auto action = machine_.tick(now);
  if (action == ChildAction::Kill) {
    hung_at_start_ = before == ChildState::Starting;
    report(hung_at_start_
               ? "is not ready after " + seconds_text(plan_.rules.ready_timeout) + last_reason() +
                     ": killed"
               : "did not end within " + seconds_text(plan_.rules.stop_timeout) + ": killed");
  }
  perform(action, now);
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

void SupervisedChild::read_readiness(Time now) {
  if (!process_) return;
  std::array<char, 4096> buffer;
  while (process_->readiness()) {
    const auto size = ::read(process_->readiness().get(), buffer.data(), buffer.size());
    if (size < 0) return;
    if (size == 0) process_->readiness().reset();
    if (size > 0) take_readiness({buffer.data(), static_cast<std::size_t>(size)}, now);
  }
}

// Lines that begin with '?' say what the process waits for; anything else, that it is ready.
void SupervisedChild::take_readiness(std::string_view bytes, Time now) {
  readiness_ += bytes;
  while (readiness_.starts_with('?')) {
    const auto end = readiness_.find('\n');
    if (end == std::string::npos && readiness_.size() <= kLongestReason + 1) return;
    reason_ = printable(std::string_view(readiness_).substr(1, end - 1), kLongestReason);
    readiness_.erase(0, end == std::string::npos ? end : end + 1);
  }
  if (readiness_.empty()) return;
  process_->readiness().reset();
  if (machine_.state() != ChildState::Starting) return;
  machine_.ready(now);
  reason_.clear();
  report("ready after " + seconds_text(now - started_));
}

std::string SupervisedChild::last_reason() const {
  return reason_.empty() ? "" : " (last it said: " + reason_ + ")";
}

void SupervisedChild::collect(Time now) {
  if (!process_) return;
  // What the child said before its end counts, though its end may be seen first.
  read_readiness(now);
  const auto status = process_->collect();
  if (!status) return;
  read_output();
  lines_.finish([&](std::string_view line) { options_.on_output(plan_.name, line); });
  process_.reset();
  last_status_ = status;
  machine_.exited(status->failed(), now);
  if (machine_.state() == ChildState::Lost) {
    loss_ = plan_.name + (hung_at_start_ ? " did not become ready" : " ended " + to_text(*status)) +
            last_reason() +
            (machine_.restarts() > 0
                 ? ", given up after " + std::to_string(machine_.restarts()) + " restarts"
                 : "");
  }
  report("ended " + to_text(*status) + next_step());
}

std::string SupervisedChild::next_step() const {
  if (machine_.state() == ChildState::Lost && machine_.restarts() > 0) {
    return "; given up after " + std::to_string(machine_.restarts()) + " restarts";
  }
  if (machine_.state() != ChildState::Waiting) return "";
  return "; restart number " + std::to_string(machine_.restarts() + 1) + " follows";
}

}  // namespace skein::launch
