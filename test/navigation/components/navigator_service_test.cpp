#include <catch2/catch.hpp>
#include <limits>

#include "brokerless_discovery/broker.hpp"
#include "navigation/components/flight_controller.hpp"
#include "navigation/components/navigator.hpp"
#include "navigation/planners/planners.hpp"
#include "navigation/routes/demo_problem.hpp"
#include "test/connector/pairing.hpp"
#include "test/tools/eventually.hpp"

using namespace skein;
using namespace skein::navigation;
using namespace skein::test;
using namespace std::chrono_literals;
using AE_flightControllerI::IFlightController;
using AE_navigator::IPlanner;
using AE_navigator::Problem;
using AE_navigator::Route;
using AE_navigatorI::INavigator;

namespace {

/// Answers with one route, and remembers what it was asked.
struct OneRoute : IPlanner {
  Route plan(const Problem& task) override {
    asked.push_back(task);
    route.threat_epoch = task.threat_epoch;
    return route;
  }
  Route route;
  std::vector<Problem> asked;
};

/// Knows that all radars are off the air, and that this is the fifth picture.
struct AllClear : AE_adManagerI::IAdManager {
  AE_adManagerI::ThreatPicture threat_picture(const std::string& terrain) override {
    ++asked;
    return {terrain, 5, {}, {}};
  }
  AE_adManagerI::ThreatPicture radar_found(const std::string& terrain,
                                           const AE_navigator::RadarSite&) override {
    return threat_picture(terrain);
  }
  AE_adManagerI::ThreatPicture radar_silent(const std::string& terrain,
                                            const std::string&) override {
    return threat_picture(terrain);
  }
  AE_adManagerI::ThreatPicture missiles_found(const std::string& terrain,
                                              const AE_navigator::MissileSite&) override {
    return threat_picture(terrain);
  }
  std::atomic<int> asked = 0;
};

/// A flight controller of a given speed.
std::shared_ptr<IFlightController> flying_at(double speed_m_s) {
  return std::make_shared<FlightController>(ParameterValues{{"Cruising speed", speed_m_s}});
}

/// A navigator, and a client who asks it for a route across `synthetic:7` that A* found, once for
/// all tests.
struct Flight {
  Flight() {
    static const Problem problem = [] {
      Problem demo = demo_problem(*terrains->load("synthetic:7"));
      demo.time_limit_ms = 60'000;
      return demo;
    }();
    static const Route route = make_planner("AStar", terrains)->plan(problem);
    request.request_id = "one";
    request.problem = problem;
    planner->route = route;
    navigator->provide<INavigator>(
        std::make_shared<Navigator>(*navigator, ParameterValues{}, terrains),
        {.threads = Navigator::kThreads});
  }

  Route ask() { return client->connect<INavigator>().within(60s).request_route(request); }

  static inline const auto terrains = std::make_shared<TerrainProvider>();
  std::shared_ptr<OneRoute> planner = std::make_shared<OneRoute>();
  AE_navigatorI::RouteRequest request;
  std::unique_ptr<Entity> navigator = make_entity("navigator", Pairing::get().server);
  std::unique_ptr<Entity> client = make_entity("client", Pairing::get().client);
};

}  // namespace

TEST_CASE(
    "a caller may bring a planner of its own, as a reference: it is asked, and its route is "
    "judged") {
  Flight flight;
  flight.navigator->provide<IFlightController>(flying_at(60));
  const Guid own = flight.client->provide<IPlanner>(flight.planner);
  flight.request.own_planner = flight.client->reference<IPlanner>(own);

  CHECK(flight.ask() == flight.planner->route);
  REQUIRE(flight.planner->asked.size() == 1);
  CHECK(flight.planner->asked[0].goal == flight.request.problem.goal);

  flight.planner->route.waypoints.resize(2);
  CHECK_THROWS_AS(flight.ask(), AE_navigator::NoRoute);
  CHECK(flight.planner->asked.size() == 2);
}

TEST_CASE("a reference to a planner that is gone is answered as such, and the navigator works on") {
  Flight flight;
  flight.navigator->provide<IFlightController>(flying_at(60));
  const Guid own = flight.client->provide<IPlanner>(flight.planner);
  flight.request.own_planner = flight.client->reference<IPlanner>(own);
  flight.client->withdraw(own);
  flight.request.problem.time_limit_ms = 200;
  CHECK_THROWS_AS(flight.ask(), Error);
  CHECK(flight.planner->asked.empty());

  const Guid again = flight.client->provide<IPlanner>(flight.planner);
  flight.request.own_planner = flight.client->reference<IPlanner>(again);
  flight.request.problem.time_limit_ms = 60'000;
  CHECK(flight.ask() == flight.planner->route);
}

