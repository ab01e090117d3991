#pragma once

#include <cstdint>
#include <optional>

#include "navigation/planners/planners.hpp"

namespace skein::navigation {

/// How long one planning may go on: the caller's stop condition and the Problem's time limit.
class PlanningBudget {
 public:
  PlanningBudget(const PlannerOptions& options, std::uint32_t time_limit_ms);

  bool stopped() const { return options_.stop && options_.stop(); }
  bool late() const { return end_ && options_.now() >= *end_; }
  bool spent() const { return stopped() || late(); }

  /// Throws NoRoute, with what ended the planning, once it is spent.
  void require_time() const;

  /// The refusal of a search that has used all of its time.
  AE_navigator::NoRoute nothing_found() const;

  /// Whether a search is over that uses all of its time, so that enough is left to finish its
  /// route: as the time so far shows how fast this machine and this terrain are, `share` of that,
  /// and never more than half of the limit.
  std::function<bool()> search_over(double share) const;

  Instant now() const { return options_.now(); }

 private:
  const PlannerOptions& options_;
  std::uint32_t time_limit_ms_;
  Instant begin_;
  std::optional<Instant> end_;
};

}  // namespace skein::navigation
