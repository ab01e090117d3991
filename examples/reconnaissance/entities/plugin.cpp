// What a process of the mission loads to be one of the thirteen.
#include <memory>

#include "ad_manager.hpp"
#include "avoider_csps.hpp"
#include "collision_manager.hpp"
#include "emitter_csps.hpp"
#include "eo_manager.hpp"
#include "eoi_manager.hpp"
#include "executive_csps.hpp"
#include "flight_controller.hpp"
#include "flight_models.hpp"
#include "flight_simulator.hpp"
#include "mission/elements.hpp"
#include "mission/places.hpp"
#include "mission_manager.hpp"
#include "mission_navigator.hpp"
#include "nhp.hpp"
#include "object_tracker.hpp"
#include "pursuit.hpp"
#include "radar_warner.hpp"
#include "skein/component_registry.hpp"
#include "skein/entity.hpp"
#include "skein/error.hpp"
#include "station.hpp"
#include "target_csps.hpp"
#include "threat_simulator.hpp"
#include "threats/sites.hpp"
#include "tour_csps.hpp"

using skein::ComponentRegistry;
using skein::Entity;
using skein::ParameterValues;

namespace reconnaissance {
namespace {

/// One that offers a service; it starts when what it depends on is there.
template <class Interface, class Body>
void add_body(ComponentRegistry& registry, const char* name) {
  registry.add_body<Interface>(name, [](Entity& entity, const ParameterValues& values) {
    auto body = std::make_shared<Body>(entity, values);
    return ComponentRegistry::Body{std::make_shared<typename Interface::Skeleton>(body), 1,
                                   [body] { body->start(); }};
  });
}

/// One that offers none.
template <class Own>
void add_activity(ComponentRegistry& registry, const char* name) {
  registry.add_activity(name, [](Entity& entity, const ParameterValues& values) {
    return [own = std::make_shared<Own>(entity, values), &entity](const std::stop_token& told) {
      own->start();
      skein::await_end(entity, told);
      return 0;
    };
  });
}

template <class Interface, class Csp, class... Arguments>
void add_csp(ComponentRegistry& registry, const char* name, Arguments... arguments) {
  registry.add_csp<Interface>(name, [=](const ParameterValues&) {
    return std::make_shared<typename Interface::Skeleton>(std::make_shared<Csp>(arguments...));
  });
}

/// One that has parameters.
template <class Interface, class Csp, class... Arguments>
void add_csp_of_values(ComponentRegistry& registry, const char* name, Arguments... arguments) {
  registry.add_csp<Interface>(name, [=](const ParameterValues& values) {
    return std::make_shared<typename Interface::Skeleton>(
        std::make_shared<Csp>(values, arguments...));
  });
}

std::optional<Circle> always_about(const StandOffTask& task) { return circle_about(task); }

void add_all(ComponentRegistry& registry) {
  add_body<recon::IFlightSimulator, FlightSimulator>(registry, "FlightSimulator");
  add_csp_of_values<recon::IFlightModel, FlightModel>(registry, "PointMass", &advance);
  add_csp_of_values<recon::IFlightModel, FlightModel>(registry, "Kinematic", &advance_kinematic);
  add_csp_of_values<recon::IFlightModel, JsbsimModel>(registry, "JSBSim");

  add_body<recon::IFlightController, FlightController>(registry, "FlightController");
  add_csp<recon::IGuidance, L1Guidance>(registry, "L1");
  add_csp<recon::IGuidance, CarrotGuidance>(registry, "Carrot");

  add_body<recon::INavigator, Navigator>(registry, "Navigator");
  add_csp<AE_navigator::IPlanner, StraightAhead>(registry, "StraightAhead");

  add_body<recon::IMissionManager, MissionManager>(registry, "MissionManager");
  add_csp<recon::ITourPlanner, TourPlanner>(registry, "Exact", &exact_plan);
  add_csp<recon::ITourPlanner, TourPlanner>(registry, "BranchAndBound", &bounded_search);
  add_csp<recon::ITourPlanner, TourPlanner>(registry, "Heuristic", &heuristic_plan);

  add_csp<recon::IStandOff, StandOff>(registry, "CircleAbout", &always_about);
  add_csp<recon::IStandOff, StandOff>(registry, "CircleBeside", &circle_beside);

  add_activity<Nhp>(registry, "Nhp");
  add_csp<recon::IExecutive, Executive<RuleTableExecutive>>(registry, "RuleTable");
  add_csp<recon::IExecutive, Executive<UtilityExecutive>>(registry, "ExpectedUtility");
  add_activity<EoManager>(registry, "EoManager");
  add_csp<recon::ICollectionPattern, CollectionPattern>(registry, "StepStare", &plan_step_stare);
  add_csp<recon::ICollectionPattern, CollectionPattern>(registry, "LineScan", &plan_line_scan);
  add_csp<recon::ICollectionPattern, CollectionPattern>(registry, "Spot", &plan_spot);
  add_csp<recon::ICollectionPattern, Watch>(registry, "Watch");
  add_activity<RadarWarner>(registry, "RadarWarner");
  add_csp<recon::IEmitterClassifier, EmitterClassifier>(registry, "TableMatch", &by_table);
  add_csp<recon::IEmitterClassifier, EmitterClassifier>(registry, "Bayesian", &by_bayes);
  add_csp<recon::IEmitterClassifier, EmitterClassifier>(registry, "Wideband", &by_means);
  add_activity<CollisionManager>(registry, "CollisionManager");
  add_csp<recon::IAvoider, Bands>(registry, "Bands");
  add_csp<recon::IAvoider, PotentialField>(registry, "PotentialField");
  add_activity<ObjectTracker>(registry, "ObjectTracker");
  add_csp<recon::ITargetTracker, TargetTracker<KalmanTrackFilter>>(registry, "KalmanTracker");
  add_csp<recon::ITargetTracker, TargetTracker<StopMoveTrackFilter>>(registry, "StopMoveTracker");
  add_activity<ThreatSimulator>(registry, "ThreatSimulator");
  add_activity<EoiManager>(registry, "EoiManager");
  add_csp<recon::IElementPolicy, ElementPolicy>(registry, "ByPriority", &next_by_priority);
  add_csp<recon::IElementPolicy, ElementPolicy>(registry, "ByValue", &next_by_value);
  add_activity<AdManager>(registry, "AdManager");
  add_csp<recon::IEmitterLocator, EmitterLocator>(registry, "BearingFilter", &by_filter);
  add_csp<recon::IEmitterLocator, EmitterLocator>(registry, "Triangulation", &by_triangulation);

  registry.add_activity("GroundStation", [](Entity& entity, const ParameterValues& values) {
    return [station = std::make_shared<Station>(entity, values)](const std::stop_token& told) {
      return station->run(told);
    };
  });
}

void check_sites(const std::string& text) {
  for (const SiteText& each : parse_sites(text))
    site_of_type(each.type, 0, Local{}, each.active_from_s);
}

void check_elements(const std::string& text) {
  if (parse_elements(text).empty()) throw skein::InvalidArgument("it names no element");
}

/// So that a wrong value is told before anything starts.
void add_checks(ComponentRegistry& registry) {
  registry.add_check<std::string>("Runway", parse_runway);
  registry.add_check<std::string>("Own runway", parse_runway);
  registry.add_check<std::string>("Runways", parse_runways);
  registry.add_check<std::string>("Sites", check_sites);
  registry.add_check<std::string>("Elements", check_elements);
  registry.add_check<std::string>("Objects", parse_objects);
  registry.add_check<std::string>("Intruders", parse_intruders);
  registry.add_check<std::string>("Sensor failures", parse_failures);
  registry.add_check<std::string>("Planner failures", parse_planner_failures);
  registry.add_check<std::string>("Task", task_of);
  registry.add_check<std::string>("Aircraft type", aircraft_type);
  registry.add_check<std::int64_t>("Rate", period_of);
}

}  // namespace
}  // namespace reconnaissance

extern "C" std::uint32_t skein_plugin_abi() { return SKEIN_ABI; }

extern "C" void skein_register_components(ComponentRegistry& registry) {
  reconnaissance::add_all(registry);
  reconnaissance::add_checks(registry);
}
