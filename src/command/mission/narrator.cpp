#include "narrator.hpp"

#include <unistd.h>

#include <sstream>
#include <string>

#include "core/printable.hpp"

namespace skein::command {

Narrator::Narrator(const launch::LaunchPlan& plan, bool verbose) : verbose_(verbose) {
  for (const launch::ChildPlan& child : plan.children) {
    if (child.runs_mission) mission_ = child.name;
  }
}

void Narrator::tell_line(std::string_view child, std::string_view line) {
  std::string text = child == mission_ ? "" : std::string(child) + " | ";
  output_.add(STDOUT_FILENO, text.append(printable(line, line.size())));
}

void Narrator::tell(const launch::ChildEvent& event) {
  using launch::ChildState;
  if (event.state == ChildState::Waiting) restarted_.insert(event.child);
  if (event.state == ChildState::Starting) told_to_end_.erase(event.child);
  if (event.state == ChildState::Interrupted) told_to_end_.insert(event.child);
  if (verbose_ || !in_order(event)) {
    tell_error("* " + (event.child.empty() ? "mission" : event.child) + ": " + event.text);
  }
}

bool Narrator::in_order(const launch::ChildEvent& event) const {
  using launch::ChildState;
  // Without the mission's own text nothing else would tell that it flies.
  if (event.child.empty()) return !mission_.empty();
  switch (event.state) {
    case ChildState::Starting:
    case ChildState::Ready:
      return !restarted_.contains(event.child);
    case ChildState::Interrupted:
      return true;
    case ChildState::Ended:
      return event.child == mission_ || told_to_end_.contains(event.child);
    default:
      return false;
  }
}

void Narrator::tell_error(const std::string& text) {
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    output_.add(STDERR_FILENO, printable(line, line.size()));
  }
}

}  // namespace skein::command
