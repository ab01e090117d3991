#include "planning/contingency.hpp"

#include <catch2/catch.hpp>
#include <vector>

#include "random.hpp"

namespace contingency_test {

using namespace reconnaissance;

namespace {

MissionSituation healthy() {
  return {.link = Link::Connected,
          .fuel_kg = 20,
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

TEST_CASE(
    "a link is degraded after 10 s of silence, lost after 30 s, and found after 3 s without a "
    "gap") {
  struct Event {
    double at_s;
    bool heard;
    Link state;
  };
  LinkWatch watch(0);
  for (const Event& event : std::vector<Event>{{0, true, Link::Connected},
                                               {9.9, false, Link::Connected},
                                               {10, false, Link::Degraded},
                                               {12, true, Link::Connected},
                                               {22, false, Link::Degraded},
                                               {41.9, false, Link::Degraded},
                                               {42, false, Link::Lost},
                                               {50, true, Link::Lost},
                                               {51, true, Link::Lost},
                                               {52.9, true, Link::Lost},
                                               {53, true, Link::Connected},
                                               {62.9, false, Link::Connected},
                                               {63, false, Link::Degraded}}) {
    CAPTURE(event.at_s);
    if (event.heard) watch.heard(event.at_s);
    CHECK(watch.state(event.at_s) == event.state);
  }
}

TEST_CASE("a link that was lost without anybody looking has been lost all the same") {
  LinkWatch watch(0);
  watch.heard(40);
  CHECK(watch.state(40) == Link::Lost);
}

TEST_CASE("single messages do not end the loss of a link") {
  LinkWatch watch(0);
  for (double now_s = 35; now_s < 120; now_s += 2.5) {
    watch.heard(now_s);
    CHECK(watch.state(now_s) == Link::Lost);
  }
}

TEST_CASE("of orders that waited in a lost link none is executed after its lifespan, or twice") {
  struct Event {
    GroundOrderStamp order;
    double at_s;
    OrderVerdict verdict;
  };
  OrderGate gate;
  for (const Event& event :
       std::vector<Event>{{{1, 10, 5}, 10.2, OrderVerdict::Execute},
                          {{1, 10, 5}, 10.4, OrderVerdict::Repeated},
                          // Sent while the link was lost; delivered together when it is found.
                          {{2, 20, 5}, 70, OrderVerdict::Expired},
                          {{3, 40, 5}, 70, OrderVerdict::Expired},
                          {{4, 66, 5}, 70, OrderVerdict::Execute},
                          {{3, 69, 5}, 70, OrderVerdict::Repeated},
                          {{5, 75, 5}, 80, OrderVerdict::Execute},
                          {{6, 75, 5}, 80.01, OrderVerdict::Expired},
                          {{7, 90, 5}, 88.9, OrderVerdict::NotYetIssued},
                          {{7, 90, 5}, 89.1, OrderVerdict::Execute}}) {
    CAPTURE(event.order.sequence, event.at_s);
    CHECK(gate.judge(event.order, event.at_s) == event.verdict);
  }
}

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
           {with([](auto& s) { s.link = Link::Degraded; }), FlightMode::Degraded,
            Cause::LinkDegraded},
           {with([](auto& s) { s.link = Link::Lost; }), FlightMode::ContingencyRoute,
            Cause::LinkLost},
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
      switch (static_cast<int>(6 * random.uniform())) {
        case 0:
          s.link = s.link == Link::Connected ? Link::Degraded : Link::Lost;
          break;
        case 1:
          s.fuel_kg *= 0.6;
          break;
        case 2:
          s.sensors_voted_in = std::max(0, s.sensors_voted_in - 1);
          break;
        case 3:
          s.missing.push_back({"one", random.happens(0.5), random.happens(0.5)});
          break;
        case 4:
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

TEST_CASE(
    "a lost link makes the contingency route fly, and the mission resumes once when it is found") {
  for (const bool by_rules : {true, false}) {
    RuleTableExecutive rules;
    UtilityExecutive utility;
    LinkWatch watch(0);
    struct Change {
      double at_s;
      FlightMode mode;
      bool resumes;
    };
    std::vector<Change> changes;
    FlightMode before = FlightMode::Mission;
    for (int now_s = 0; now_s <= 100; ++now_s) {
      if (now_s <= 20 || now_s >= 70) watch.heard(now_s);
      const MissionSituation situation = with([&](auto& s) { s.link = watch.state(now_s); });
      const ModeDecision decision = by_rules ? rules.decide(situation) : utility.decide(situation);
      if (decision.mode != before || decision.resumes) {
        changes.push_back({static_cast<double>(now_s), decision.mode, decision.resumes});
      }
      before = decision.mode;
    }
    REQUIRE(changes.size() == 3);
    CHECK(changes[0].at_s == 30);
    CHECK(changes[0].mode == FlightMode::Degraded);
    CHECK(changes[1].at_s == 50);
    CHECK(changes[1].mode == FlightMode::ContingencyRoute);
    CHECK(changes[2].at_s == 73);
    CHECK(changes[2].mode == FlightMode::Mission);
    CHECK(changes[2].resumes);
  }
}

TEST_CASE("who flies home or aborts does not go back to the mission, but may become more severe") {
  RuleTableExecutive rules;
  UtilityExecutive utility;
  const auto both = [&](const MissionSituation& situation, FlightMode mode, Cause cause) {
    for (const ModeDecision& decision : {rules.decide(situation), utility.decide(situation)}) {
      CHECK(decision.mode == mode);
      CHECK(decision.cause == cause);
      CHECK(!decision.resumes);
    }
  };
  both(healthy(), FlightMode::Mission, Cause::None);
  both(with([](auto& s) { s.fuel_kg = 5; }), FlightMode::ReturnHome, Cause::FuelLow);
  both(healthy(), FlightMode::ReturnHome, Cause::FuelLow);
  both(with([](auto& s) { s.link = Link::Lost; }), FlightMode::ReturnHome, Cause::FuelLow);
  both(with([](auto& s) { s.sensors_voted_in = 0; }), FlightMode::Abort, Cause::NavigationLost);
  both(healthy(), FlightMode::Abort, Cause::NavigationLost);
}

TEST_CASE("an entity that restarts degrades the mission until it is back") {
  RuleTableExecutive rules;
  const MissionSituation missing = with([](auto& s) { s.missing = {{"navigator", true, false}}; });
  CHECK(rules.decide(missing).mode == FlightMode::Degraded);
  CHECK(rules.decide(healthy()).mode == FlightMode::Mission);
  CHECK(!rules.decide(healthy()).resumes);
}

TEST_CASE("utilities are expected values: those of the normal distribution's table") {
  // Fuel for the way home within 1.645 deviations: it does not suffice in 5 % of all cases.
  const UtilityExecutive executive;
  MissionSituation s = healthy();
  s.fuel_kg = s.fuel_home_kg * (1 + 0.1 * 1.645);
  CHECK(executive.utility_of_return(s) == Approx(-5 * 0.05).epsilon(1e-3));
  s.fuel_kg = s.fuel_for_mission_kg;
  s.value_left = 0.8;
  CHECK(executive.utility_of_mission(s) == Approx(0.5 * 0.8 - 0.5 * 5));
  s = healthy();
  s.hazard_left = 0.05;
  s.value_left = 1;
  CHECK(executive.utility_of_mission(s) ==
        Approx(std::exp(-0.05) - (1 - std::exp(-0.05)) * 5).epsilon(1e-6));
}

TEST_CASE(
    "by utility the flight returns before a rule demands it, where the rest is not worth its "
    "risk") {
  struct Row {
    MissionSituation situation;
    FlightMode mode;
  };
  for (const Row& row : std::vector<Row>{
           {healthy(), FlightMode::Mission},
           // Fuel that suffices for the plan by half a deviation: three in ten run dry.
           {with([](auto& s) { s.fuel_for_mission_kg = 19; }), FlightMode::ReturnHome},
           {with([](auto& s) { s.fuel_for_mission_kg = 15; }), FlightMode::Mission},
           // The last small target beside a radar, and the first large one.
           {with([](auto& s) { s.value_left = 0.1, s.hazard_left = 0.05; }),
            FlightMode::ReturnHome},
           {with([](auto& s) { s.value_left = 0.9, s.hazard_left = 0.05; }), FlightMode::Mission},
           // To return is better, but by less than forecasts are worth.
           {with([](auto& s) { s.value_left = 0.1, s.hazard_left = 0.025; }), FlightMode::Mission},
           // Nothing is left to collect, nor to risk.
           {with([](auto& s) { s.value_left = 0; }), FlightMode::Mission}}) {
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
    s.link = static_cast<Link>(static_cast<int>(3 * random.uniform()));
    s.fuel_kg = 25 * random.uniform();
    s.fuel_for_mission_kg = 20 * random.uniform();
    s.sensors_voted_in = static_cast<int>(4 * random.uniform());
    s.value_left = random.uniform();
    s.hazard_left = 0.2 * random.uniform();
    if (random.happens(0.3)) s.missing = {{"one", random.happens(0.5), random.happens(0.5)}};
    const ModeDecision chosen = UtilityExecutive().decide(s);
    const ModeDecision allowed = allowed_mode(s);
    REQUIRE(chosen.mode >= allowed.mode);
    if (chosen.mode > allowed.mode) REQUIRE(chosen.mode == FlightMode::ReturnHome);
  }
}

}  // namespace contingency_test
