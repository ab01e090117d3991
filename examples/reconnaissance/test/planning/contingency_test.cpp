#include "planning/contingency.hpp"

#include <catch2/catch.hpp>
#include <vector>

#include "random.hpp"

namespace contingency_test {

using namespace reconnaissance;

namespace {

MissionSituation healthy() {
  return {.fuel_kg = 20,
          .fuel_for_mission_kg = 10,
          .fuel_home_kg = 4,
          .fuel_reserve_kg = 2,
          .missing = {}};
}

MissionSituation with(auto&& change) {
  MissionSituation situation = healthy();
  change(situation);
  return situation;
}

}  // namespace

TEST_CASE("the rules name the least severe mode that each fault allows, and its cause") {
  struct Row {
    MissionSituation situation;
    FlightMode mode;
    Cause cause;
  };
  const auto lost = [](const char* name, bool required, bool given_up) {
    return with([&](auto& s) { s.missing = {{name, required, given_up}}; });
  };
  for (const Row& row : std::vector<Row>{
           {healthy(), FlightMode::Mission, Cause::None},
           {with([](auto& s) { s.fuel_kg = 6; }), FlightMode::Mission, Cause::None},
           {with([](auto& s) { s.fuel_kg = 5.9; }), FlightMode::ReturnHome, Cause::FuelLow},
           {with([](auto& s) { s.fuel_kg = 3.9; }), FlightMode::Abort, Cause::FuelCritical},
           {with([](auto& s) { s.sensors_voted_in = 2; }), FlightMode::Degraded, Cause::SensorOut},
           {with([](auto& s) { s.sensors_voted_in = 1; }), FlightMode::ReturnHome,
            Cause::SensorsOut},
           {with([](auto& s) { s.sensors_voted_in = 0; }), FlightMode::Abort,
            Cause::NavigationLost},
           {with([](auto& s) { s.sensors = s.sensors_voted_in = 1; }), FlightMode::Mission,
            Cause::None},
           {lost("tracker", false, false), FlightMode::Degraded, Cause::EntityRestarts},
           {lost("tracker", false, true), FlightMode::Degraded, Cause::EntityLost},
           {lost("flight_controller", true, false), FlightMode::Degraded, Cause::EntityRestarts},
           {lost("flight_controller", true, true), FlightMode::Abort, Cause::EntityLost}}) {
    const ModeDecision decision = allowed_mode(row.situation);
    CAPTURE(static_cast<int>(row.mode), static_cast<int>(row.cause));
    CHECK(decision.mode == row.mode);
    CHECK(decision.cause == row.cause);
  }
  CHECK(allowed_mode(lost("flight_controller", true, true)).entity == "flight_controller");
}

TEST_CASE("of several faults the most severe decides: another fault never makes the mode milder") {
  Random random(70);
  for (int i = 0; i < 2000; ++i) {
    const auto chance = [&](MissionSituation& s) {
      switch (static_cast<int>(5 * random.uniform())) {
        case 0:
          s.fuel_kg *= 0.6;
          break;
        case 1:
          s.sensors_voted_in = std::max(0, s.sensors_voted_in - 1);
          break;
        case 2:
          s.missing.push_back({"one", random.happens(0.5), random.happens(0.5)});
          break;
        case 3:
          s.fuel_home_kg *= 1.5;
          break;
        default:
          s.fuel_reserve_kg *= 1.5;
      }
    };
    MissionSituation situation = healthy();
    FlightMode before = FlightMode::Mission;
    for (int faults = 0; faults < 5; ++faults) {
      chance(situation);
      const FlightMode mode = allowed_mode(situation).mode;
      REQUIRE(mode >= before);
      before = mode;
    }
  }
}

TEST_CASE("who flies home or aborts does not go back to the mission, but may become more severe") {
  RuleTableExecutive rules;
  UtilityExecutive utility;
  const auto both = [&](const MissionSituation& situation, FlightMode mode, Cause cause) {
    for (const ModeDecision& decision : {rules.decide(situation), utility.decide(situation)}) {
      CHECK(decision.mode == mode);
      CHECK(decision.cause == cause);
    }
  };
  both(healthy(), FlightMode::Mission, Cause::None);
  both(with([](auto& s) { s.fuel_kg = 5; }), FlightMode::ReturnHome, Cause::FuelLow);
  both(healthy(), FlightMode::ReturnHome, Cause::FuelLow);
  both(with([](auto& s) { s.sensors_voted_in = 0; }), FlightMode::Abort, Cause::NavigationLost);
  both(healthy(), FlightMode::Abort, Cause::NavigationLost);
}

TEST_CASE(
    "an abort for an entity that was lost is over when it is back, one for want of fuel is not") {
  const auto lost = [](MissionSituation& s) { s.missing = {{"navigator", true, true}}; };
  RuleTableExecutive rules;
  UtilityExecutive utility;
  const auto both = [&](const MissionSituation& situation, FlightMode mode) {
    CHECK(rules.decide(situation).mode == mode);
    CHECK(utility.decide(situation).mode == mode);
  };
  both(with(lost), FlightMode::Abort);
  both(healthy(), FlightMode::Mission);
  both(with([](auto& s) { s.fuel_kg = 5; }), FlightMode::ReturnHome);
  both(with(lost), FlightMode::Abort);
  both(healthy(), FlightMode::ReturnHome);
}

TEST_CASE("an entity that restarts degrades the mission until it is back") {
  RuleTableExecutive rules;
  const MissionSituation missing = with([](auto& s) { s.missing = {{"navigator", true, false}}; });
  CHECK(rules.decide(missing).mode == FlightMode::Degraded);
  CHECK(rules.decide(healthy()).mode == FlightMode::Mission);
}

TEST_CASE("utilities are expected values: those of the normal distribution's table") {
  // Fuel for the way home within 1.645 deviations: it does not suffice in 5 % of all cases.
  MissionSituation s = healthy();
  s.fuel_kg = s.fuel_home_kg * (1 + 0.1 * 1.645);
  CHECK(UtilityExecutive::utility_of_return(s) == Approx(-5 * 0.05).epsilon(1e-3));
  s.fuel_kg = s.fuel_for_mission_kg;
  CHECK(UtilityExecutive::utility_of_mission(s) == Approx(0.5 - 0.5 * 5));
  s = healthy();
  s.missing = {{"one", false, false}, {"another", false, false}};
  s.sensors_voted_in = 1;
  CHECK(UtilityExecutive::utility_of_mission(s) ==
        Approx(std::exp(-0.05) - (1 - std::exp(-0.05)) * 5).epsilon(1e-6));
}

TEST_CASE(
    "by utility the flight returns before a rule demands it, where the mission is not worth its "
    "risk") {
  struct Row {
    MissionSituation situation;
    FlightMode mode;
  };
  for (const Row& row : std::vector<Row>{
           {healthy(), FlightMode::Mission},
           // Fuel that suffices for the plan by half a deviation: three in ten run dry.
           {with([](auto& s) { s.fuel_for_mission_kg = 19; }), FlightMode::ReturnHome},
           {with([](auto& s) { s.fuel_for_mission_kg = 15; }), FlightMode::Mission}}) {
    CHECK(UtilityExecutive().decide(row.situation).mode == row.mode);
    CHECK(RuleTableExecutive().decide(row.situation).mode == FlightMode::Mission);
  }
  const auto early = with([](auto& s) { s.fuel_for_mission_kg = 19; });
  CHECK(UtilityExecutive().decide(early).cause == Cause::Forecast);
}

TEST_CASE("by utility no mode is chosen that the rules do not allow") {
  Random random(71);
  for (int i = 0; i < 5000; ++i) {
    MissionSituation s = healthy();
    s.fuel_kg = 25 * random.uniform();
    s.fuel_for_mission_kg = 20 * random.uniform();
    s.sensors_voted_in = static_cast<int>(4 * random.uniform());
    if (random.happens(0.3)) s.missing = {{"one", random.happens(0.5), random.happens(0.5)}};
    const ModeDecision chosen = UtilityExecutive().decide(s);
    const ModeDecision allowed = allowed_mode(s);
    REQUIRE(chosen.mode >= allowed.mode);
    if (chosen.mode > allowed.mode) REQUIRE(chosen.mode == FlightMode::ReturnHome);
  }
}

}  // namespace contingency_test
