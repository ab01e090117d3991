#pragma once

#include <memory>

#include "demo.hpp"
#include "made_terrain.hpp"

namespace skein::navigation::testing {

/// A flat tile, written and read once for all tests of a program.
class FlatTile {
 public:
  static const FlatTile& shared() {
    static const FlatTile tile;
    return tile;
  }

  const std::shared_ptr<TerrainProvider>& terrains() const { return terrains_; }
  const HeightGrid& ground() const { return ground_; }

 private:
  FlatTile() {
    write_hgt(folder_.path() / "N00E000.hgt", [](int, int) { return 100; });
    terrains_ = std::make_shared<TerrainProvider>(std::vector{folder_.path()});
    ground_ = read_height_grid(folder_.path() / "N00E000.hgt");
  }

  TemporaryFolder folder_;
  std::shared_ptr<TerrainProvider> terrains_;
  HeightGrid ground_;
};

/// The problem of crossing 40 km of it from west to east, and one radar half way.
struct FlatCrossing {
  FlatCrossing() {
    problem.terrain = "N00E000.hgt";
    problem.start = {55000, 35000, 300};
    problem.goal = {55000, 75000, 300};
    problem.radar_sites = {{"R", {55000, 55000}, 20, 6000, 1}};
    problem.minimum_height_above_ground_m = 100;
    problem.limits = {60, 10, 30, 3000};
    problem.exposure_weight = 1;
  }

  AE_navigator::Route plan() const { return make_planner("AStar", terrains)->plan(problem); }

  const HeightGrid& ground() const { return FlatTile::shared().ground(); }

  std::shared_ptr<TerrainProvider> terrains = FlatTile::shared().terrains();
  AE_navigator::Problem problem;
};

}  // namespace skein::navigation::testing