TEST_CASE("the flight limits come from the next flight controller when the first one leaves") {
  Flight flight;
  auto first = make_entity("first", Pairing::get().client);
  const Guid leaving = first->provide<IFlightController>(flying_at(60));
  flight.navigator->provide_csp<IPlanner>("OneRoute", flight.navigator->id(), flight.planner, {});
  flight.ask();
  REQUIRE(flight.planner->asked.size() == 1);
  CHECK(flight.planner->asked[0].limits.speed_m_s == 60);

  auto second = make_entity("second", Pairing::get().client);
  second->provide<IFlightController>(flying_at(55));
  auto& broker = flight.navigator->broker();
  const auto query = broker.query("AE_flightControllerI/IFlightController");
  REQUIRE(eventually([&] { return broker.find_service(query).size() == 2; }));
  first->withdraw(leaving);
  REQUIRE(eventually([&] { return broker.find_service(query).size() == 1; }));
  flight.ask();
  REQUIRE(flight.planner->asked.size() == 2);
  CHECK(flight.planner->asked[1].limits.speed_m_s == 55);
}

TEST_CASE(
    "where no route keeps the exposure cap, the AD manager is asked once, and it is planned anew "
    "with its threats") {
  Flight flight;
  flight.navigator->provide<IFlightController>(flying_at(60));
  flight.navigator->provide_csp<IPlanner>("OneRoute", flight.navigator->id(), flight.planner, {});
  const auto manager = make_entity("ad_manager", Pairing::get().client);
  const auto all_clear = std::make_shared<AllClear>();
  manager->provide<AE_adManagerI::IAdManager>(all_clear);
  flight.request.problem.exposure_cap_m = 10;
  flight.request.problem.threat_epoch = 3;

  CHECK(flight.ask().threat_epoch == 5);
  CHECK(all_clear->asked == 1);
  REQUIRE(flight.planner->asked.size() == 2);
  CHECK(flight.planner->asked[0].radar_sites.size() == 4);
  CHECK(flight.planner->asked[1].radar_sites.empty());
  const auto report = flight.client->connect<INavigator>().report("one");
  REQUIRE(report.attempts.size() == 2);
  CHECK(report.attempts[0].check == "exposure cap");
  CHECK(report.attempts[0].threat_epoch == 3);
  CHECK(report.attempts[1].outcome == "accepted");
  CHECK(report.attempts[1].threat_epoch == 5);

  SECTION("what it learned serves the next request, and nobody is asked again") {
    CHECK(flight.ask().threat_epoch == 5);
    CHECK(flight.planner->asked.size() == 3);
    CHECK(all_clear->asked == 1);
  }
  SECTION("threats of the caller's own are left as they are") {
    flight.request.problem.threat_epoch = 0;
    CHECK_THROWS_AS(flight.ask(), AE_navigator::NoRoute);
    CHECK(flight.planner->asked.back().radar_sites.size() == 4);
    CHECK(all_clear->asked == 1);
  }
}

TEST_CASE(
    "a problem that holds what is no number comes to a planner, which may say what is wrong") {
  Flight flight;
  flight.navigator->provide<IFlightController>(flying_at(60));
  flight.navigator->provide_csp<IPlanner>("OneRoute", flight.navigator->id(), flight.planner, {});
  flight.request.problem.exposure_cap_m = std::numeric_limits<double>::quiet_NaN();
  try {
    flight.ask();
  } catch (const std::exception&) {  // what is made of its route is not the matter here
  }
  CHECK(flight.planner->asked.size() == 1);
}

TEST_CASE("where no AD manager answers, the refusal names the cap") {
  Flight flight;
  flight.navigator->provide<IFlightController>(flying_at(60));
  flight.navigator->provide_csp<IPlanner>("OneRoute", flight.navigator->id(), flight.planner, {});
  flight.request.problem.exposure_cap_m = 10;
  flight.request.problem.threat_epoch = 3;
  try {
    flight.ask();
    FAIL("a route over the cap was passed on");
  } catch (const AE_navigator::NoRoute& refusal) {
    CHECK_THAT(refusal.reason, Catch::Contains("the cap is 0.0 km"));
  }
  CHECK(flight.planner->asked.size() == 1);
}

TEST_CASE("the best route so far is taken when a planner's time is up") {
  /// Has its route at once, and looks for a better one until nobody waits.
  struct NeverContent : OneRoute {
    void improve(const Problem& task, StreamSink<Route>& sink) override {
      for (Route better = plan(task);;) sink.push(better);
    }
  };
  Flight flight;
  const auto controller = make_entity("controller", Pairing::get().client);
  controller->provide<IFlightController>(flying_at(60));
  const auto planner = std::make_shared<NeverContent>();
  planner->route = flight.planner->route;
  flight.navigator->provide_csp<IPlanner>("NeverContent", flight.navigator->id(), planner, {});
  flight.request.problem.time_limit_ms = 500;
  CHECK(flight.ask() == planner->route);
}

TEST_CASE("the best route so far of those that improve theirs is taken when their time is up") {
  Flight flight;
  flight.navigator->provide<IFlightController>(flying_at(60));
  PlannerOptions endless;
  endless.now = [] { return Instant(); };  // For all that it knows there is time.
  for (const char* name : {"RRTstar", "InformedRRTstar"}) {
    flight.navigator->provide_csp<IPlanner>(name, flight.navigator->id(),
                                            make_planner(name, flight.terrains, endless), {});
    flight.request.planner = name;
    flight.request.problem.time_limit_ms = 5000;
    CHECK(flight.ask().planner == name);
  }
}
