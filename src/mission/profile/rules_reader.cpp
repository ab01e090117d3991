#include "rules_reader.hpp"

#include <algorithm>

#include "mission/xml/notation.hpp"
#include "mission/xml/words.hpp"
#include "thread_rules_reader.hpp"
#include "value_readers.hpp"

namespace skein::profile {
namespace {

using std::chrono::nanoseconds;

/// A window that is over before the restarts fit into it would never let the launcher give up.
void demand_reachable_cap(const XmlElement& element, const RestartRules& rules) {
  nanoseconds sum{0};
  nanoseconds delay = std::min(rules.delay, rules.max_delay);
  for (int i = 0; i < rules.max_restarts && sum < rules.window; ++i) {
    sum += delay;
    delay = std::min(2 * delay, rules.max_delay);
  }
  if (sum < rules.window) return;
  element.findings().error(element.where(),
                           std::to_string(rules.max_restarts) +
                               " restarts with their delays do not fit into restart_window, so "
                               "that a process which always fails would never be given up",
                           "make restart_window longer or max_restarts fewer");
}

/// What says how to restart a process that never is.
void warn_of_rules_without_restart(const XmlElement& element) {
  if (element.maybe_attribute("restart")) return;
  for (const char* name :
       {"restart_delay", "max_restart_delay", "max_restarts", "restart_window"}) {
    const auto attribute = element.maybe_attribute(name);
    if (!attribute || attribute->inherited) continue;
    element.findings().warning(
        attribute->where,
        std::string(name) + " has no effect, since the process is never restarted",
        "write restart=\"on-failure\" or \"always\", or remove it");
  }
}

/// A process whose reports come later than that for want of a processor is not stuck.
void demand_time_for_reports(const XmlElement& element, const ProcessRules& rules) {
  constexpr nanoseconds kShortest = std::chrono::milliseconds(100);
  const auto written = element.maybe_attribute("progress_timeout");
  if (!written || rules.progress_timeout == nanoseconds(0) || rules.progress_timeout >= kShortest)
    return;
  element.findings().error(
      written->where,
      "progress_timeout is " + in_quotes(written->value) +
          ", and a process in order may need that long to tell of its progress",
      "write 100 ms or more");
}

}  // namespace

ProcessRules read_process_rules(const XmlElement& element, LossPolicy on_loss) {
  ProcessRules rules;
  auto& restart = rules.restart;
  restart.policy = read_word(element, "restart", kRestartWords, restart.policy, "restart policy");
  restart.delay = read_time(element, "restart_delay", restart.delay);
  restart.max_delay = read_time(element, "max_restart_delay", restart.max_delay);
  restart.max_restarts = read_count(element, "max_restarts", restart.max_restarts);
  restart.window = read_time(element, "restart_window", restart.window);
  rules.ready_timeout = read_time(element, "ready_timeout", rules.ready_timeout);
  rules.progress_timeout = read_time(element, "progress_timeout", rules.progress_timeout);
  rules.stop_timeout = read_time(element, "stop_timeout", rules.stop_timeout);
  rules.on_loss = read_word(element, "on_loss", kLossWords, on_loss, "answer to a loss");
  demand_time_for_reports(element, rules);
  if (restart.policy != RestartPolicy::Never) demand_reachable_cap(element, restart);
  warn_of_rules_without_restart(element);
  return rules;
}

void refuse_process_rules(const XmlElement& element) {
  const auto refuse = [&](std::string_view name) {
    if (const auto attribute = element.maybe_attribute(name)) {
      element.findings().error(attribute->where,
                               std::string(name) + " is for processes, and this CSP has none",
                               "write process=\"own\", or set it at the <peer>");
    }
  };
  for (const auto& name : attribute_group(kProcessAttributes)) refuse(name);
  refuse(kLockMemoryAttribute);
}

}  // namespace skein::profile
