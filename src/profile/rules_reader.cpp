#include "rules_reader.hpp"

#include <algorithm>
#include <array>

#include "skein/profile/dictionary.hpp"
#include "words.hpp"

namespace skein::profile {
namespace {

using std::chrono::nanoseconds;

constexpr std::array<const char*, 8> kNames{"restart",      "restart_delay",  "max_restart_delay",
                                            "max_restarts", "restart_window", "ready_timeout",
                                            "stop_timeout", "lock_memory"};

nanoseconds read_time(const XmlElement& element, const char* name, nanoseconds fallback) {
  const auto text = element.maybe_attribute(name);
  if (!text) return fallback;
  try {
    const auto time = parse_duration(text->value);
    if (time > nanoseconds(0)) return time;
    element.findings().error(text->where, std::string(name) + " is zero", "write a length of time");
  } catch (const InvalidArgument& error) {
    element.findings().error(text->where, error.what());
  }
  return fallback;
}

RestartPolicy read_policy(const XmlElement& element) {
  const auto word = element.maybe_attribute("restart");
  if (!word) return RestartPolicy::Never;
  if (const auto policy = maybe_restart_policy(word->value)) return *policy;
  element.findings().error(word->where, in_quotes(word->value) + " is no restart policy",
                           remedy_for(word->value, {"never", "on-failure", "always"}));
  return RestartPolicy::Never;
}

int read_count(const XmlElement& element, const char* name, int fallback) {
  const auto text = element.maybe_attribute(name);
  if (!text) return fallback;
  DictionaryEntry entry;
  entry.name = name;
  entry.type = ValueType::Integer;
  entry.minimum = 1;
  entry.maximum = 1000;
  try {
    return static_cast<int>(std::get<std::int64_t>(parse_value(entry, text->value)));
  } catch (const InvalidArgument& error) {
    element.findings().error(text->where, error.what(), "write a number from 1 to 1000");
    return fallback;
  }
}

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

}  // namespace

ProcessRules read_process_rules(const XmlElement& element) {
  ProcessRules rules;
  auto& restart = rules.restart;
  restart.policy = read_policy(element);
  restart.delay = read_time(element, "restart_delay", restart.delay);
  restart.max_delay = read_time(element, "max_restart_delay", restart.max_delay);
  restart.max_restarts = read_count(element, "max_restarts", restart.max_restarts);
  restart.window = read_time(element, "restart_window", restart.window);
  rules.ready_timeout = read_time(element, "ready_timeout", rules.ready_timeout);
  rules.stop_timeout = read_time(element, "stop_timeout", rules.stop_timeout);
  if (restart.policy != RestartPolicy::Never) demand_reachable_cap(element, restart);
  return rules;
}

void refuse_process_rules(const XmlElement& element) {
  for (const char* name : kNames) {
    if (const auto attribute = element.maybe_attribute(name)) {
      element.findings().error(attribute->where,
                               std::string(name) + " is for processes, and this CSP has none",
                               "write process=\"own\", or set it at the <peer>");
    }
  }
}

bool read_boolean(const XmlElement& element, const char* name, bool fallback) {
  const auto text = element.maybe_attribute(name);
  if (!text) return fallback;
  if (text->value == "true" || text->value == "false") return text->value == "true";
  element.findings().error(text->where, std::string(name) + " is " + in_quotes(text->value),
                           "write true or false");
  return fallback;
}

}  // namespace skein::profile
