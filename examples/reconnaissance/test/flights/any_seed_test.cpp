// All missions with many seeds, each flight in this process.
#include <algorithm>
#include <catch2/catch.hpp>
#include <string>
#include <utility>

#include "flight_in_process.hpp"

using namespace reconnaissance;

namespace {

Outcome fly_seed(const std::string& mission, int seed) {
  return fly(mission, {{"seed", std::to_string(seed)}});
}

/// How many of the seeds pass; tells why the others do not.
int passed(const std::string& mission, int first, int last) {
  int passed = 0;
  for (int seed = first; seed <= last; ++seed) {
    const Outcome outcome = fly_seed(mission, seed);
    if (outcome.exit_code == 0)
      ++passed;
    else
      UNSCOPED_INFO(mission << ", seed " << seed << ": " << outcome.reason());
  }
  return passed;
}

bool kept(const Outcome& outcome, const std::string& condition) {
  for (const auto& check : outcome.report["checks"])
    if (check["name"] == condition) return check["passed"].get<bool>();
  return false;
}

}  // namespace

TEST_CASE("a mission passes with seeds that nobody has looked at") {
  CHECK(passed("surveillance", 101, 103) == 3);
  CHECK(passed("reconnaissance", 101, 103) == 3);
  CHECK(passed("suppression", 101, 103) == 3);
  CHECK(passed("two_aircraft", 101, 101) == 1);
}

TEST_CASE("the same seed flies the same flight") {
  const Outcome one = fly_seed("surveillance", 2), other = fly_seed("surveillance", 2);
  // The ground station may see some more of the aircraft once that stands.
  const std::size_t length = std::min(one.tracks.size(), other.tracks.size());
  CHECK(length > 500'000);
  CHECK(one.tracks.substr(0, length) == other.tracks.substr(0, length));
  CHECK(one.exit_code == other.exit_code);
  CHECK(fly_seed("surveillance", 3).tracks.substr(0, length) != one.tracks.substr(0, length));
}

TEST_CASE("a mission that can collect nothing is declined before the take-off") {
  const auto variable =
      GENERATE(std::pair("fuel", "21"), std::pair("elements", "depot 3 5 0.3 30 54.9 27.6"));
  const Outcome outcome = fly("reconnaissance", {{variable.first, variable.second}});
  INFO(outcome.log);
  CHECK(outcome.exit_code == 11);
  CHECK_THAT(outcome.reason(), Catch::Contains("no element can be collected within the time"));
  CHECK_THAT(outcome.log, !Catch::Contains("TakeOff"));
}

TEST_CASE("one set of sensors that is left leads home, as far above the ground as any way") {
  const Outcome outcome = fly("reconnaissance", {{"failures", "1 off 100 9999; 2 off 100 9999"}});
  INFO(outcome.log);
  for (const char* condition : {"flown to its end", "clearance", "landing"})
    CHECK(kept(outcome, condition));
}

TEST_CASE(
    "without any sensors the aircraft flies straight on, and the mission ends with the cause") {
  const Outcome outcome =
      fly("reconnaissance", {{"failures", "1 off 200 9999; 2 off 200 9999; 3 off 200 9999"}});
  INFO(outcome.log);
  CHECK(outcome.exit_code == 11);
  CHECK_THAT(outcome.reason(), Catch::Contains("no set of sensors was heard for 60 s"));
  CHECK(kept(outcome, "clearance"));
}

TEST_CASE("of 200 seeds 98 of a hundred pass", "[long]") {
  const char* mission = GENERATE("surveillance", "reconnaissance", "suppression", "two_aircraft");
  CHECK(passed(mission, 201, 400) >= 196);
}
