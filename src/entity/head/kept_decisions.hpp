#pragma once

#include <cstdint>
#include <deque>
#include <mutex>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "decision_log.hpp"
#include "head_parts.hpp"
#include "rpc/service/introspection_topic.hpp"

namespace skein::entity {

/// A Head's last decisions, and their way to the topic and to the log file. Thread-safe.
class KeptDecisions {
 public:
  /// `log`: as HeadOptions::log.
  KeptDecisions(const Head::Parts& parts, const std::string& log)
      : log_(parts.entity, log),
        publisher_(parts.participant, parts.control,
                   introspection::kTopic<introspection::Decision>) {}

  /// Numbers the decision, keeps it and publishes it. `wanted` gets a copy unless it is null.
  void add(introspection::Decision&& decision, introspection::Decision* wanted) {
    const bool read = publisher_.on();
    std::optional<introspection::Decision> copy;
    std::optional<introspection::Decision> dropped;  // outside the lock
    {
      std::lock_guard lock(mutex_);
      decision.number = ++last_;
      if (read || log_.on() || wanted) copy = decision;
      decisions_.push_back(std::move(decision));
      if (decisions_.size() > kMost) {
        dropped = std::move(decisions_.front());
        decisions_.pop_front();
      }
    }
    if (read) publisher_.publish(*copy);
    if (log_.on()) log_.write(*copy);
    if (wanted) *wanted = std::move(*copy);
  }

  /// Oldest first.
  std::vector<introspection::Decision> list() const {
    std::lock_guard lock(mutex_);
    return {decisions_.begin(), decisions_.end()};
  }

 private:
  static constexpr std::size_t kMost = 64;

  DecisionLog log_;
  introspection::Publisher<introspection::Decision> publisher_;
  mutable std::mutex mutex_;
  std::uint64_t last_ = 0;
  std::deque<introspection::Decision> decisions_;
};

}  // namespace skein::entity
