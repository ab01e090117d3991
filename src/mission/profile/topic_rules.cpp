#include "mission/profile/topic_rules.hpp"

#include <algorithm>

namespace skein::profile {

void TopicRules::change(TopicQos& qos) const {
  for (const auto& change : changes) change(qos);
}

const TopicRules* find_topic(const std::vector<TopicRules>& rules, const std::string& name) {
  const auto found = std::ranges::find(rules, name, &TopicRules::name);
  return found == rules.end() ? nullptr : &*found;
}

}  // namespace skein::profile
