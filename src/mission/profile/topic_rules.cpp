#include "mission/profile/topic_rules.hpp"

#include <algorithm>

namespace skein::profile {

namespace {

template <class T>
void set(T& value, const std::optional<T>& rule) {
  if (rule) value = *rule;
}

template <class T>
void set(std::optional<T>& value, const std::optional<TopicRules::Limit<T>>& rule) {
  if (rule) value = rule->value;
}

}  // namespace

void TopicRules::change(TopicQos& qos) const {
  set(qos.reliable, reliable);
  set(qos.transient_local, transient_local);
  set(qos.exclusive, exclusive);
  set(qos.strength, strength);
  set(qos.history_depth, history_depth);
  set(qos.deadline, deadline);
  set(qos.lifespan, lifespan);
  set(qos.liveliness_lease, liveliness_lease);
  if (exclusive == false) qos.strength = 0;
  if (transient_local == true) qos.max_waiting = 0;  // as in TopicQos::state()
}

const TopicRules* find_topic(const std::vector<TopicRules>& rules, const std::string& name) {
  const auto found = std::ranges::find(rules, name, &TopicRules::name);
  return found == rules.end() ? nullptr : &*found;
}

}  // namespace skein::profile
