#pragma once

#include <mutex>
#include <set>
#include <string>
#include <vector>

#include "mission/profile/topic_rules.hpp"

namespace skein::launch {

/// The topics that a peer's code has published or subscribed. Thread-safe.
class UsedTopics {
 public:
  void add(const std::string& topic);

  /// What is to be told of each rule of the peer's own that no topic needed, with the nearest that
  /// was used; and of a rule for several peers where this one used a topic of almost that name, for
  /// which there is no rule.
  std::vector<std::string> unneeded(const std::vector<profile::TopicRules>& rules) const;

 private:
  mutable std::mutex mutex_;
  std::set<std::string> used_;
};

}  // namespace skein::launch
