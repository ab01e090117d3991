// The same thirteen fly surveillance: a target is searched, found, followed, and judged by where it
// truly was.
#include <catch2/catch.hpp>

#include "mission_report.hpp"
#include "test/tools/places.hpp"
#include "track_check.hpp"

using namespace skein::test;
using Catch::Contains;

namespace {

const std::filesystem::path kMission =
    project_file("mission_profiles/reconnaissance/surveillance.xml");

/// A road near the runway, on which the target drives, stops, and drives on; a site far away.
const std::vector<std::string> kShort{
    "--variable", "elements=van 1 3 0.3 30 53.3160 27.4700 53.3160 27.4900",
    "--variable", "objects=53.3160 27.4720 3 90 3 200 90 0 300 20 8",
    "--variable", "sites=short-range site 53.4800 27.5000 0",
    "--variable", "follow_for=100 s",
    "--variable", "failures=2 wrong 40 100"};

}  // namespace

TEST_CASE("a target that was reported on a road is found, and followed while it drives and stops",
          "[long]") {
  const MissionRun run(kMission, kShort);
  INFO(run.output());
  CHECK(run.exit_code() == 0);
  CHECK_THAT(run.output(), Contains("van found at 53.316"));
  CHECK_THAT(run.output(), Contains("Collection: van is found, and followed"));
  CHECK_THAT(run.output(), Contains("van followed for 100 s, wanted 100"));
  CHECK_THAT(run.output(), Contains("Egress: followed as long as ordered: home"));
  const auto report = report_of(run, "surveillance");
  for (const char* name : {"targets", "found", "in view", "track"}) CHECK(kept(report, name));
  CHECK(report["targets"][0]["path"].size() > 90);
  CHECK(report["truths"][0]["points"].size() > 200);
  // It circled: for most of the time it was near where the target is, and never above it.
  const auto tracks = run.file("surveillance.csv");
  CHECK(seconds_within(tracks, 53.318, 27.485, 2500) > 100);
  CHECK(extremes_of(tracks).least_clearance_m > 200);
}

TEST_CASE("a target that is not where it was reported is not found, and the mission fails",
          "[long]") {
  const MissionRun run(kMission, with(kShort, {"--variable", "objects=53.3300 27.4690 3 90 4"}));
  INFO(run.output());
  CHECK(run.exit_code() == 10);
  CHECK_THAT(run.output(), Contains("an element was missed"));
  const auto report = report_of(run, "surveillance");
  CHECK(report["flown"] == true);
  CHECK(report["reason"] == "targets: 0 of 1 elements followed as long as was ordered");
  CHECK_FALSE(kept(report, "found"));
  CHECK_FALSE(kept(report, "in view"));
  CHECK(kept(report, "survival"));
}

TEST_CASE("an order that contradicts itself is refused before the take-off, with its cause") {
  const MissionRun run(kMission, with(kShort, {"--variable", "stand_off=500"}));
  INFO(run.output());
  CHECK(run.exit_code() == 11);
  CHECK_THAT(run.output(), Contains("Aborted: the order contradicts itself: van is to be circled "
                                    "at 500 m, and the aircraft turns with a radius of"));
  CHECK_THAT(run.output(), !Contains("TakeOff"));
}
