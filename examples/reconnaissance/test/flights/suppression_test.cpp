// The same thirteen fly a suppression of air defences as a dry exercise: sites are found,
// recognised, placed and kept clear of, and the report is judged by where they truly are.
#include <catch2/catch.hpp>

#include "mission_report.hpp"
#include "test/tools/places.hpp"
#include "track_check.hpp"

using namespace skein::test;
using Catch::Contains;

namespace {

const std::filesystem::path kMission =
    project_file("mission_profiles/reconnaissance/suppression.xml");

/// Near the runway a gun that was reported, and lies in wait; a site that nobody has reported pops
/// up.
const std::vector<std::string> kShort{
    "--variable", "elements=gun 1 5 0.3 3000 53.3500 27.5200",
    "--variable", "sites=mobile gun 53.3450 27.5350 0 7000; short-range site 53.4500 27.4400 60",
    "--variable", "stand_off=5000",
    "--variable", "failures=2 wrong 40 100"};

}  // namespace

TEST_CASE("sites that lie in wait and that nobody reported are found, recognised, placed, avoided",
          "[long]") {
  const MissionRun run(kMission, kShort);
  INFO(run.output());
  CHECK(run.exit_code() == 0);
  CHECK_THAT(run.output(), Contains("gun found at 53.3"));
  CHECK_THAT(run.output(), Contains("gun placed within"));
  CHECK_THAT(run.output(), Contains("was not reported: "));
  CHECK_THAT(run.output(), Contains("is located: home"));
  const auto report = report_of(run, "suppression");
  for (const char* name : {"targets", "sites found", "sites classified", "sites located",
                           "sites reported", "survival"})
    CHECK(kept(report, name));
  CHECK(report["targets"].size() == 2);
  CHECK(report["truths"].size() == 2);
  CHECK(report["footprints"].empty());
  // Out of reach of both weapons, and yet so near that the gun had to show itself.
  const auto tracks = run.file("suppression.csv");
  CHECK(seconds_within(tracks, 53.3450, 27.5350, 3000) == 0);
  CHECK(seconds_within(tracks, 53.4500, 27.4400, 8000) == 0);
  CHECK(seconds_within(tracks, 53.3450, 27.5350, 7000) > 30);
  CHECK(extremes_of(tracks).least_clearance_m > 200);
}

TEST_CASE("the whole suppression passes with several seeds, on each vendor and on both", "[long]") {
  const std::vector<std::pair<std::string, std::string>> vendors{
      {"fastdds", "fastdds"}, {"fastdds", "cyclonedds"}, {"cyclonedds", "cyclonedds"}};
  for (int seed = 1; seed <= 3; ++seed) {
    const auto& [a, b] = vendors[static_cast<std::size_t>(seed) % vendors.size()];
    const MissionRun run(kMission, {"--variable", "seed=" + std::to_string(seed), "--variable",
                                    "vendor_a=" + a, "--variable", "vendor_b=" + b});
    INFO("seed " << seed << " on " << a << " and " << b << "\n" << run.output());
    CHECK(run.exit_code() == 0);
    const auto tracks = run.file("suppression.csv");
    CHECK(seconds_within(tracks, 53.5700, 27.8500, 15000) == 0);
    CHECK(seconds_within(tracks, 53.3350, 27.7750, 3000) == 0);
    CHECK(seconds_within(tracks, 53.5500, 27.4200, 8000) == 0);
    CHECK(extremes_of(tracks).least_clearance_m > 200);
  }
}

TEST_CASE("a report that is wrong fails the mission, however sure of it those are who made it",
          "[long]") {
  const MissionRun run(kMission, with(kShort, {"--variable", "bearing_error=4"}));
  INFO(run.output());
  CHECK(run.exit_code() == 10);
  CHECK_THAT(run.output(), Contains("gun placed within"));
  const auto report = report_of(run, "suppression");
  CHECK(report["flown"] == true);
  CHECK(kept(report, "targets"));
  CHECK(kept(report, "sites found"));
  CHECK(kept(report, "sites classified"));
  CHECK_FALSE(kept(report, "sites located"));
}

TEST_CASE("an order to come nearer than a site may be is refused before the take-off") {
  const MissionRun run(kMission, with(kShort, {"--variable", "stand_off=2500"}));
  INFO(run.output());
  CHECK(run.exit_code() == 11);
  CHECK_THAT(run.output(),
             Contains("Aborted: the order contradicts itself: gun is to be kept away "
                      "from by 2500 m, and may be 3000 m from where it was reported"));
  CHECK_THAT(run.output(), !Contains("TakeOff"));
}
