#include <fmt/core.h>

#include <cmath>
#include <optional>

#include "navigation/planners/planners.hpp"
#include "navigation/planners/planning_scene.hpp"
#include "skein/error.hpp"

namespace skein::navigation {
namespace {

using AE_navigator::NoRoute;
using AE_navigator::Problem;
using AE_navigator::Route;

/// Lagrangian relaxation: the cap becomes a weight on exposure, and each weight's cheapest route is
/// the shortest among those that are no more exposed. The least weight that keeps the cap is found
/// by halving between one that does and one that does not.
class CappedSearch {
 public:
  using Report = std::function<void(const Route&)>;

  CappedSearch(std::shared_ptr<TerrainProvider> terrains, const PlannerOptions& options,
               const Problem& problem, Report report)
      : planner_(make_a_star(std::move(terrains), options)),
        cap_m_(cap_of(options, problem)),
        report_(std::move(report)),
        problem_(problem),
        budget_(options, problem.time_limit_ms),
        begin_(options.now()) {}

  Route find() {
    if (plan_with(0)) return finish();
    double too_light = 0;
    double weight = kFirstWeight;
    while (!plan_with(weight)) {
      too_light = weight;
      weight *= kStep;
      if (weight > kHeaviest || !has_time()) refuse();
    }
    double heavy_enough = weight;
    for (int i = 0; i < kHalvings && has_time(); ++i) {
      weight = too_light > 0 ? std::sqrt(too_light * heavy_enough) : heavy_enough / kStep;
      try {
        (plan_with(weight) ? heavy_enough : too_light) = weight;
      } catch (const NoRoute&) {  // Out of time; there is a route already.
        break;
      }
    }
    return finish();
  }

 private:
  static constexpr double kFirstWeight = 0.1;
  static constexpr double kStep = 8;
  static constexpr double kHeaviest = 1e5;
  static constexpr int kHalvings = 7;

  /// Whether the route with that weight keeps the cap.
  bool plan_with(double weight) {
    Problem problem = problem_;
    problem.exposure_weight = weight;
    if (problem_.time_limit_ms > 0) {
      const auto left = std::chrono::duration_cast<std::chrono::milliseconds>(
          std::chrono::milliseconds(problem_.time_limit_ms) - spent());
      problem.time_limit_ms = static_cast<std::uint32_t>(std::max<std::int64_t>(1, left.count()));
    }
    Route route = timed_plan(problem);
    route.planner = "CappedAStar";
    if (route.radar_exposure > cap_m_) {
      least_exposure_m_ = std::min(least_exposure_m_, route.radar_exposure);
      return false;
    }
    if (!best_ || route.length_m < best_->length_m) {
      best_ = std::move(route);
      if (report_) report_(*best_);
    }
    return true;
  }

  Route timed_plan(const Problem& problem) {
    const Duration before = spent();
    try {
      Route route = planner_->plan(problem);
      last_took_ = spent() - before;
      return route;
    } catch (const NoRoute& refusal) {
      if (!refusal.proven) budget_.require_time();
      throw;
    }
  }

  Duration spent() const { return budget_.now() - begin_; }

  /// For another route: none is begun that would end late.
  bool has_time() const {
    if (problem_.time_limit_ms == 0) return true;
    return spent() + last_took_ + last_took_ / 4 <
           std::chrono::milliseconds(problem_.time_limit_ms);
  }

  Route finish() { return std::move(*best_); }

  [[noreturn]] void refuse() const {
    throw NoRoute(fmt::format("the least exposed route that was found has an exposure of {:.0f} m; "
                              "the cap is {:.0f} m",
                              least_exposure_m_, cap_m_),
                  false);
  }

  static double cap_of(const PlannerOptions& options, const Problem& problem) {
    return problem.exposure_cap_m > 0 ? std::min(problem.exposure_cap_m, options.exposure_cap_m)
                                      : options.exposure_cap_m;
  }

  std::unique_ptr<AE_navigator::IPlanner> planner_;
  const double cap_m_;
  Report report_;
  const Problem& problem_;
  PlanningBudget budget_;
  Instant begin_;
  Duration last_took_{};
  std::optional<Route> best_;
  double least_exposure_m_ = std::numeric_limits<double>::infinity();
};

class CappedAStarPlanner final : public AE_navigator::IPlanner {
 public:
  CappedAStarPlanner(std::shared_ptr<TerrainProvider> terrains, PlannerOptions options)
      : terrains_(std::move(terrains)), options_(std::move(options)) {
    if (options_.exposure_cap_m >= 0) return;
    throw InvalidArgument(
        fmt::format("the exposure cap is {} m; it must be 0 or more", options_.exposure_cap_m));
  }

  Route plan(const Problem& problem) override { return search(problem, {}); }

  void improve(const Problem& problem, StreamSink<Route>& sink) override {
    // A route that the caller has no room for is overtaken by the next.
    const CappedSearch::Report report = [&](const Route& route) { sink.try_push(route); };
    sink.push(search(problem, report));
  }

 private:
  Route search(const Problem& problem, const CappedSearch::Report& report) const {
    load_valid(*terrains_, problem);  // With its own weight, too, which the search replaces.
    return CappedSearch(terrains_, options_, problem, report).find();
  }

  std::shared_ptr<TerrainProvider> terrains_;
  PlannerOptions options_;
};

}  // namespace

std::unique_ptr<AE_navigator::IPlanner> make_capped_a_star(
    std::shared_ptr<TerrainProvider> terrains, PlannerOptions options) {
  return std::make_unique<CappedAStarPlanner>(std::move(terrains), std::move(options));
}

}  // namespace skein::navigation
