// All thirteen fly, on both vendors; the verdict is what the conditions in the profile make it.
#include <catch2/catch.hpp>
#include <fstream>
#include <regex>
#include <set>
#include <sstream>

#include "mission_report.hpp"
#include "test/tools/command_run.hpp"
#include "test/tools/places.hpp"
#include "test/tools/stopped.hpp"
#include "track_check.hpp"

using namespace skein::test;
using Catch::Contains;

namespace {

const std::filesystem::path kMission =
    project_file("mission_profiles/reconnaissance/reconnaissance.xml");

/// One element of interest, near the runway; an intruder comes soon.
const std::vector<std::string> kShort{"--variable", "elements=shed 1 5 0.3 20 53.3089 27.3225",
                                      "--variable", "objects=53.3089 27.3226 3 0 0",
                                      "--variable", "intruders=270 30 7000 60",
                                      "--variable", "failures=2 wrong 40 300",
                                      "--variable", "planner_failures=2 killed"};

std::string text_of(const std::filesystem::path& file) {
  std::ostringstream text;
  text << std::ifstream(file).rdbuf();
  return text.str();
}

/// What shares no code with those who flew it finds nothing wrong, either.
void check_tracks(const MissionRun& run) {
  const TrackExtremes extremes = extremes_of(run.file("reconnaissance.csv"));
  CHECK(extremes.flown_s > 100);
  CHECK(extremes.least_clearance_m > 200);
  CHECK(extremes.greatest_bank_deg < 30);
  // Through the air 6 degrees at most, which a head wind makes steeper over the ground.
  CHECK(extremes.greatest_climb_deg < 8.5);
  CHECK(extremes.others == 1);
  CHECK(extremes.longest_not_well_clear_s == 0);
}

/// What README shows of the output, each line with a single blank after the mission's time.
std::vector<std::string> lines_in_readme() {
  std::ifstream readme(project_file("README.md"));
  std::vector<std::string> lines;
  bool shown = false;
  for (std::string line; std::getline(readme, line);)
    if (line.starts_with("```"))
      shown = line == "```text";
    else if (shown)
      lines.push_back(std::regex_replace(line, std::regex(R"(^(\d\d:\d\d)  )"), "$1 "));
  return lines;
}

std::set<std::string> told_faults(const nlohmann::json& report) {
  std::set<std::string> told;
  for (const auto& each : report["faults"])
    told.insert(each["noticed_by"].get<std::string>() + ": " + each["what"].get<std::string>());
  return told;
}

/// Of a running mission.
pid_t process_of(const std::string& peer) {
  CommandRun status({"status", "--json", kMission});
  REQUIRE(status.wait() == 0);
  const auto told = nlohmann::json::parse(status.output());
  for (const auto& each : told["processes"])
    if (each["name"] == peer) return each["pid"].get<pid_t>();
  FAIL("there is no process " << peer);
  return 0;
}

/// The angle of a pixel of the camera: 3 degrees by 1440 rows.
constexpr double kPixel_rad = 0.0524 / 1440;

/// What was collected could be seen so finely from where the aircraft flew.
void check_pass(const MissionRun& run, double latitude_deg, double longitude_deg) {
  const Pass pass = pass_by(run.file("reconnaissance.csv"), latitude_deg, longitude_deg);
  INFO(pass.beside_m << " m beside, " << pass.above_ground_m << " m above ground");
  CHECK(pass.sample_m(kPixel_rad) < 0.3);
}

}  // namespace

TEST_CASE(
    "thirteen on two vendors take off, collect an element, and land; the verdict is written") {
  const MissionRun run(kMission, kShort);
  INFO(run.output());
  CHECK(run.exit_code() == 0);
  for (const char* phase : {"TakeOff", "Ingress", "Collection", "Egress", "Landing", "Complete"})
    CHECK_THAT(run.output(), Contains(phase));
  // What its radar transmits is received, classified by a vote, and placed.
  CHECK_THAT(run.output(), Contains(": short-range site at 53."));
  // One that comes is avoided, one that lies is not heard.
  CHECK_THAT(run.output(), Contains("another aircraft is avoided"));
  CHECK_THAT(run.output(), Contains("2 of 3 sets of sensors are heard"));
  // One that dies is replaced, and comes back.
  CHECK_THAT(run.output(), Contains("AStar has died at its task: RRTConnect does it instead"));
  // What is flown is what the mission manager's Head chose.
  CHECK_THAT(run.output(), Contains("planned: shed"));
  // What is to be seen is seen as finely as it was ordered, by a pattern that a Head chose.
  CHECK_THAT(run.output(), Contains("shed collected: 0."));
  const auto verdict = report_of(run, "reconnaissance");
  CHECK(verdict["verdict"] == "passed");
  CHECK(verdict["checks"].size() == 9);
  // What broke is told: who noticed it, and what was done.
  CHECK(told_faults(verdict) ==
        std::set<std::string>{"flight_controller: A set of sensors fails",
                              "collision_manager: Another aircraft comes near",
                              "ad_manager: A short-range site pops up",
                              "navigator: AStar dies at its task"});
  CHECK(verdict["routes"].size() >= 2);
  CHECK(verdict["decisions"].size() > 5);
  CHECK_THAT(text_of(run.file("reconnaissance.html")), Contains("Passed"));
  check_tracks(run);
  check_pass(run, 53.3089, 27.3225);
  // Of the site's weapon, 8 km around it.
  CHECK(seconds_within(run.file("reconnaissance.csv"), 53.48, 27.5, 8000) == 0);
  CHECK_THAT(text_of(run.file("reconnaissance.junit.xml")), Contains("failures=\"0\""));
}

