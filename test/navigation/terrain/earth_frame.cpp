#include <GeographicLib/Geodesic.hpp>
#include <catch2/catch.hpp>
#include <cmath>
#include <tuple>

#include "navigation/terrain/plane_geometry.hpp"
#include "test/navigation/made_terrain.hpp"

using namespace skein::navigation;
using namespace skein::navigation::testing;

namespace {

double geodesic_m(double latitude, double longitude, double to_latitude, double to_longitude) {
  double distance = 0;
  GeographicLib::Geodesic::WGS84().Inverse(latitude, longitude, to_latitude, to_longitude,
                                           distance);
  return distance;
}

/// The highest post within a quarter of the terrain.
AE_navigator::GroundPoint peak(const Terrain& terrain, bool north, bool east) {
  int best_row = north ? terrain.rows() / 2 : 0;
  int best_column = east ? terrain.columns() / 2 : 0;
  const int rows = best_row + terrain.rows() / 2;
  const int columns = best_column + terrain.columns() / 2;
  for (int row = best_row, column0 = best_column; row < rows; ++row) {
    for (int column = column0; column < columns; ++column) {
      if (terrain.post_m(row, column) > terrain.post_m(best_row, best_column)) {
        best_row = row;
        best_column = column;
      }
    }
  }
  return {best_row * terrain.north_spacing_m(), best_column * terrain.east_spacing_m()};
}

}  // namespace

TEST_CASE("Peaks of a tile are as far apart as the geodesics between them are long") {
  const TemporaryFolder folder;
  const auto file = folder.path() / "N51E006.hgt";
  write_hgt(file, [](int row, int column) {
    const int from_peak =
        std::max(std::abs(std::abs(row - 600) - 540), std::abs(std::abs(column - 600) - 540));
    return std::max(0, 300 - 30 * from_peak);
  });
  const Terrain terrain = read_hgt(file);
  const auto south_west = peak(terrain, false, false), south_east = peak(terrain, false, true);
  const auto north_west = peak(terrain, true, false), north_east = peak(terrain, true, true);
  constexpr double kPost_m = 70;  // Half a post at each end, north and east.
  CHECK(distance_m(south_west, south_east) ==
        Approx(geodesic_m(51.05, 6.05, 51.05, 6.95)).margin(kPost_m));
  CHECK(distance_m(north_west, north_east) ==
        Approx(geodesic_m(51.95, 6.05, 51.95, 6.95)).margin(kPost_m));
  CHECK(distance_m(south_west, north_west) ==
        Approx(geodesic_m(51.05, 6.05, 51.95, 6.05)).margin(kPost_m));
  CHECK(distance_m(south_west, north_east) ==
        Approx(geodesic_m(51.05, 6.05, 51.95, 6.95)).margin(kPost_m));
}

TEST_CASE("A place in a frame is where geodesics from its middle lead") {
  const TemporaryFolder folder;
  for (const auto& [name, south, west] : {std::tuple{"N51E006.hgt", 51, 6},
                                          {"S34W071.hgt", -34, -71},
                                          {"N00E000.hgt", 0, 0},
                                          {"N83W180.hgt", 83, -180}}) {
    INFO(name);
    write_hgt(folder.path() / name, [](int, int) { return 1; });
    const Terrain terrain = read_hgt(folder.path() / name);
    const EarthFrame& frame = terrain.frame().value();
    const auto middle = frame.to_ground({south + 0.5, west + 0.5});
    for (const auto& [latitude, longitude] : {std::pair{0.1, 0.2}, {0.9, 0.3}, {0.7, 0.95}}) {
      const auto there = frame.to_ground({south + latitude, west + longitude});
      CHECK(distance_m(middle, there) ==
            Approx(geodesic_m(south + 0.5, west + 0.5, south + latitude, west + longitude))
                .epsilon(0)
                .margin(1e-6));
      const EarthPlace back = frame.to_earth(there);
      CHECK(back.latitude_deg == Approx(south + latitude).epsilon(0).margin(1e-9));
      CHECK(back.longitude_deg == Approx(west + longitude).epsilon(0).margin(1e-9));
    }
  }
}

TEST_CASE(
    "Edges of a route are as long as the geodesics between their ends to 20 parts in a million") {
  const TemporaryFolder folder;
  const auto file = folder.path() / "N51E006.hgt";
  write_hgt(file, [](int, int) { return 1; });
  const Terrain terrain = read_hgt(file);
  const double north = terrain.north_extent_m(), east = terrain.east_extent_m();
  for (const auto& [a, b] :
       {std::pair<AE_navigator::GroundPoint, AE_navigator::GroundPoint>{{0, 0}, {north, east}},
        {{0, 0}, {0, east}},
        {{0, east}, {north, east}},
        {{north, 0}, {north - 1000, 1000}},
        {{0, 0}, {0, 1000}}}) {
    const EarthPlace from = terrain.frame()->to_earth(a), to = terrain.frame()->to_earth(b);
    CHECK(distance_m(a, b) == Approx(geodesic_m(from.latitude_deg, from.longitude_deg,
                                                to.latitude_deg, to.longitude_deg))
                                  .epsilon(20e-6));
  }
}

TEST_CASE("A terrain is the largest rectangle within its tile") {
  const TemporaryFolder folder;
  for (const auto& [name, south, west] : {std::tuple{"N59E010.hgt", 59, 10},
                                          {"S56W070.hgt", -56, -70},
                                          {"N00E033.hgt", 0, 33},
                                          {"S01E179.hgt", -1, 179}}) {
    INFO(name);
    write_hgt(folder.path() / name, [](int, int) { return 1; });
    const Terrain terrain = read_hgt(folder.path() / name);
    const double north = terrain.north_extent_m(), east = terrain.east_extent_m();
    for (const double share : {0.0, 0.25, 0.5, 1.0}) {
      for (const auto& point : {AE_navigator::GroundPoint{0, share * east},
                                {north, share * east},
                                {share * north, 0},
                                {share * north, east}}) {
        const EarthPlace place = terrain.frame()->to_earth(point);
        CHECK(place.latitude_deg >= south - 1e-9);
        CHECK(place.latitude_deg <= south + 1 + 1e-9);
        const double from_west = std::remainder(place.longitude_deg - west - 0.5, 360);
        CHECK(std::abs(from_west) <= 0.5 + 1e-9);
      }
    }
    const double nearer_pole = south < 0 ? south : south + 1;
    CHECK(north == Approx(geodesic_m(south, west, south + 1, west)).epsilon(2e-3));
    CHECK(east == Approx(geodesic_m(nearer_pole, west, nearer_pole, west + 1)).epsilon(2e-3));
  }
}
