#include <catch2/catch.hpp>

#include "../../src/navigation/components/flight_controller.hpp"
#include "../../src/navigation/components/navigator.hpp"
#include "../connector/pairing.hpp"
#include "../tools/eventually.hpp"
#include "skein/navigation/demo_problem.hpp"
#include "skein/navigation/planners.hpp"

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
    return route;
  }
  void improve(const Problem& task, StreamSink<Route>& sink) override { sink.push(plan(task)); }
  Route route;
  std::vector<Problem> asked;
};

/// A flight controller of a given speed.
std::shared_ptr<IFlightController> flying_at(const std::string& speed) {
  return std::make_shared<FlightController>(ParameterValues{{"Cruising speed", speed}});
}

/// A navigator, and a client who asks it for a route across `synthetic:7` that A* found.
struct Flight {
  Flight() : terrains(std::make_shared<TerrainProvider>()) {
    request.request_id = "one";
    request.problem = demo_problem(*terrains->load("synthetic:7"));
    request.problem.time_limit_ms = 60'000;
    planner->route = make_planner("AStar", terrains)->plan(request.problem);
    navigator->provide<INavigator>(
        std::make_shared<Navigator>(*navigator, ParameterValues{}, terrains),
        {.threads = Navigator::kThreads});
  }

  Route ask() { return client->connect<INavigator>().within(60s).request_route(request); }

  std::shared_ptr<TerrainProvider> terrains;
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
  flight.navigator->provide<IFlightController>(flying_at("60"));
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
  flight.navigator->provide<IFlightController>(flying_at("60"));
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
  const Guid leaving = first->provide<IFlightController>(flying_at("60"));
  flight.navigator->provide_csp<IPlanner>("OneRoute", flight.navigator->id(), flight.planner, {});
  flight.ask();
  REQUIRE(flight.planner->asked.size() == 1);
  CHECK(flight.planner->asked[0].limits.speed_m_s == 60);

  auto second = make_entity("second", Pairing::get().client);
  second->provide<IFlightController>(flying_at("55"));
  auto& broker = flight.navigator->broker();
  const auto query = broker.query("AE_flightControllerI/IFlightController");
  REQUIRE(eventually([&] { return broker.find_service(query).size() == 2; }));
  first->withdraw(leaving);
  REQUIRE(eventually([&] { return broker.find_service(query).size() == 1; }));
  flight.ask();
  REQUIRE(flight.planner->asked.size() == 2);
  CHECK(flight.planner->asked[1].limits.speed_m_s == 55);
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
  controller->provide<IFlightController>(flying_at("60"));
  const auto planner = std::make_shared<NeverContent>();
  planner->route = flight.planner->route;
  flight.navigator->provide_csp<IPlanner>("NeverContent", flight.navigator->id(), planner, {});
  flight.request.problem.time_limit_ms = 500;
  CHECK(flight.ask() == planner->route);
}
