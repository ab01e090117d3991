#pragma once

#include <memory>
#include <mutex>
#include <optional>

#include "flight_controller.idl.hpp"
#include "navigation/terrain/terrain_provider.hpp"
#include "navigator.idl.hpp"
#include "planning_journal.hpp"
#include "skein/entity.hpp"
#include "skein/head.hpp"
#include "skein/parameters.hpp"
#include "threat_watch.hpp"

namespace skein::navigation {

/// The navigator's Body. It plans nothing itself: it completes each request with what the aircraft
/// can fly, lets its entity's Head find a planner for it, and judges what the planner returns.
///
/// A request's variable parameters are `Planner` (only the CSP of that name) and `Time limit`; what
/// the request leaves open comes from the mission profile. The flight limits are always those of
/// the flight controller, whatever the request says. The caller's deadline bounds everything.
///
/// Threats with an epoch are renewed: where a later picture is known it takes their place, and
/// where no route is found under an exposure cap, in the first half of the time, the AD manager is
/// asked for a fresh one; if there is, planning begins anew in the time that is left.
///
/// Up to kMaxRequests are planned at once; more are refused as Overloaded, so that status() and
/// report() always find a thread.
class Navigator final : public AE_navigatorI::INavigator {
 public:
  static constexpr std::size_t kMaxRequests = 3;
  static constexpr std::size_t kThreads = kMaxRequests + 1;

  /// `entity` outlives it; `profile` holds the values of the mission profile.
  Navigator(Entity& entity, ParameterValues profile, std::shared_ptr<TerrainProvider> terrains);

  /// Throws NoRoute, proven or not; InvalidProblem; Unavailable where no planner or no flight
  /// controller is available.
  AE_navigator::Route request_route(const AE_navigatorI::RouteRequest& request) override;
  AE_navigatorI::PlanningStatus status() override;
  AE_navigatorI::PlanningReport report(const std::string& request_id) override;

 private:
  struct Question {
    const std::string& id;
    const AE_navigator::Problem& problem;
    const std::string& only;
    Duration limit;
  };

  AE_navigator::Route decide(const AE_navigatorI::RouteRequest& request,
                             std::vector<Planning>& plannings);
  AE_navigator::Route plan(const Question& question, std::vector<Planning>& plannings);
  bool renew_threats(AE_navigator::Problem& problem, Instant end);
  AE_navigator::Route ask(const skein::Reference<AE_navigator::IPlanner>& planner,
                          const AE_navigator::Problem& problem, Duration limit,
                          introspection::Decision& record);
  AE_flightControllerI::FlightLimits flight_limits();

  Entity& entity_;
  const ParameterValues profile_;
  const ParameterResolver parameters_;
  const std::shared_ptr<TerrainProvider> terrains_;
  ThreatWatch threats_;
  PlanningJournal journal_;
  std::mutex mutex_;
  std::optional<AE_flightControllerI::IFlightController::Proxy> flight_controller_;
};

}  // namespace skein::navigation
