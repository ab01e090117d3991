#pragma once

#include <signal.h>

#include <cerrno>
#include <fstream>
#include <string>
#include <thread>
#include <vector>

#include "mission/supervise/supervisor.hpp"

/// A process that is a shell script; `ready` in it reports readiness.
/// A child that is ready and runs until it is ended.
inline const std::string kWait = "ready; while :; do sleep 1000; done";

inline skein::launch::ChildPlan shell_child(const std::string& name, const std::string& script) {
  skein::launch::ChildPlan child;
  child.name = name;
  child.argv = {"/bin/sh", "-c", "ready() { echo >&$SKEIN_READY_FD; }; " + script};
  child.rules.restart.delay = std::chrono::milliseconds(1);
  return child;
}

/// Runs a mission and keeps what it printed and reported.
struct RecordedMission {
  explicit RecordedMission(std::vector<skein::launch::ChildPlan> children)
      : plan{"m", std::move(children), {}} {}

  skein::launch::LaunchPlan plan;
  std::vector<std::string> lines;   // `child|line`
  std::vector<std::string> events;  // `child: text`
  std::function<void(const skein::launch::ChildEvent&)> on_event;

  skein::launch::SupervisorOptions options() {
    skein::launch::SupervisorOptions options;
    options.on_output = [this](std::string_view child, std::string_view line) {
      lines.push_back(std::string(child) + "|" + std::string(line));
    };
    options.on_event = [this](const skein::launch::ChildEvent& event) {
      events.push_back(event.child + ": " + event.text);
      if (on_event) on_event(event);
    };
    return options;
  }

  skein::launch::LaunchResult run() { return skein::launch::Supervisor(plan, options()).run(); }

  bool saw(const std::string& part) const {
    for (const auto& event : events) {
      if (event.find(part) != std::string::npos) return true;
    }
    return false;
  }
};

inline bool exists(pid_t process) { return ::kill(process, 0) == 0 || errno != ESRCH; }

/// Waits until `holds()`, looking again all the time; false after a minute.
template <typename Condition>
bool wait_until(const Condition& holds) {
  const auto end = std::chrono::steady_clock::now() + std::chrono::minutes(1);
  while (!holds()) {
    if (std::chrono::steady_clock::now() > end) return false;
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }
  return true;
}

/// The numbers in a file, one a line; only lines that are complete.
inline std::vector<pid_t> numbers_in(const std::string& file) {
  std::ifstream input(file);
  std::vector<pid_t> numbers;
  for (std::string line; std::getline(input, line) && !input.eof();) {
    numbers.push_back(std::stoi(line));
  }
  return numbers;
}
