#include "planning/threat_discs.hpp"

#include <catch2/catch.hpp>
#include <cmath>

namespace threat_discs_test {

using namespace reconnaissance;

namespace {

const std::vector<ThreatDisc> kOne{{0, 5000, 3000, 0.02}};
const CruiseFigures kCruise;

}  // namespace

TEST_CASE("the hazard of a flight is the rate times the seconds that it is within reach") {
  // Through the middle: 6 km; aside by 2400 m: 3.6 km; beside it: nothing.
  CHECK(hazard_of_leg({0, 0, 0}, {0, 10000, 0}, kOne, 60) == Approx(0.02 * 100));
  CHECK(hazard_of_leg({2400, 0, 0}, {2400, 10000, 0}, kOne, 60) == Approx(0.02 * 60));
  CHECK(hazard_of_leg({3001, 0, 0}, {3001, 10000, 0}, kOne, 60) == 0);
  // Which ends in it, or is over before it.
  CHECK(hazard_of_leg({0, 0, 0}, {0, 5000, 0}, kOne, 60) == Approx(0.02 * 50));
  CHECK(hazard_of_leg({0, 0, 0}, {0, 1999, 0}, kOne, 60) == 0);
  CHECK(hazard_of_way({{0, 0, 0}, {0, 5000, 0}, {0, 10000, 0}}, kOne, 60) == Approx(2));
}

TEST_CASE("a leg that a disc bars is longer, and without hazard; into a disc no way leads around") {
  const RoutePose from{0, 0, M_PI / 2}, beyond{0, 10000, M_PI / 2}, within{0, 4000, M_PI / 2};
  const FlightCost free = cost_of_leg(from, beyond, {}, kCruise);
  const FlightCost barred = cost_of_leg(from, beyond, kOne, kCruise);
  CHECK(free.seconds == Approx(10000.0 / 60));
  CHECK(barred.seconds == Approx(16000.0 / 60));
  CHECK(barred.hazard == 0);
  CHECK(barred.fuel_kg > free.fuel_kg);
  CHECK(cost_of_leg(from, within, kOne, kCruise).hazard == Approx(0.02 * 2000 / 60));
}

TEST_CASE("the nearest way out of reach leads away from the site, and out of all") {
  const Local outside{0, 9000, 700};
  CHECK_FALSE(is_within(outside, kOne));
  CHECK(out_of_reach(outside, kOne).east_m == 9000);
  CHECK(is_within({0, 6000, 700}, kOne));
  const Local out = out_of_reach({0, 6000, 700}, kOne);
  CHECK(out.north_m == Approx(0).margin(1e-6));
  CHECK(out.east_m == Approx(8001));
  CHECK(out.height_m == 700);
  CHECK(hazard_of_leg(out_of_reach({0, 5000, 700}, kOne), {20000, 5000, 0}, kOne, 60) ==
        Approx(0).margin(1e-3));
  const std::vector<ThreatDisc> two{{0, 5000, 3000, 0.02}, {2000, 9000, 3000, 0.02}};
  for (const Local inside : {Local{500, 7000, 0}, Local{1500, 7000, 0}, Local{0, 7800, 0}}) {
    CHECK(is_within(inside, two));
    CHECK_FALSE(is_within(out_of_reach(inside, two), two));
  }
}

TEST_CASE("a road is flown along from its middle to where a weapon reaches") {
  const auto part = part_out_of_reach({{0, -9000, 0}, {0, 6000, 0}}, kOne);
  CHECK(part.front().east_m == -9000);
  CHECK(part.back().east_m <= 2000);
  CHECK(part.back().east_m > 1800);
  // Not where that leaves no road.
  CHECK(part_out_of_reach({{0, 3000, 0}, {0, 9000, 0}}, kOne).size() == 2);
  CHECK(part_out_of_reach({{0, 9000, 0}}, kOne).size() == 1);
}

TEST_CASE("an emitter is passed as far aside as ordered, or out of reach of what covers it") {
  CHECK(aside_m({0, 5000, 0}, 6500, {}) == 6500);
  CHECK(aside_m({0, 9000, 0}, 500, kOne) == 500);  // a weapon that does not reach there
  CHECK(aside_m({0, 5000, 0}, 6500, kOne) == 6500);
  // Its own weapon, and that of another one that it stands beside.
  CHECK(aside_m({0, 5000, 0}, 500, kOne) > 3000);
  CHECK(aside_m({0, 7000, 0}, 500, kOne) > 5000);
  // Whatever the course.
  for (const Local place : {Local{0, 5000, 0}, Local{0, 7000, 0}}) {
    PassRules rules;
    rules.aside_m = aside_m(place, 500, kOne);
    const auto passes = passes_by({place}, kOne, kCruise, rules);
    CHECK(passes.size() == 8);
    for (const CollectionPass& pass : passes) CHECK(pass.cost.hazard == 0);
  }
}

TEST_CASE("an element is passed straight, as far aside as the camera wants, long enough for it") {
  const auto past_point = passes_by({{1000, 2000, 0}}, {}, kCruise);
  CHECK(past_point.size() == 8);
  const auto along_road = passes_by({{0, 0, 0}, {0, 3000, 0}}, {}, kCruise);
  CHECK(along_road.size() == 4);
  for (const CollectionPass& pass : past_point) {
    const double north = pass.end.north_m - pass.begin.north_m;
    const double east = pass.end.east_m - pass.begin.east_m;
    CHECK(std::hypot(north, east) == Approx(3800));
    CHECK(std::remainder(std::atan2(east, north) - pass.begin.course_rad, 2 * M_PI) ==
          Approx(0).margin(1e-9));
    const double aside = ((2000 - pass.begin.east_m) * north - (1000 - pass.begin.north_m) * east) /
                         std::hypot(north, east);
    CHECK(std::abs(aside) == Approx(700));
    CHECK(pass.cost.seconds == Approx(3800.0 / 60));
  }
  for (const CollectionPass& pass : along_road) {
    CHECK(std::abs(pass.begin.north_m) == Approx(700));
    CHECK(std::abs(pass.end.east_m - pass.begin.east_m) == Approx(6800));
  }
  // Past an element within reach of a weapon each pass has a hazard.
  for (const CollectionPass& pass : passes_by({{0, 5000, 0}}, kOne, kCruise))
    CHECK(pass.cost.hazard > 0.5);
}

}  // namespace threat_discs_test
