#include "navigation/planners/planning_budget.hpp"

#include <fmt/core.h>

#include <algorithm>

#include "skein/call_context.hpp"

namespace skein::navigation {
namespace {

/// How long a planner that uses all of its time searches if the Problem sets no limit.
constexpr std::chrono::seconds kOwnLimit{1};

}  // namespace

bool current_call_cancelled() {
  const CallContext* context = CallContext::current();
  return context != nullptr && context->cancelled();
}

PlanningBudget::PlanningBudget(const PlannerOptions& options, std::uint32_t time_limit_ms)
    : options_(options), time_limit_ms_(time_limit_ms), begin_(options.now()) {
  if (time_limit_ms > 0) end_ = begin_ + std::chrono::milliseconds(time_limit_ms);
}

void PlanningBudget::require_time() const {
  if (stopped())
    throw AE_navigator::NoRoute("the planning was stopped before it found a route", false);
  if (late()) throw nothing_found();
}

AE_navigator::NoRoute PlanningBudget::nothing_found() const {
  if (!end_) return {"no route was found within the planner's own time limit", false};
  return {fmt::format("no route was found within the time limit of {} ms", time_limit_ms_), false};
}

std::function<bool()> PlanningBudget::search_over(double share) const {
  Instant end = begin_ + kOwnLimit;
  if (end_) {
    const Duration used = options_.now() - begin_;
    const Duration limit = *end_ - begin_;
    end = *end_ - std::min(std::chrono::duration_cast<Duration>(used * share), limit / 2);
  }
  return [this, end] { return stopped() || now() >= end; };
}

}  // namespace skein::navigation
