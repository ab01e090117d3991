#include "head_reader.hpp"

#include <string>

#include "mission/xml/notation.hpp"
#include "value_readers.hpp"

namespace skein::profile {
namespace {

void read_text(const XmlElement& element, const char* name, std::string& text) {
  if (element.maybe_attribute(name)) text = element.attribute(name).value;
}

CircuitBreaker::Rules read_breaker(const XmlElement& element) {
  CircuitBreaker::Rules rules;
  rules.faults = static_cast<unsigned>(
      read_count(element, "quarantine_after", static_cast<int>(rules.faults)));
  rules.first_quarantine = read_time(element, "first_quarantine", rules.first_quarantine);
  rules.longest_quarantine = read_time(element, "longest_quarantine", rules.longest_quarantine);
  if (rules.longest_quarantine < rules.first_quarantine) {
    element.findings().error(element.where(), "longest_quarantine is shorter than first_quarantine",
                             "make it longer, or first_quarantine shorter");
  }
  return rules;
}

}  // namespace

HeadOptions read_head_options(const XmlElement& element) {
  HeadOptions head;
  read_text(element, "strategy", head.strategy);
  read_text(element, "history", head.history);
  read_text(element, "decision_log", head.log);
  head.exploration = read_share(element, "exploration", head.exploration);
  head.max_stuck =
      static_cast<std::size_t>(read_count(element, "max_stuck", static_cast<int>(head.max_stuck)));
  head.breaker = read_breaker(element);
  return head;
}

void warn_of_head_without_csps(const XmlElement& element) {
  for (const auto& name : attribute_group(kHeadAttributes)) {
    const auto attribute = element.maybe_attribute(name);
    if (!attribute || attribute->inherited) continue;
    element.findings().warning(
        attribute->where,
        std::string(name) + " has no effect, since the peer has no CSPs to choose among",
        "remove it, or add a <csp>");
  }
}

}  // namespace skein::profile