TEST_CASE("a mission whose fuel becomes short goes home, because its executive says so") {
  const MissionRun run(kMission, with(kShort, {"--set", "flight_simulator.Fuel=22.6", "--set",
                                               "nhp.Fuel reserve=22"}));
  INFO(run.output());
  CHECK(run.exit_code() == 10);
  CHECK_THAT(run.output(), Contains("ReturnHome: fuel suffices for the way home and no more"));
  CHECK_THAT(run.output(), Contains("Egress: fuel suffices for the way home and no more"));
  const auto verdict = report_of(run, "reconnaissance");
  CHECK(verdict["flown"] == true);
  CHECK_THAT(verdict["reason"].get<std::string>(), Contains("targets: 0 of 1"));
  check_tracks(run);
}

TEST_CASE("a flight that is not flown to its end says so by its exit code") {
  const MissionRun run(kMission, with(kShort, {"--set", "ground_station.Longest flight=5 s"}));
  INFO(run.output());
  CHECK(run.exit_code() == 11);
  const auto verdict = report_of(run, "reconnaissance");
  CHECK(verdict["verdict"] == "failed");
  CHECK(verdict["flown"] == false);
  CHECK_THAT(verdict["reason"].get<std::string>(), Contains("takes too long"));
}

TEST_CASE("a profile that is wrong is refused, and nothing flies") {
  const MissionRun run(kMission, with(kShort, {"--variable", "vendor_b=nobody"}));
  CHECK(run.exit_code() == 78);
  CHECK_FALSE(exists(run.file("reconnaissance.json")));
}

TEST_CASE("a mission one of whose processes is stopped for 30 s in the tour goes on, and passes",
          "[.stopped]") {
  const std::string peer = GENERATE("navigator", "flight_simulator", "mission_manager");
  CAPTURE(peer);
  CommandRun run({"launch", kMission});
  REQUIRE(run.writes("Ingress: planned"));
  stop_process(process_of(peer), std::chrono::seconds(30));
  CHECK(run.wait(std::chrono::minutes(5)) == 0);
  INFO(run.output());
  CHECK_THAT(run.output(), Contains("3 of 3 elements collected"));
}

TEST_CASE(
    "the whole mission passes with several seeds, on each vendor and on both; README shows the "
    "first",
    "[.nominal]") {
  const std::vector<std::pair<std::string, std::string>> vendors{
      {"fastdds", "cyclonedds"}, {"fastdds", "fastdds"}, {"cyclonedds", "cyclonedds"}};
  for (int seed = 1; seed <= 6; ++seed) {
    const auto& [a, b] = vendors[static_cast<std::size_t>(seed) % vendors.size()];
    const MissionRun run(kMission, {"--variable", "seed=" + std::to_string(seed), "--variable",
                                    "vendor_a=" + a, "--variable", "vendor_b=" + b});
    INFO("seed " << seed << " on " << a << " and " << b << "\n" << run.output());
    CHECK(run.exit_code() == 0);
    check_tracks(run);
    // What was collected: a place, the corners of a road, a bridge.
    check_pass(run, 53.4050, 27.5985);
    check_pass(run, 53.4047, 27.7111);
    check_pass(run, 53.3823, 27.7363);
    check_pass(run, 53.3405, 27.6390);
    // Of the weapons of the sites that are there from the beginning.
    CHECK(seconds_within(run.file("reconnaissance.csv"), 53.48, 27.5, 8000) == 0);
    CHECK(seconds_within(run.file("reconnaissance.csv"), 53.55, 27.95, 15000) == 0);
    if (seed == 1) {
      const std::vector<std::string> shown = lines_in_readme();
      REQUIRE_FALSE(shown.empty());
      for (const std::string& line : shown) CHECK_THAT(run.output(), Contains(line));
    }
  }
}
