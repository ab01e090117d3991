#pragma once

#include <memory>

#include "demo.hpp"
#include "made_terrain.hpp"

namespace skein::navigation::testing {

/// A flat tile, the problem of crossing 40 km of it from west to east, and one radar half way.
struct FlatCrossing {
  FlatCrossing() : terrains(std::make_shared<TerrainProvider>(std::vector{folder->path()})) {
    write_hgt(folder->path() / "N00E000.hgt", [](int, int) { return 100; });
    problem.terrain = "N00E000.hgt";
    problem.start = {55000, 35000, 300};
    problem.goal = {55000, 75000, 300};
    problem.radar_sites = {{"R", {55000, 55000}, 20, 6000, 1}};
    problem.minimum_height_above_ground_m = 100;
    problem.limits = {60, 10, 30, 3000};
    problem.exposure_weight = 1;
  }

  AE_navigator::Route plan() const { return make_a_star(terrains)->plan(problem); }

  HeightGrid ground() const { return read_height_grid(folder->path() / "N00E000.hgt"); }

  std::shared_ptr<TemporaryFolder> folder = std::make_shared<TemporaryFolder>();
  std::shared_ptr<TerrainProvider> terrains;
  AE_navigator::Problem problem;
};

}  // namespace skein::navigation::testing
