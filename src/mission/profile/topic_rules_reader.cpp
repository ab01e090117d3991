#include "topic_rules_reader.hpp"

#include <charconv>
#include <limits>
#include <utility>

#include "dds/port/options_check.hpp"
#include "mission/component/dictionary.hpp"
#include "mission/xml/words.hpp"
#include "repeated.hpp"

namespace skein::profile {
namespace {

using std::chrono::milliseconds;

using Period = std::optional<milliseconds>;  // unset: `none`
using Depth = std::optional<std::uint32_t>;  // unset: `all`

constexpr const char* kNone = "none";
constexpr std::chrono::hours kLongest{24 * 365};

std::optional<bool> read_word(const XmlElement& topic, const char* name, const char* no,
                              const char* yes) {
  const auto word = topic.maybe_attribute(name);
  if (!word) return std::nullopt;
  if (word->value == no || word->value == yes) return word->value == yes;
  topic.findings().error(word->where, std::string(name) + " is " + in_quotes(word->value),
                         remedy_for(word->value, {no, yes}));
  return std::nullopt;
}

template <class Number>
std::optional<Number> read_bound(const XmlElement& topic, const XmlAttribute& text, Number least,
                                 const char* remedy) {
  Number number{};
  const char* const end = text.value.data() + text.value.size();
  const auto result = std::from_chars(text.value.data(), end, number);
  if (result.ec == std::errc() && result.ptr == end && number >= least) return number;
  topic.findings().error(text.where, text.name + " is " + in_quotes(text.value), remedy);
  return std::nullopt;
}

std::optional<Period> read_period(const XmlElement& topic, const char* name) {
  const auto text = topic.maybe_attribute(name);
  if (!text) return std::nullopt;
  if (text->value == kNone) return Period();
  const auto refuse = [&](const std::string& what) {
    topic.findings().error(
        text->where, what,
        "write whole milliseconds, as in \"100 ms\", a year at most; or \"none\"");
    return std::nullopt;
  };
  try {
    const auto time = parse_duration(text->value);
    if (time < milliseconds(1) || time > kLongest || time % milliseconds(1) != time.zero()) {
      return refuse(std::string(name) + " is " + in_quotes(text->value));
    }
    return Period(std::chrono::duration_cast<milliseconds>(time));
  } catch (const InvalidArgument& error) {
    return refuse(std::string(name) + ": " + error.what());
  }
}

std::optional<Depth> read_history(const XmlElement& topic) {
  const auto text = topic.maybe_attribute("history");
  if (!text) return std::nullopt;
  if (text->value == "all") return Depth();
  const auto depth = read_bound<std::uint32_t>(
      topic, *text, 1, "write how many values of each key are kept, or \"all\"");
  if (!depth) return std::nullopt;
  return Depth(*depth);
}

std::optional<std::int32_t> read_strength(const XmlElement& topic, std::optional<bool> exclusive) {
  const auto text = topic.maybe_attribute("strength");
  if (!text) return std::nullopt;
  const auto strength =
      read_bound<std::int32_t>(topic, *text, 0, "write a number: 0, or more for stronger");
  if (exclusive == false && strength.value_or(0) > 0) {
    topic.findings().error(text->where, "a strength means nothing with shared ownership",
                           "write ownership=\"exclusive\", or leave strength out");
  }
  return strength;
}

void demand_topic_name(const XmlAttribute& name, FindingList& findings) {
  if (name.value.empty()) return;
  if (name.value.starts_with("skein/")) {
    findings.error(name.where, in_quotes(name.value) + " is one of Skein's own topics",
                   "their QoS is fixed; name a topic of the mission");
  } else if (!dds::is_topic_name(name.value)) {
    findings.error(name.where, in_quotes(name.value) + " is no topic's name",
                   "it has letters, digits, '_' and '/', 255 at most, and does not begin with a "
                   "digit or DCPS");
  }
}

TopicRules read_rules(const XmlElement& topic) {
  TopicRules rules;
  const auto name = topic.attribute("name");
  demand_topic_name(name, topic.findings());
  rules.name = name.value;
  rules.where = name.where;
  rules.inherited = name.inherited;
  // Without a value the member stays as the code says.
  const auto set = [&](auto member, const auto& value) {
    if (!value) return;
    rules.changes.emplace_back([member, held = *value](TopicQos& qos) { qos.*member = held; });
  };
  set(&TopicQos::reliable, read_word(topic, "reliability", "best-effort", "reliable"));
  const auto transient_local = read_word(topic, "durability", "volatile", "transient-local");
  set(&TopicQos::transient_local, transient_local);
  set(&TopicQos::history_depth, read_history(topic));
  set(&TopicQos::deadline, read_period(topic, "deadline"));
  set(&TopicQos::lifespan, read_period(topic, "lifespan"));
  set(&TopicQos::liveliness_lease, read_period(topic, "lease"));
  const auto exclusive = read_word(topic, "ownership", "shared", "exclusive");
  set(&TopicQos::exclusive, exclusive);
  set(&TopicQos::strength, read_strength(topic, exclusive));
  if (exclusive == false) set(&TopicQos::strength, std::optional(0));
  // As in TopicQos::state().
  if (transient_local == true) set(&TopicQos::max_waiting, std::optional(0U));
  return rules;
}

}  // namespace

std::vector<TopicRules> read_topic_rules(const XmlElement& peer) {
  std::vector<TopicRules> topics;
  Repeated names("the topic");
  for (const auto& topic : peer.children("topic")) {
    topics.push_back(read_rules(topic));
    names.add(topics.back().name, topic.where(), topic.findings());
  }
  return topics;
}

}  // namespace skein::profile
