#include <catch2/catch.hpp>
#include <cstdio>
#include <cstdlib>

#include "test/navigation/demo.hpp"
#include "test/navigation/made_terrain.hpp"

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
  CHECK(terrain.lowest_m() == Approx(142).margin(2));
  CHECK(terrain.highest_m() == Approx(354).margin(2));
  // One degree of WGS-84 at 53.5 degrees north, and at 54, where the tile is narrowest.
  CHECK(terrain.north_extent_m() == Approx(111182).margin(200));
  CHECK(terrain.east_extent_m() == Approx(65600).margin(100));
}

TEST_CASE("Planner and checker read the same ground by their own means") {
  const Terrain terrain = read_hgt(tile());
  const HeightGrid ground = read_height_grid(tile());
  CHECK(largest_difference_m(ground.heights_m, terrain.heights_m()) < 0.05);
  CHECK(ground.north_spacing_m == Approx(terrain.north_spacing_m()).epsilon(1e-12));
  CHECK(ground.east_spacing_m == Approx(terrain.east_spacing_m()).epsilon(1e-12));
}

TEST_CASE("A real tile has the same heights after a way through DTED") {
  const TemporaryFolder folder;
  const auto file = folder.path() / "n53.dt1";
  std::ifstream in(tile(), std::ios::binary);
  const std::string srtm{std::istreambuf_iterator<char>(in), {}};
  std::ofstream(file, std::ios::binary) << MadeDted{1, 30}.bytes([&](int row, int column) {
    const auto at = static_cast<std::size_t>(2 * ((1200 - row) * 1201 + column));
    return static_cast<std::int16_t>(static_cast<unsigned char>(srtm[at]) << 8 |
                                     static_cast<unsigned char>(srtm[at + 1]));
  });
  CHECK(read_dted(file).heights_m() == read_hgt(tile()).heights_m());
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
  CHECK_THROWS_AS(make_planner("AStar", terrains)->plan(unreachable_demo_problem(*terrain)),
                  AE_navigator::NoRoute);
}
