#include "navigation/threats/radar_exposure.hpp"

#include <catch2/catch.hpp>
#include <cmath>

#include "test/navigation/made_terrain.hpp"

using namespace skein::navigation;
using namespace skein::navigation::testing;
using AE_navigator::Position;
using AE_navigator::RadarSite;

namespace {

const RadarSite kSite{"R", {10000, 10000}, 20, 4000, 1};

}  // namespace

TEST_CASE(
    "At its range a radar exposes an aircraft by its strength, at half of it sixteen times as "
    "much") {
  CHECK(exposure_rate(4000, 1, 4000) == Approx(1));
  CHECK(exposure_rate(4000, 3, 2000) == Approx(48));
  CHECK(exposure_rate(4000, 1, 10) == Approx(exposure_rate(4000, 1, 1000)));
}

TEST_CASE("A straight pass is as exposed as the integral says") {
  const Terrain terrain = flat_terrain();
  const RadarExposure exposure(terrain, std::span(&kSite, 1));
  // Past the antenna at a distance h, from -l to l: R^4 (l / (h^2 (h^2 + l^2)) + atan(l / h) /
  // h^3).
  const double h = std::hypot(3000, 500 - 20);
  const double l = 6000;
  const double expected =
      std::pow(4000, 4) * (l / (h * h * (h * h + l * l)) + std::atan(l / h) / std::pow(h, 3));
  CHECK(exposure.along({13000, 10000 - l, 500}, {13000, 10000 + l, 500}) ==
        Approx(expected).epsilon(1e-4));
}

TEST_CASE("Passes on either side of a radar are equally exposed") {
  const Terrain terrain = flat_terrain();
  const RadarExposure exposure(terrain, std::span(&kSite, 1));
  const double east = exposure.along({4000, 12500, 300}, {16000, 12500, 300});
  CHECK(exposure.along({4000, 7500, 300}, {16000, 7500, 300}) == Approx(east));
  CHECK(exposure.along({16000, 12500, 300}, {4000, 12500, 300}) == Approx(east));
  CHECK(exposure.along({12500, 4000, 300}, {12500, 16000, 300}) == Approx(east));
}

TEST_CASE("A ridge hides what is behind and below it, not what is above") {
  const Terrain terrain =
      make_terrain(201, 100, [](double north, double) { return north == 12000 ? 400.0 : 0.0; });
  const RadarExposure exposure(terrain, std::span(&kSite, 1));
  CHECK(exposure.rate({14000, 10000, 300}) == 0);
  CHECK(exposure.rate({11500, 10000, 300}) > 0);
  // The ray over the ridge is at 20 m + 2 * 380 m above the point, less what the earth curves.
  CHECK(exposure.rate({14000, 10000, 775}) == 0);
  CHECK(exposure.rate({14000, 10000, 785}) > 0);
}

TEST_CASE("Far away the curve of the earth hides what is low") {
  const Terrain terrain = make_terrain(1001, 100, [](double, double) { return 0.0; });
  const RadarSite site{"R", {500, 500}, 20, 4000, 1};
  const RadarExposure exposure(terrain, std::span(&site, 1));
  // Horizons of 18.4 km for the mast and 41.2 km for 100 m (4.12 km per root of a metre).
  CHECK(exposure.rate({500 + 58000, 500, 100}) > 0);
  CHECK(exposure.rate({500 + 61500, 500, 100}) == 0);
}

TEST_CASE("Exposures of several sites add up") {
  const Terrain terrain = flat_terrain();
  const RadarSite sites[] = {kSite, {"S", {5000, 5000}, 30, 2000, 2}};
  const Position a{3000, 8000, 200}, b{12000, 14000, 250};
  const double one = RadarExposure(terrain, std::span(sites, 1)).along(a, b);
  const double other = RadarExposure(terrain, std::span(sites + 1, 1)).along(a, b);
  CHECK(RadarExposure(terrain, sites).along(a, b) == Approx(one + other));
  CHECK(RadarExposure(terrain, {}).along(a, b) == 0);
}
