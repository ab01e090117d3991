// Two aircraft, each a system of its own, fly one mission: they share out its elements and their
// threat pictures, keep clear of each other, and are judged by one verdict.
#include <catch2/catch.hpp>
#include <fstream>
#include <nlohmann/json.hpp>
#include <regex>
#include <set>
#include <sstream>

#include "test/tools/mission_run.hpp"
#include "test/tools/places.hpp"
#include "track_check.hpp"

using namespace skein::test;
using Catch::Contains;

namespace {

const std::filesystem::path kMission =
    project_file("mission_profiles/reconnaissance/two_aircraft.xml");

/// An element near each runway, and a site that the first aircraft hears.
const std::vector<std::string> kShort{
    "--variable", "elements=shed 1 5 0.3 20 53.3089 27.3225; barn 1 5 0.3 20 53.3600 27.3100",
    "--variable", "objects=53.3089 27.3226 3 0 0; 53.3600 27.3101 3 0 0",
    "--variable", "failures=2 wrong 40 100",
    "--variable", "second_runway=53.3500 27.3850 180 80 1500",
    "--variable", "sites=short-range site 53.4800 27.5000 60"};

std::string text_of(const std::filesystem::path& file) {
  std::ostringstream text;
  text << std::ifstream(file).rdbuf();
  return text.str();
}

/// What shares no code with those who flew it finds nothing wrong, either; the other aircraft is
/// beside it all the time.
void check_tracks(const std::filesystem::path& tracks) {
  INFO(tracks);
  const TrackExtremes extremes = extremes_of(tracks);
  CHECK(extremes.flown_s > 100);
  CHECK(extremes.least_clearance_m > 200);
  CHECK(extremes.greatest_bank_deg < 31);  // gusts bend the track, too
  CHECK(extremes.greatest_climb_deg < 8.5);
  CHECK(extremes.others == 1);
  CHECK(extremes.longest_not_well_clear_s == 0);
}

}  // namespace

TEST_CASE(
    "two aircraft share out what is to be reconnoitred and what they know of threats; one verdict "
    "is passed over both") {
  const MissionRun run(kMission, kShort);
  INFO(run.output());
  CHECK(run.exit_code() == 0);
  // Each takes what is nearer to it.
  CHECK_THAT(run.output(), Contains("uav-1 TakeOff"));
  CHECK_THAT(run.output(), Contains("uav-2 TakeOff"));
  CHECK_THAT(run.output(), Contains("uav-1 Ingress: planned: shed"));
  CHECK_THAT(run.output(), Contains("uav-2 Ingress: planned: barn"));
  CHECK_THAT(run.output(), Contains("uav-1 shed collected: 0."));
  CHECK_THAT(run.output(), Contains("uav-2 barn collected: 0."));
  // Who has not heard a site knows it over the link, under numbers from a million on.
  CHECK(std::regex_search(run.output(), std::regex(R"(uav-\d threat 100000\d: short-range site)")));
  const auto report = nlohmann::json::parse(text_of(run.file("two_aircraft.json")));
  CHECK(report["verdict"] == "passed");
  std::set<std::string> checks;
  for (const auto& check : report["checks"]) checks.insert(check["name"].get<std::string>());
  CHECK(checks.size() == 18);
  CHECK(checks.contains("uav-1 well clear"));
  CHECK(checks.contains("uav-2 well clear"));
  // Both tracks, and the targets of both.
  CHECK(report["targets"].size() == 2);
  bool beside = false;
  for (const auto& other : report["others"])
    beside |= other["name"] == "uav-2" && other["points"].size() > 100;
  CHECK(beside);
  CHECK(report["track"]["time_s"].size() > 100);
  for (const char* name : {"two_aircraft-uav-1.csv", "two_aircraft-uav-2.csv"})
    check_tracks(run.file(name));
  CHECK_THAT(text_of(run.file("two_aircraft.html")), Contains("Passed"));
  CHECK_THAT(text_of(run.file("two_aircraft.junit.xml")), Contains("failures=\"0\""));
}

TEST_CASE("a mission of two aircraft fails if one of them does, and says which") {
  const MissionRun run(
      kMission,
      {kShort[0], "elements=shed 1 5 0.001 20 53.3089 27.3225; barn 1 5 0.3 20 53.36 27.31",
       kShort[2], kShort[3], kShort[6], kShort[7]});
  INFO(run.output());
  CHECK(run.exit_code() == 10);
  const auto report = nlohmann::json::parse(text_of(run.file("two_aircraft.json")));
  CHECK(report["flown"] == true);
  CHECK_THAT(report["reason"].get<std::string>(), Contains("uav-1 targets: 0 of 1"));
}

TEST_CASE("two aircraft that have one runway named are refused") {
  const MissionRun run(kMission, {"--set", "ground_station.Runways=53.3000 27.4000 180 80 1500"});
  INFO(run.output());
  CHECK(run.exit_code() != 0);
  CHECK_THAT(run.output(), Contains("2 aircraft need as many runways, not 1"));
  CHECK_FALSE(exists(run.file("two_aircraft.json")));
}
