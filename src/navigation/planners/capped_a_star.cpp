#include <fmt/core.h>

#include <cmath>
#include <optional>

#include "navigation/planners/planning_scene.hpp"

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
  explicit CappedSearch(const Search& search)
      : search_(search),
        cap_m_(cap_of(search)),
        problem_(search.problem),
        budget_(search.options, problem_.time_limit_ms),
        begin_(search.options.now()) {}

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
      search_.report(*best_);
    }
    return true;
  }

  Route timed_plan(const Problem& problem) {
    const Duration before = spent();
    try {
      Route route = search_a_star({search_.terrains, search_.options, problem, {}});
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

  static double cap_of(const Search& search) {
    const double cap_m = search.options.exposure_cap_m, asked_m = search.problem.exposure_cap_m;
    return asked_m > 0 ? std::min(asked_m, cap_m) : cap_m;
  }

  const Search& search_;
  const double cap_m_;
  const Problem& problem_;
  PlanningBudget budget_;
  Instant begin_;
  Duration last_took_{};
  std::optional<Route> best_;
  double least_exposure_m_ = std::numeric_limits<double>::infinity();
};

}  // namespace

AE_navigator::Route search_capped_a_star(const Search& search) {
  load_valid(search.terrains, search.problem);  // With its own weight, too, which is replaced.
  return CappedSearch(search).find();
}

}  // namespace skein::navigation
