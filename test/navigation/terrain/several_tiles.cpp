#include <catch2/catch.hpp>
#include <cmath>

#include "navigation/route_checker/height_grid.hpp"
#include "skein/error.hpp"
#include "test/navigation/demo.hpp"
#include "test/navigation/made_terrain.hpp"

using namespace skein::navigation;
using namespace skein::navigation::testing;
using Catch::Contains;

namespace {

/// Hills whose posts are the same in every tile that has them; the place is in degrees.
int hills_m(double latitude, double longitude) {
  return static_cast<int>(
      std::lround(500 + 300 * std::sin(40 * latitude) * std::sin(40 * longitude)));
}

void write_hills(const TemporaryFolder& folder, const std::string& name, int south, int west) {
  write_hgt(folder.path() / name, [=](int row, int column) {
    return hills_m(south + row / 1200.0, west + column / 1200.0);
  });
}

std::string folder_refusal(const std::filesystem::path& file) {
  try {
    read_hgt(file);
  } catch (const skein::InvalidArgument& error) {
    return error.what();
  }
  return "accepted";
}

/// Two by two tiles around 51 degrees north, 7 degrees east.
struct FourTiles {
  FourTiles() {
    write_hills(folder, "N50E006.hgt", 50, 6);
    write_hills(folder, "N50E007.hgt", 50, 7);
    write_hills(folder, "N51E006.hgt", 51, 6);
    write_hills(folder, "N51E007.hgt", 51, 7);
  }
  std::filesystem::path file() const { return folder.path() / "N50E006.hgt..N51E007.hgt"; }
  TemporaryFolder folder;
};

}  // namespace

TEST_CASE("A terrain of four tiles has the ground of each, at their edges, too") {
  const FourTiles tiles;
  const Terrain terrain = read_hgt(tiles.file());
  CHECK(terrain.rows() == 2401);
  CHECK(terrain.columns() == 2401);
  for (const auto& [latitude, longitude] : {std::pair{50.2, 6.3},
                                            {50.9, 7.8},
                                            {51.7, 6.1},
                                            {51.4, 7.6},
                                            {51.0, 6.5},
                                            {50.5, 7.0},
                                            {51.0, 7.0},
                                            {50.01, 6.999},
                                            {51.0001, 6.9999}}) {
    INFO(latitude << " " << longitude);
    const auto point = terrain.frame()->to_ground({latitude, longitude});
    CHECK(terrain.contains(point.north_m, point.east_m));
    CHECK(terrain.height_m(point.north_m, point.east_m) ==
          Approx(hills_m(latitude, longitude)).margin(1.5));
  }
  const HeightGrid ground = read_height_grid(tiles.file());
  CHECK(largest_difference_m(ground.heights_m, terrain.heights_m()) < 0.05);
  CHECK(ground.north_spacing_m == Approx(terrain.north_spacing_m()).epsilon(1e-12));
  CHECK(ground.east_spacing_m == Approx(terrain.east_spacing_m()).epsilon(1e-12));
}

TEST_CASE("A route leads across the edges of tiles, and the checker finds it valid") {
  const FourTiles tiles;
  const auto terrains =
      std::make_shared<TerrainProvider>(std::vector<std::filesystem::path>{tiles.folder.path()});
  AE_navigator::Problem problem;
  problem.terrain = "N50E006.hgt..N51E007.hgt";
  const auto terrain = terrains->load(problem.terrain);
  const auto above = [&](double latitude, double longitude) -> AE_navigator::Position {
    const auto point = terrain->frame()->to_ground({latitude, longitude});
    return {point.north_m, point.east_m, terrain->height_m(point.north_m, point.east_m) + 250};
  };
  problem.start = above(50.8, 6.8);
  problem.goal = above(51.2, 7.25);
  const auto corner = terrain->frame()->to_ground({51, 7});
  problem.no_fly_zones = {{"Where four tiles meet", {corner}, 4000, -1000, 20000}};
  problem.minimum_height_above_ground_m = 120;
  problem.limits = {60, 10, 30, 3000};
  const AE_navigator::Route route = make_planner("AStar", terrains)->plan(problem);
  CHECK(violations(problem, route, read_height_grid(tiles.file())) == "");
  CHECK(route.length_m > 54000);
}

