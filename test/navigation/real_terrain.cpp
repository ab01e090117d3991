#include <catch2/catch.hpp>
#include <cstdio>
#include <cstdlib>

#include "demo.hpp"
#include "made_terrain.hpp"

using namespace skein::navigation;
using namespace skein::navigation::testing;

namespace {

/// The tile of the test data; ends the program as skipped where there are none.
std::filesystem::path tile() {
  const char* folder = std::getenv("SKEIN_TEST_DATA");
  const std::filesystem::path file =
      folder ? std::filesystem::path(folder) / "terrain" / "N53E027.hgt" : "";
  if (folder && std::filesystem::exists(file)) return file;
  std::fprintf(stderr, "skipped: SKEIN_TEST_DATA names no folder with terrain/N53E027.hgt\n");
  std::_Exit(77);
}

}  // namespace

TEST_CASE("A real tile has the heights and the size that it is known for") {
  const Terrain terrain = read_hgt(tile());
  CHECK(terrain.rows() == 1201);
  CHECK(terrain.lowest_m() == 142);
  CHECK(terrain.highest_m() == 354);
  CHECK(terrain.north_extent_m() == Approx(111195).margin(1));
  CHECK(terrain.east_extent_m() == Approx(66142).margin(2));
}

TEST_CASE("Planner and checker read the same ground by their own means") {
  const Terrain terrain = read_hgt(tile());
  const HeightGrid ground = read_height_grid(tile());
  CHECK(ground.heights_m == terrain.heights_m());
  CHECK(ground.north_spacing_m == Approx(terrain.north_spacing_m()).epsilon(1e-12));
  CHECK(ground.east_spacing_m == Approx(terrain.east_spacing_m()).epsilon(1e-12));
}

TEST_CASE("A real tile has the same heights after a way through DTED") {
  const Terrain terrain = read_hgt(tile());
  const TemporaryFolder folder;
  const auto file = folder.path() / "n53.dt1";
  std::ofstream(file, std::ios::binary) << MadeDted{1, 30}.bytes(
      [&](int row, int column) { return static_cast<int>(terrain.post_m(row, column)); });
  CHECK(read_dted(file).heights_m() == terrain.heights_m());
}

TEST_CASE("Over real ground every planner's route is valid, and an enclosed goal is refused") {
  const HeightGrid ground = read_height_grid(tile());
  const auto terrains = std::make_shared<TerrainProvider>();
  const auto terrain = terrains->load(tile().string());
  AE_navigator::Problem problem = demo_problem(*terrain);
  for (const std::string& name : planner_names()) {
    INFO(name);
    CHECK(violations(problem, make_planner(name, terrains)->plan(problem), ground) == "");
  }
  CHECK_THROWS_AS(make_a_star(terrains)->plan(unreachable_demo_problem(*terrain)),
                  AE_navigator::NoRoute);
}
