#include "geodesy/tile.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <fstream>

namespace tile_test {

using namespace reconnaissance;

TEST_CASE("a tile's places are those of WGS-84, and its distances nearly") {
  const Geodetic home{53.3, 27.4, 180}, other{53.5, 27.8, 400};
  const Tile tile(home);
  CHECK(tile.file_name() == "N53E027.hgt");
  CHECK(Tile({-0.5, -0.5, 0}).file_name() == "S01W001.hgt");
  const Geodetic back = tile.to_geodetic(tile.to_tile(other));
  CHECK(back.latitude_deg == Approx(other.latitude_deg).epsilon(1e-12));
  CHECK(back.longitude_deg == Approx(other.longitude_deg).epsilon(1e-12));
  CHECK(back.height_m == 400);
  const Local true_way = LocalFrame(home).to_local(other);
  const Local a = tile.to_tile(home), b = tile.to_tile(other);
  CHECK(map_distance_m(b, a) ==
        Approx(std::hypot(true_way.north_m, true_way.east_m)).epsilon(2e-5));
}

TEST_CASE("a tile's file has the ground by its posts, from the north-west on") {
  const std::filesystem::path file = std::filesystem::temp_directory_path() / "tile_test.hgt";
  const Geodetic home{53.3, 27.4, 180};
  const LocalFrame frame(home);
  // It rises to the north and to the east.
  const auto ground = [](double north_m, double east_m) {
    return 1000 + north_m / 100 + east_m / 200;
  };
  Tile(home).write(file, frame, ground);
  REQUIRE(file_size(file) == 2 * 1201 * 1201);
  std::ifstream stream(file, std::ios::binary);
  for (const auto& [row, column] : {std::pair(0, 0), std::pair(30, 7), std::pair(1200, 1200)}) {
    stream.seekg(2 * (1201 * row + column));
    const int high = stream.get(), low = stream.get();
    const Local place = frame.to_local({54 - row / 1200.0, 27 + column / 1200.0, 0});
    CHECK(high * 256 + low == Approx(ground(place.north_m, place.east_m) + 0.5).margin(0.51));
  }
  std::filesystem::remove(file);
}

}  // namespace tile_test
