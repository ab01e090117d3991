#include <catch2/catch.hpp>
#include <filesystem>

#include "geodesy/tile.hpp"
#include "navigation/terrain/terrain.hpp"

using namespace reconnaissance;

TEST_CASE("places have the coordinates in a tile at which the planners' terrain has them") {
  const auto file = std::filesystem::temp_directory_path() / "N53E027.hgt";
  const Tile tile({53.5, 27.5, 0});
  tile.write(file, LocalFrame({53.5, 27.5, 0}), [](double, double) { return 100; });
  const skein::navigation::Terrain terrain = skein::navigation::read_hgt(file);
  std::filesystem::remove(file);
  for (const Geodetic place : {Geodetic{53.3, 27.4, 0}, {53.02, 27.97, 0}, {53.98, 27.03, 0}}) {
    const Local ours = tile.to_tile(place);
    const auto theirs = terrain.frame()->to_ground({place.latitude_deg, place.longitude_deg});
    CHECK(ours.north_m == Approx(theirs.north_m).margin(1e-3));
    CHECK(ours.east_m == Approx(theirs.east_m).margin(1e-3));
  }
  for (const Geodetic place : {Geodetic{52.9, 27.4, 0}, {54.1, 26.8, 0}, {53.4, 28.2, 0}}) {
    const Local beyond = tile.to_tile(place), nearest = tile.nearest(beyond);
    CHECK_FALSE(terrain.contains(beyond.north_m, beyond.east_m));
    CHECK(terrain.contains(nearest.north_m, nearest.east_m));
  }
  const Local inside = tile.to_tile({53.3, 27.4, 0});
  CHECK(tile.nearest(inside).north_m == inside.north_m);
  CHECK(tile.nearest(inside).east_m == inside.east_m);
}
