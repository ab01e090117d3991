#pragma once

#include <set>
#include <string>
#include <string_view>

#include "command/print/output_queue.hpp"
#include "mission/supervise/launch_plan.hpp"
#include "mission/supervise/supervisor.hpp"

namespace skein::command {

/// Lines and events as people want to read them: the mission's own text as it is, other peers'
/// lines with their names, and of the events those that are out of order. Nobody who tells
/// something waits for readers; see OutputQueue.
class Narrator {
 public:
  Narrator(const launch::LaunchPlan& plan, bool verbose);

  void tell_line(std::string_view child, std::string_view line);
  void tell(const launch::ChildEvent& event);
  /// A line on stderr.
  void tell_error(const std::string& text);
  /// Waits for readers, but not for long. Why something was not written; or empty.
  std::string finish() { return output_.flush(); }

 private:
  bool in_order(const launch::ChildEvent& event) const;

  const bool verbose_;
  std::string mission_;
  std::set<std::string> restarted_;
  std::set<std::string> told_to_end_;
  OutputQueue output_;
};

}  // namespace skein::command