TEST_CASE("A terrain across the antimeridian is whole") {
  const TemporaryFolder folder;
  write_hills(folder, "S18E179.hgt", -18, 179);
  write_hills(folder, "S18W180.hgt", -18, 180);
  const Terrain terrain = read_hgt(folder.path() / "S18E179.hgt..S18W180.hgt");
  CHECK(height_at(terrain, -17.3, 179.8) == Approx(hills_m(-17.3, 179.8)).margin(1.5));
  CHECK(height_at(terrain, -17.3, -179.6) == Approx(hills_m(-17.3, 180.4)).margin(1.5));
  const auto west = terrain.frame()->to_ground({-17.5, 179.99});
  const auto east = terrain.frame()->to_ground({-17.5, -179.99});
  CHECK(east.east_m - west.east_m == Approx(2124).margin(1));
  const HeightGrid ground = read_height_grid(folder.path() / "S18E179.hgt..S18W180.hgt");
  CHECK(largest_difference_m(ground.heights_m, terrain.heights_m()) < 0.05);
}

TEST_CASE("Of posts that two tiles share the higher one counts, and any height before a void") {
  const TemporaryFolder folder;
  write_hgt(folder.path() / "N00E000.hgt", [](int row, int column) {
    if (column == 1200) return row < 400 ? -32768 : 700;
    return 100;
  });
  write_hgt(folder.path() / "N00E001.hgt", [](int row, int column) {
    if (column < 20 && row >= 800 && row < 900) return -32768;
    return column == 0 ? (row < 600 ? 300 : 900) : 100;
  });
  const auto file = folder.path() / "N00E000.hgt..N00E001.hgt";
  const Terrain terrain = read_hgt(file);
  const auto is_about = [&](double row, double column, double height_m) {
    const double ground_m = height_at(terrain, row / 1200, column / 1200);
    INFO(row << ", " << column << ": " << ground_m);
    CHECK(ground_m >= height_m - 0.5);
    CHECK(ground_m < height_m + 99);
  };
  is_about(200, 1200, 300);
  is_about(500, 1200, 700);
  is_about(700, 1200, 900);
  is_about(850, 1210, 700);  // In a void beside the edge, whose rim is of both tiles.
  CHECK(largest_difference_m(read_height_grid(file).heights_m, terrain.heights_m()) < 0.2);
}

TEST_CASE("Tiles that make no terrain together are refused with the one that is wrong") {
  const TemporaryFolder folder;
  const auto at = [&](const char* name) { return folder.path() / name; };
  write_hills(folder, "N50E006.hgt", 50, 6);
  write_hills(folder, "N51E007.hgt", 51, 7);
  CHECK_THAT(folder_refusal(at("N50E006.hgt..N51E007.hgt")),
             Contains("lacks N50E007.hgt, N51E006.hgt in '" + folder.path().string() + "'"));
  std::ofstream(at("N50E007.hgt")) << std::string(2 * 3601 * 3601, '\0');
  CHECK_THAT(folder_refusal(at("N50E006.hgt..N50E007.hgt")),
             Contains("N50E007.hgt: has 3601 x 3601 posts, and N50E006.hgt has 1201 x 1201"));
  CHECK_THAT(folder_refusal(at("N51E007.hgt..N50E006.hgt")), Contains("the north-eastern one"));
  CHECK_THAT(folder_refusal(at("N50E006.hgt..N50E009.hgt")), Contains("spans 1 by 4 degrees"));
  CHECK_THAT(folder_refusal(at("N50E006.hgt..N50E009")), Contains("N53E027.hgt..N54E028.hgt"));
  CHECK_THAT(folder_refusal(at("N82E006.hgt..N84E006.hgt")), Contains("84 degrees north"));
  CHECK_THROWS_WITH(TerrainProvider({folder.path()}).load("N49E006.hgt..N50E006.hgt"),
                    Contains("looked for"));
}
