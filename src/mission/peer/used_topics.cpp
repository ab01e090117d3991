#include "used_topics.hpp"

#include "core/suggestion.hpp"

namespace skein::launch {

void UsedTopics::add(const std::string& topic) {
  const std::lock_guard lock(mutex_);
  used_.insert(topic);
}

std::vector<std::string> UsedTopics::unneeded(const std::vector<profile::TopicRules>& rules) const {
  const std::lock_guard lock(mutex_);
  const std::vector<std::string> used(used_.begin(), used_.end());
  std::vector<std::string> without_rule;
  for (const std::string& topic : used) {
    if (!profile::find_topic(rules, topic)) without_rule.push_back(topic);
  }
  std::vector<std::string> texts;
  for (const profile::TopicRules& rule : rules) {
    if (used_.contains(rule.name)) continue;
    const std::string near = suggestion(rule.name, rule.inherited ? without_rule : used);
    if (rule.inherited && near.empty()) continue;  // another peer's topic
    texts.push_back("its profile has a <topic name=\"" + rule.name +
                    "\">, and it used no such topic" + near);
  }
  return texts;
}

}  // namespace skein::launch
