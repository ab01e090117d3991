// The course of a mission, its verdict, and how a profile names places.
#include <catch2/catch.hpp>
#include <cmath>

#include "flight/angles.hpp"
#include "mission/conduct.hpp"
#include "mission/places.hpp"
#include "mission/verdict.hpp"
#include "skein/error.hpp"

namespace mission_logic_test {

using namespace reconnaissance;
using Catch::Contains;

namespace {

const Strip kStrip{{0, 0, 180}, radians(90), 1500};

Conduct::Situation flying(std::size_t leg, std::size_t legs, std::size_t reached) {
  return {true, Pilot::Mode::Following, 900, leg, legs, reached};
}

const std::vector<WayPoint> kTour{
    {{5000, 0, 900}, false}, {{9000, 0, 900}, true}, {{9000, 4000, 900}, false}};

/// A flight 20 km north and back, on which one element of one is collected.
struct Flown {
  explicit Flown(const PassConditions& conditions = {}) : judge(conditions, {0, 150, 180}) {
    judge.count(1, 1);
  }

  void fly(double lowest_m = 500, double touched_m = 200) {
    see(0, {0, 0, 180}, 0, 0, true);
    see(30, {0, 500, 190}, 10, 60, false);
    for (double north = 0; north <= 20'000; north += 1000)
      see(time_s + 10, {north, 0, 0}, north > 9000 ? lowest_m : 500, 60, false);
    for (double north = 20'000; north >= 0; north -= 1000)
      see(time_s + 10, {north, 0, 0}, 500, 60, false);
    see(time_s + 30, {0, 150 + touched_m, 180}, 0, 40, true);
    see(time_s + 15, {0, 700, 180}, 0, 0.1, true);
  }

  void see(double at_s, const Local& position, double height_m, double speed, bool on_ground) {
    time_s = at_s;
    judge.see({time_s, position, height_m, speed, 40, on_ground, false});
  }

  Judge judge;
  double time_s = 0;
};

}  // namespace

TEST_CASE("a mission goes through its phases, each begun by what has been reached") {
  Conduct conduct(kStrip);
  CHECK_FALSE(conduct.fly(kTour, "planned"));
  CHECK_FALSE(conduct.decide({}));
  CHECK(conduct.phase() == MissionPhase::BuiltInTest);
  CHECK(std::holds_alternative<Conduct::TakeOff>(*conduct.decide({.all_fine = true})));
  CHECK(conduct.phase() == MissionPhase::TakeOff);
  CHECK_FALSE(conduct.decide({true, Pilot::Mode::TakingOff, 200}));
  auto order = conduct.decide({true, Pilot::Mode::TakingOff, 340});
  REQUIRE(order);
  CHECK(std::get<Conduct::Follow>(*order).through.size() == 3);
  CHECK(conduct.phase() == MissionPhase::Ingress);
  CHECK(conduct.reason() == "planned");
  CHECK_FALSE(conduct.decide(flying(0, 0, 0)));  // it is not flown yet
  CHECK_FALSE(conduct.decide(flying(2, 5, 0)));
  CHECK(conduct.phase() == MissionPhase::Ingress);
  CHECK_FALSE(conduct.decide(flying(3, 5, 1)));
  CHECK(conduct.phase() == MissionPhase::Collection);
  CHECK(conduct.points_reached() == 1);
  CHECK_FALSE(conduct.decide(flying(4, 5, 2)));
  CHECK(conduct.points_reached() == 2);
  order = conduct.decide(flying(5, 5, 3));
  REQUIRE(order);
  CHECK(conduct.points_reached() == 3);
  CHECK(conduct.phase() == MissionPhase::Egress);
  CHECK(std::get<Conduct::Land>(*order).through.size() == 3);
  CHECK_FALSE(conduct.decide({true, Pilot::Mode::Approaching, 400, 1, 3}));
  CHECK(conduct.phase() == MissionPhase::Egress);
  CHECK_FALSE(conduct.decide({true, Pilot::Mode::Approaching, 400, 2, 3}));
  CHECK(conduct.phase() == MissionPhase::Landing);
  CHECK_FALSE(conduct.decide({true, Pilot::Mode::Rolling, 180, 3, 3}));
  CHECK_FALSE(conduct.decide({true, Pilot::Mode::Landed, 180, 3, 3}));
  CHECK(conduct.phase() == MissionPhase::Complete);
}

TEST_CASE("a target that is found is circled in place of the tour, and the mission goes on after") {
  Conduct conduct(kStrip);
  const Circle circle{{9000, 0, 900}, 1200, true};
  conduct.fly(kTour, "planned");
  CHECK_FALSE(conduct.loiter(circle, "found"));  // before the take-off nothing is
  conduct.decide({.all_fine = true});
  conduct.decide({true, Pilot::Mode::TakingOff, 340});
  REQUIRE(conduct.phase() == MissionPhase::Ingress);
  const auto order = conduct.loiter(circle, "found");
  REQUIRE(order);
  CHECK(std::get<Conduct::Loiter>(*order).circle.radius_m == 1200);
  CHECK(conduct.phase() == MissionPhase::Collection);
  CHECK(conduct.reason() == "found");
  CHECK_FALSE(conduct.decide({true, Pilot::Mode::Waiting, 900}));  // as long as it is not told
  const auto home = conduct.fly({}, "followed: home");
  REQUIRE(home);
  CHECK(std::holds_alternative<Conduct::Land>(*home));
  conduct.go_home_for_good("no fuel");
  CHECK_FALSE(conduct.loiter(circle, "found"));
}

TEST_CASE("another tour is flown at once where one is under way, and none leads home") {
  Conduct conduct(kStrip);
  conduct.fly(kTour, "planned");
  conduct.decide({.all_fine = true});
  CHECK_FALSE(conduct.go_home_another_way("threat"));
  conduct.decide({true, Pilot::Mode::TakingOff, 340});
  conduct.decide(flying(1, 3, 1));
  auto order = conduct.fly({kTour[2]}, "a threat is new");
  REQUIRE(order);
  CHECK(std::get<Conduct::Follow>(*order).through.size() == 1);
  CHECK(conduct.reason() == "a threat is new");
  CHECK(conduct.phase() == MissionPhase::Ingress);
  order = conduct.fly({}, "nothing can be collected");
  REQUIRE(order);
  CHECK(std::holds_alternative<Conduct::Land>(*order));
  order = conduct.go_home_another_way("a threat is on the way");
  REQUIRE(order);
  CHECK(std::holds_alternative<Conduct::Land>(*order));
  CHECK(conduct.may_try_again());
  CHECK(conduct.fly(kTour, "another one is found"));
  conduct.give_up("no fuel");
  CHECK_FALSE(conduct.fly(kTour, "too late"));
}

TEST_CASE("a tour that is given up leads home, one that is not under way does not") {
  Conduct conduct(kStrip);
  conduct.fly(kTour, "planned");
  conduct.decide({.all_fine = true});
  CHECK_FALSE(conduct.give_up("no fuel"));
  conduct.decide({true, Pilot::Mode::TakingOff, 340});
  const auto order = conduct.give_up("no fuel");
  REQUIRE(order);
  CHECK(std::holds_alternative<Conduct::Land>(*order));
  CHECK(conduct.reason() == "no fuel");
  CHECK_FALSE(conduct.give_up("no fuel"));
}

TEST_CASE("what is given up before the take-off does not begin") {
  Conduct conduct(kStrip);
  conduct.fly(kTour, "planned");
  CHECK_FALSE(conduct.give_up("no fuel"));
  CHECK(conduct.phase() == MissionPhase::Aborted);
  CHECK(conduct.reason() == "no fuel");
  CHECK_FALSE(conduct.decide({.all_fine = true}));
}

TEST_CASE("where a route is refused the mission goes home, and says why") {
  Conduct conduct(kStrip);
  conduct.fly(kTour, "planned");
  conduct.decide({.all_fine = true});
  conduct.decide({true, Pilot::Mode::TakingOff, 340});
  const auto order = conduct.refused("no route to the point");
  REQUIRE(order);
  CHECK(std::holds_alternative<Conduct::Land>(*order));
  CHECK(conduct.reason() == "no route to the point");
  CHECK_FALSE(conduct.refused("no route home"));
  CHECK(conduct.phase() == MissionPhase::Aborted);
}

TEST_CASE("a mission that a refused route has sent home goes on when another tour is found") {
  Conduct conduct(kStrip);
  conduct.fly(kTour, "planned");
  conduct.decide({.all_fine = true});
  conduct.decide({true, Pilot::Mode::TakingOff, 340});
  CHECK_FALSE(conduct.may_try_again());
  conduct.refused("no route to the point");
  CHECK(conduct.may_try_again());
  CHECK_FALSE(conduct.fly({}, "there is none: home"));
  CHECK(conduct.reason() == "no route to the point");
  CHECK(conduct.go_home_another_way("a threat is on the way"));
  CHECK(conduct.may_try_again());
  const auto order = conduct.fly(kTour, "tried again");
  REQUIRE(order);
  CHECK(std::get<Conduct::Follow>(*order).through.size() == 3);
  CHECK(conduct.phase() == MissionPhase::Ingress);
  CHECK(conduct.reason() == "tried again");
  conduct.give_up("no fuel");
  CHECK_FALSE(conduct.may_try_again());
}

TEST_CASE("a mission that its executive has called back may go on, but not from the ground") {
  Conduct conduct(kStrip);
  conduct.fly(kTour, "planned");
  conduct.decide({.all_fine = true});
  CHECK_FALSE(conduct.call_back("the navigator is lost"));
  CHECK(conduct.phase() == MissionPhase::TakeOff);
  conduct.decide({true, Pilot::Mode::TakingOff, 340});
  REQUIRE(conduct.call_back("the navigator is lost"));
  CHECK(conduct.phase() == MissionPhase::Egress);
  CHECK(conduct.reason() == "the navigator is lost");
  CHECK(conduct.may_try_again());
  CHECK(conduct.fly(kTour, "the navigator is back"));
  CHECK(conduct.phase() == MissionPhase::Ingress);
}

TEST_CASE("a mission that was sent home waits for another tour, until there is no time for it") {
  Conduct conduct(kStrip);
  const Circle circle{{0, 0, 900}, 2500, true};
  conduct.fly(kTour, "planned");
  conduct.decide({.all_fine = true});
  conduct.decide({true, Pilot::Mode::TakingOff, 340});
  CHECK_FALSE(conduct.wait(circle, "waits"));
  conduct.refused("no route to the point");
  const auto order = conduct.wait(circle, "waits");
  REQUIRE(order);
  CHECK(std::get<Conduct::Loiter>(*order).circle.radius_m == 2500);
  CHECK(conduct.phase() == MissionPhase::Egress);
  CHECK(conduct.reason() == "waits");
  CHECK_FALSE(conduct.decide({true, Pilot::Mode::Waiting, 900}));
  SECTION("a tour") {
    CHECK(conduct.fly(kTour, "a tour may be left here"));
    CHECK_FALSE(conduct.wait(circle, "waits"));
  }
  SECTION("a target that was found late") {
    CHECK(conduct.loiter(circle, "found"));
    CHECK(conduct.phase() == MissionPhase::Collection);
  }
  SECTION("the end") {
    CHECK(std::holds_alternative<Conduct::Land>(*conduct.go_home_for_good("it is late")));
    CHECK_FALSE(conduct.wait(circle, "waits"));
    CHECK_FALSE(conduct.fly(kTour, "too late"));
  }
}

TEST_CASE("the way down leads along the centre line to the aiming point") {
  const auto way = approach(kStrip, {});
  REQUIRE(way.size() == 3);
  for (const WayPoint& point : way) CHECK(point.place.north_m == Approx(0).margin(1e-6));
  CHECK_FALSE(way[0].straight);
  CHECK((way[1].straight && way[2].straight));
  CHECK(way[1].place.east_m == Approx(-4000));
  CHECK(way[1].place.height_m - 180 == Approx(4150 * std::tan(radians(4))).epsilon(1e-3));
  CHECK(way[2].place.east_m == Approx(150));
  CHECK(way[2].place.height_m == 180);
}

TEST_CASE("a flight that keeps all conditions passes") {
  Flown flown;
  flown.fly();
  CHECK(flown.judge.standing());
  const Verdict verdict = flown.judge.conclude();
  INFO(verdict.reason);
  CHECK(verdict.flown);
  CHECK(verdict.passed);
  CHECK(verdict.reason.empty());
  CHECK(exit_code(verdict) == 0);
}

TEST_CASE("each condition that is not kept fails the flight, and is named") {
  const auto reason_of = [](const auto& fly, const PassConditions& conditions = {}) {
    Flown flown(conditions);
    fly(flown);
    const Verdict verdict = flown.judge.conclude();
    CHECK(verdict.flown);
    CHECK_FALSE(verdict.passed);
    CHECK(exit_code(verdict) == 10);
    return verdict.reason;
  };
  CHECK_THAT(reason_of([](Flown& f) { f.fly(50); }), Contains("clearance: 50 m"));
  CHECK_THAT(reason_of([](Flown& f) {
               f.fly();
               f.judge.count(1, 2);
               f.judge.flies_home("a threat bars the way");
             }),
             Contains("targets: 1 of 2 elements collected as finely as they were ordered; it flew "
                      "home: a threat bars the way"));
  CHECK_THAT(reason_of([](Flown& f) {
               f.fly();
               f.judge.suffer(0.9, 12);
             }),
             Contains("survival: survived the air defence with a probability of 0.900"));
  CHECK_THAT(reason_of([](Flown& f) {
               f.see(30, {0, 500, 500}, 320, 60, false);
               f.judge.meet({0, 1100, 600});
               f.fly();
             }),
             Contains("well clear: 600 m beside and 100 m above or below"));
  CHECK_THAT(reason_of([](Flown& f) { f.fly(500, 900); }), Contains("landing: touched down 900"));
  CHECK_THAT(reason_of([](Flown& f) { f.fly(); }, {.longest_s = 100}), Contains("duration"));
  CHECK_THAT(reason_of([](Flown& f) { f.fly(); }, {.least_fuel_kg = 50}),
             Contains("fuel: 40.0 kg"));
}

TEST_CASE("what was not flown to its end is told as such") {
  Flown flown;
  flown.see(0, {0, 0, 180}, 0, 0, true);
  const Verdict verdict = flown.judge.conclude("the mission's time stands still");
  CHECK_FALSE(verdict.flown);
  CHECK_FALSE(verdict.passed);
  CHECK(exit_code(verdict) == 11);
  CHECK_THAT(verdict.reason, Contains("the mission's time stands still"));
}

TEST_CASE("the verdict is JUnit's XML, whatever its texts hold") {
  Verdict verdict;
  verdict.checks = {{"one", true, "fine"}, {"two", false, "a < \"b\" & c"}};
  const std::string junit = to_junit(verdict, "m & n");
  CHECK_THAT(junit, Contains("tests=\"2\" failures=\"1\""));
  CHECK_THAT(junit, Contains("name=\"m &amp; n\""));
  CHECK_THAT(junit, Contains("<failure message=\"a &lt; &quot;b&quot; &amp; c\"/>"));
}

TEST_CASE("places are read from a profile, and what is no place is refused") {
  const auto runway = parse_runway("53.3 27.6 180 450 1500");
  CHECK(runway.threshold.latitude_deg == 53.3);
  CHECK(runway.course_rad == Approx(radians(90)));
  const auto sites = parse_sites("short-range site 53.4 27.5 0; coast radar 53.5 -27.7 420;");
  REQUIRE(sites.size() == 2);
  CHECK(sites[0].type == "short-range site");
  CHECK(sites[1].type == "coast radar");
  CHECK(sites[1].place.longitude_deg == -27.7);
  CHECK(sites[1].active_from_s == 420);
  CHECK(std::isinf(sites[1].silent_beyond_m));
  const auto waiting = parse_sites("mobile gun 53.4 27.5 0 9000; coast radar 53.5 27.7 420");
  REQUIRE(waiting.size() == 2);
  CHECK(waiting[0].type == "mobile gun");
  CHECK(waiting[0].silent_beyond_m == 9000);
  CHECK(std::isinf(waiting[1].silent_beyond_m));
  CHECK_THROWS_AS(parse_sites("mobile gun 53.4 27.5 0 0"), skein::InvalidArgument);
  CHECK_THROWS_AS(parse_sites("mobile gun 53.4 27.5 0 9000 1"), skein::InvalidArgument);
  CHECK_THROWS_AS(parse_sites("coast radar 53.5 27.7"), skein::InvalidArgument);
  CHECK_THROWS_AS(parse_sites("coast radar 53.5 27.7 0 1e999"), skein::InvalidArgument);
  CHECK_THROWS_AS(parse_sites("coast radar 53.5 27.7 never"), skein::InvalidArgument);
  const auto intruders = parse_intruders("300 90 9000 70");
  REQUIRE(intruders.size() == 1);
  CHECK(intruders[0].direction_rad == Approx(radians(90)));
  CHECK_THROWS_AS(parse_intruders("300 90 9000"), skein::InvalidArgument);
  const auto planners = parse_planner_failures("4 killed; 7 stopped");
  REQUIRE(planners.size() == 2);
  CHECK(planners[0].request == 4);
  CHECK_FALSE(planners[0].stopped);
  CHECK(planners[1].stopped);
  CHECK_THROWS_AS(parse_planner_failures("0 killed"), skein::InvalidArgument);
  CHECK_THROWS_AS(parse_planner_failures("-4 killed"), skein::InvalidArgument);
  CHECK_THROWS_AS(parse_planner_failures("4 killed, 7 stopped"), skein::InvalidArgument);
  CHECK_THROWS_AS(parse_planner_failures("4 bored"), skein::InvalidArgument);
  const auto failures = parse_failures("2 wrong 200 400; 3 intermittent 10 20");
  REQUIRE(failures.size() == 2);
  CHECK(failures[0].set == 1);
  CHECK(failures[0].kind == SensorFailure::Wrong);
  CHECK(failures[1].kind == SensorFailure::Intermittent);
  CHECK_THROWS_AS(parse_failures("4 wrong 200 400"), skein::InvalidArgument);
  CHECK_THROWS_AS(parse_failures("2 lazy 200 400"), skein::InvalidArgument);
  CHECK_THROWS_AS(parse_failures("2 wrong 200 400, 1 off 500 600"), skein::InvalidArgument);
  CHECK_THROWS_AS(parse_failures("2 wrong 400 200"), skein::InvalidArgument);
  CHECK_THROWS_AS(parse_failures("2 wrong 400 1e999"), skein::InvalidArgument);
  CHECK(parse_names("a, b ,c") == std::vector<std::string>{"a", "b", "c"});
  CHECK_THROWS_AS(parse_runway("53.3 27.6 180 90"), skein::InvalidArgument);
  CHECK_THROWS_AS(parse_sites("coast radar 93.5 27.7 0"), skein::InvalidArgument);
}

TEST_CASE("what is judged of targets stands among the conditions, and fails the mission") {
  Flown flown;
  flown.judge.count(1, 1, "followed as long as was ordered");
  flown.fly();
  CHECK(flown.judge.conclude("", {{"found", true, "after 400 s"}}).passed);
  const Verdict failed = flown.judge.conclude("", {{"found", false, "the target was never found"}});
  CHECK_FALSE(failed.passed);
  CHECK(failed.reason == "found: the target was never found");
  CHECK(failed.checks[2].text == "1 of 1 elements followed as long as was ordered");
  CHECK(failed.checks[3].name == "found");
}

}  // namespace mission_logic_test
