#pragma once

#include <functional>
#include <string>
#include <vector>

#include "mission/xml/finding.hpp"
#include "skein/topic_qos.hpp"

namespace skein::profile {

/// A topic's QoS as a profile sets it, in place of the code's.
struct TopicRules {
  std::string name;
  /// Stands at an element around the peer, for peers that may not all have the topic.
  bool inherited = false;
  SourcePosition where{};
  /// In their order.
  std::vector<std::function<void(TopicQos&)>> changes{};

  void change(TopicQos& qos) const;
};

/// The rules of the topic of that name, or null.
const TopicRules* find_topic(const std::vector<TopicRules>& rules, const std::string& name);

}  // namespace skein::profile
