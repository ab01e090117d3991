#include "head_warnings.hpp"

#include "core/log.hpp"

namespace skein::entity {

void HeadWarnings::tell(std::string_view interface, const std::string& csp,
                        const std::string& text) {
  std::lock_guard lock(mutex_);
  std::string& last = told_[{std::string(interface), csp}];
  if (last == text) return;
  last = text;
  log(LogLevel::Warning, entity_, "CSP '" + csp + "'" + text);
}

void HeadWarnings::tell_waiting(const InterfaceInfo& interface, const TaskOptions& task) {
  if (task.execution == Execution::One) return;
  {
    std::lock_guard lock(mutex_);
    if (!told_waiting_.insert(&interface).second) return;
  }
  log(LogLevel::Warning, entity_,
      "the CSPs of " + std::string(interface.name) + " are to work at a time (execution '" +
          to_string(task.execution) +
          "'), but the task's `run` waits for each: they work one after the other; return what an "
          "`async_` function returns");
}

void HeadWarnings::tell_too_few(const InterfaceInfo& interface, const TaskOptions& task,
                                std::size_t csps) {
  if (task.enough == TaskOptions::kAll || task.enough <= csps) return;
  {
    std::lock_guard lock(mutex_);
    if (!told_too_few_.insert(&interface).second) return;
  }
  log(LogLevel::Warning, entity_,
      "a task waits for `enough` = " + std::to_string(task.enough) + " results, but " +
          std::string(interface.name) + " has " + std::to_string(csps) +
          " CSPs: its result is made of what these give, once all have ended");
}

}  // namespace skein::entity
