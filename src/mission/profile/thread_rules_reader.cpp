#include "thread_rules_reader.hpp"

#include <charconv>

#include "cpu_list_reader.hpp"
#include "mission/component/dictionary.hpp"
#include "mission/xml/words.hpp"
#include "value_readers.hpp"

namespace skein::profile {
namespace {

using Scheduling = ThreadSettings::Scheduling;

constexpr std::chrono::milliseconds kLongestSpin{100};

// In the order of the enumerators.
constexpr std::array<std::string_view, 3> kSchedulingWords{"normal", "fifo", "round-robin"};
constexpr std::array<std::string_view, 2> kThreadWords{"own", "caller"};

CallThread read_thread(const XmlElement& element) {
  const auto thread =
      read_word(element, "thread", kThreadWords, CallThread::Own, "thread of calls");
  if (thread == CallThread::Own) return thread;
  if (const auto threads = element.maybe_attribute("threads"); threads && threads->value != "1") {
    element.findings().error(threads->where, "with thread=\"caller\" calls run one at a time",
                             "leave threads out, or write thread=\"own\"");
  }
  return CallThread::Caller;
}

int read_in_range(const XmlElement& element, const char* name, int least, int greatest) {
  const auto text = element.maybe_attribute(name);
  if (!text) return 0;
  int number = 0;
  const char* const end = text->value.data() + text->value.size();
  const auto result = std::from_chars(text->value.data(), end, number);
  if (result.ec == std::errc() && result.ptr == end && number >= least && number <= greatest) {
    return number;
  }
  element.findings().error(
      text->where, std::string(name) + " is " + in_quotes(text->value),
      "write a number from " + std::to_string(least) + " to " + std::to_string(greatest));
  return 0;
}

std::chrono::microseconds read_spin(const XmlElement& element) {
  const auto text = element.maybe_attribute("spin");
  if (!text) return {};
  try {
    const auto spin = parse_duration(text->value);
    if (spin <= kLongestSpin) return std::chrono::duration_cast<std::chrono::microseconds>(spin);
    element.findings().error(text->where,
                             "spin is " + in_quotes(text->value) + ", more than 100 ms",
                             "write what a wake-up costs, as in \"50 us\"");
  } catch (const InvalidArgument& error) {
    element.findings().error(text->where, std::string("spin: ") + error.what());
  }
  return {};
}

/// Which of `priority` and `nice` has a meaning follows from the scheduling.
void demand_agreement(const XmlElement& element, Scheduling scheduling) {
  const bool real_time = scheduling != Scheduling::Normal;
  if (const auto nice = element.maybe_attribute("nice"); nice && real_time) {
    element.findings().error(nice->where, "nice is for normal scheduling",
                             "write priority instead");
  }
  const auto priority = element.maybe_attribute("priority");
  if (priority && !real_time) {
    element.findings().error(priority->where, "priority is for fifo and round-robin scheduling",
                             "write scheduling=\"fifo\", or nice instead");
  }
  if (!priority && real_time) {
    element.findings().error(element.maybe_attribute("scheduling")->where,
                             "this scheduling needs a priority", "write priority=\"1\" to \"99\"");
  }
}

}  // namespace

ThreadRules read_thread_rules(const XmlElement& element) {
  ThreadRules rules;
  rules.thread = read_thread(element);
  rules.count = static_cast<std::size_t>(read_in_range(element, "threads", 1, 256));
  ThreadSettings& settings = rules.settings;
  settings.scheduling =
      read_word(element, "scheduling", kSchedulingWords, Scheduling::Normal, "scheduling");
  settings.priority = read_in_range(element, "priority", 1, 99);
  settings.nice = read_in_range(element, "nice", -20, 19);
  settings.cpus = read_cpus(element, "cpus");
  settings.spin = read_spin(element);
  rules.lock_memory = read_boolean(element, kLockMemoryAttribute, false);
  demand_agreement(element, settings.scheduling);
  return rules;
}

}  // namespace skein::profile
