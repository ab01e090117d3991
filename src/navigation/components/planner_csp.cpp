#include "planner_csp.hpp"

#include <algorithm>

#include "navigation/planners/planners.hpp"
#include "navigator.idl.hpp"

namespace skein::navigation {
namespace {

using std::chrono::milliseconds;

/// A planner that never takes longer than its own limit.
class LimitedPlanner final : public AE_navigator::IPlanner {
 public:
  LimitedPlanner(std::unique_ptr<AE_navigator::IPlanner> planner, milliseconds limit)
      : planner_(std::move(planner)), limit_ms_(static_cast<std::uint32_t>(limit.count())) {}

  AE_navigator::Route plan(const AE_navigator::Problem& task) override {
    return planner_->plan(limited(task));
  }

  void improve(const AE_navigator::Problem& task, StreamSink<AE_navigator::Route>& sink) override {
    planner_->improve(limited(task), sink);
  }

 private:
  AE_navigator::Problem limited(AE_navigator::Problem task) const {
    if (task.time_limit_ms == 0 || task.time_limit_ms > limit_ms_) task.time_limit_ms = limit_ms_;
    return task;
  }

  std::unique_ptr<AE_navigator::IPlanner> planner_;
  std::uint32_t limit_ms_;
};

}  // namespace

std::shared_ptr<Servant> make_planner_csp(const std::string& name,
                                          std::shared_ptr<TerrainProvider> terrains,
                                          const ParameterValues& values) {
  PlannerOptions options;
  options.seed = values.find<std::uint32_t>("Seed").value_or(options.seed);
  options.exposure_cap_m = values.find<double>("Exposure cap").value_or(options.exposure_cap_m);
  auto planner = make_planner(name, std::move(terrains), std::move(options));
  if (const auto limit = values.find<milliseconds>("Time limit")) {
    planner =
        std::make_unique<LimitedPlanner>(std::move(planner), std::max(milliseconds(1), *limit));
  }
  return std::make_shared<AE_navigator::IPlanner::Skeleton>(std::move(planner));
}

}  // namespace skein::navigation
