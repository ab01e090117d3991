// All missions with many seeds, each flight in this process.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>
#include <string>
#include <utility>

#include "flight_in_process.hpp"
#include "geodesy/local_frame.hpp"
#include "random.hpp"

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

/// Anywhere from 9 to 45 km off, half of them from the beginning.
std::string twelve_sites(std::uint64_t seed) {
  constexpr std::array kTypes{"short-range site", "medium-range site", "mobile gun"};
  constexpr std::array kFrom_s{0, 0, 300, 600};
  const LocalFrame frame({53.3, 27.4, 180});
  Random random(seed);
  std::string sites;
  for (int i = 0; i < 12; ++i) {
    const double angle = 2 * std::numbers::pi * random.uniform();
    const double away_m = std::lerp(9000, 45000, random.uniform());
    const Geodetic place =
        frame.to_geodetic({away_m * std::cos(angle), away_m * std::sin(angle), 0});
    sites += fmt::format("{}{} {:.4f} {:.4f} {}", i > 0 ? "; " : "",
                         kTypes[static_cast<std::size_t>(3 * random.uniform())], place.latitude_deg,
                         place.longitude_deg, kFrom_s[i % kFrom_s.size()]);
  }
  return sites;
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

TEST_CASE("a mission whose runway weapons reach is declined before the take-off") {
  const char* site = GENERATE("short-range site 53.3540 27.3550 0",   // beside the runway,
                              "short-range site 53.2518 27.2505 0");  // below the approach
  const char* mission = GENERATE("reconnaissance", "surveillance", "suppression");
  const Outcome outcome = fly(mission, {{"sites", site}});
  INFO(outcome.log);
  CHECK(outcome.exit_code == 11);
  CHECK_THAT(outcome.reason(), Catch::Contains("weapons reach the runway: take-off and landing"));
  CHECK_THAT(outcome.log, !Catch::Contains("TakeOff"));
}

TEST_CASE("two weapons at one place are kept away from as well as one") {
  const std::string site = "short-range site 53.4800 27.5000 0; ";
  const Outcome outcome =
      fly("surveillance", {{"sites", site + site + "medium-range site 53.5500 27.9500 0"}});
  INFO(outcome.log);
  CHECK(kept(outcome, "survival"));
}

TEST_CASE("a way along the edge of what a weapon reaches leaves room for how turns are flown") {
  CHECK(passed("surveillance", 334, 334) == 1);
  CHECK(passed("suppression", 337, 337) == 1);
}

TEST_CASE("other aircraft are avoided out of weapons' reach") {
  std::string intruders;
  for (int minute = 2; minute <= 20; ++minute)
    intruders += fmt::format("{}{} 35 12000 60", minute > 2 ? "; " : "", 60 * minute);
  const Outcome outcome = fly("reconnaissance", {{"intruders", intruders}});
  INFO(outcome.log);
  for (const char* condition : {"survival", "clearance", "flown to its end"})
    CHECK(kept(outcome, condition));
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

TEST_CASE("among twelve sites a mission keeps its limits, is declined, or turns back and lands",
          "[long]") {
  const char* mission = GENERATE("surveillance", "reconnaissance", "suppression");
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const std::string sites = twelve_sites(seed);
    const Outcome outcome = fly(mission, {{"sites", sites}});
    INFO(mission << " among " << sites << "\n" << outcome.log);
    if (outcome.exit_code == 11) {
      CHECK_THAT(outcome.log, !Catch::Contains("TakeOff"));
      continue;
    }
    for (const char* condition : {"flown to its end", "duration", "clearance", "landing", "fuel"})
      CHECK(kept(outcome, condition));
    // What weapons come alive around home when it is nearly there, nothing helps against.
    if (!kept(outcome, "survival"))
      CHECK_THAT(outcome.log, Catch::Contains("Egress: a weapon guides") ||
                                  Catch::Contains("a threat bars the way"));
  }
}

TEST_CASE("of 200 seeds 98 of a hundred pass", "[long]") {
  const char* mission = GENERATE("surveillance", "reconnaissance", "suppression", "two_aircraft");
  CHECK(passed(mission, 201, 400) >= 196);
}
