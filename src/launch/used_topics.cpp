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
  std::vector<std::string> texts;
  for (const profile::TopicRules& rule : rules) {
    if (rule.inherited || used_.contains(rule.name)) continue;
    texts.push_back("its profile has a <topic name=\"" + rule.name +
                    "\">, and it used no such topic" + suggestion(rule.name, used));
  }
  return texts;
}

}  // namespace skein::launch
