#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "mission/xml/finding.hpp"
#include "skein/topic_qos.hpp"

namespace skein::profile {

/// What a profile says of a topic's QoS, in place of what the code says. Unset: as the code says.
struct TopicRules {
  /// Unset: `none`, or `all`.
  template <class T>
  struct Limit {
    std::optional<T> value{};

    bool operator==(const Limit&) const = default;
  };
  using Depth = Limit<std::uint32_t>;
  using Period = Limit<std::chrono::milliseconds>;

  std::string name;
  /// Stands at an element around the peer, for peers that may not all have the topic.
  bool inherited = false;
  std::optional<bool> reliable{};
  std::optional<bool> transient_local{};
  std::optional<bool> exclusive{};
  std::optional<std::int32_t> strength{};
  std::optional<Depth> history_depth{};
  std::optional<Period> deadline{};
  std::optional<Period> lifespan{};
  std::optional<Period> liveliness_lease{};
  SourcePosition where{};

  void change(TopicQos& qos) const;
};

/// The rules of the topic of that name, or null.
const TopicRules* find_topic(const std::vector<TopicRules>& rules, const std::string& name);

}  // namespace skein::profile
