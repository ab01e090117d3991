#include "navigation/components/ad_manager.hpp"

#include <catch2/catch.hpp>

#include "navigation/routes/demo_problem.hpp"

using namespace skein::navigation;
using AE_adManagerI::InvalidReport;

namespace {

const std::string kTerrain = "synthetic:7";

}  // namespace

TEST_CASE("the first threat picture shows the known radars, each report makes the next") {
  AdManager manager(std::make_shared<TerrainProvider>());
  const auto first = manager.threat_picture(kTerrain);
  CHECK(first.epoch == 1);
  CHECK(first.terrain == kTerrain);
  REQUIRE(first.radar_sites.size() == 4);

  const auto found = manager.radar_found(kTerrain, {"Echo", {100, 200}, 20, 5000, 1});
  CHECK(found.epoch == 2);
  CHECK(found.radar_sites.size() == 5);
  const auto better = manager.radar_found(kTerrain, {"Echo", {110, 210}, 20, 5000, 1});
  CHECK(better.radar_sites.size() == 5);
  CHECK(better.radar_sites.back().site.north_m == 110);
  const auto silent = manager.radar_silent(kTerrain, "Echo");
  CHECK(silent.epoch == 4);
  CHECK(silent.radar_sites == first.radar_sites);
  const auto missiles = manager.missiles_found(kTerrain, {"Sierra", {100, 200}, 20, 4000, 0.02});
  CHECK(missiles.missile_sites.size() == 1);
  CHECK(manager.threat_picture(kTerrain) == missiles);
}

TEST_CASE("a report that makes no sense is refused, and the picture stays") {
  AdManager manager(std::make_shared<TerrainProvider>());
  CHECK_THROWS_AS(manager.radar_silent(kTerrain, "Nobody"), InvalidReport);
  CHECK_THROWS_AS(manager.threat_picture("nowhere/N00E000.hgt"), InvalidReport);
  CHECK(manager.threat_picture(kTerrain).epoch == 1);
}
