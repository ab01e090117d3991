#include "navigation/threats/threat_models.hpp"

#include <catch2/catch.hpp>
#include <cmath>

#include "skein/error.hpp"
#include "test/navigation/made_terrain.hpp"

using namespace skein::navigation;
using namespace skein::navigation::testing;
using AE_navigator::Position;

namespace {

const AE_navigator::MissileSite kMissiles{"S", {10000, 10000}, 10, 5000, 0.02};

}  // namespace

TEST_CASE("Kills are expected by the time within range of a missile site") {
  const Terrain terrain = flat_terrain();
  const MissileThreat threat(terrain, std::span(&kMissiles, 1));
  const double aside = std::hypot(3000, 500 - 10);
  const double inside_m = 2 * std::sqrt(5000.0 * 5000 - aside * aside);
  const Position route[] = {{13000, 2000, 500}, {13000, 9000, 500}, {13000, 18000, 500}};
  CHECK(threat.expected_kills(route, 100) == Approx(0.02 * inside_m / 100));
  CHECK(threat.expected_kills(route, 200) == Approx(threat.expected_kills(route, 100) / 2));
  const Position clear[] = {{16000, 2000, 500}, {16000, 18000, 500}};
  CHECK(threat.expected_kills(clear, 100) == 0);
  CHECK_THROWS_AS(threat.expected_kills(route, 0), skein::InvalidArgument);
}

TEST_CASE("The kills expected of two missile sites add up") {
  const Terrain terrain = flat_terrain();
  const AE_navigator::MissileSite other{"T", {12000, 6000}, 10, 3000, 0.01};
  const AE_navigator::MissileSite both[] = {kMissiles, other};
  const Position route[] = {{11000, 2000, 500}, {13000, 18000, 700}};
  CHECK(MissileThreat(terrain, both).expected_kills(route, 80) ==
        Approx(MissileThreat(terrain, std::span(&kMissiles, 1)).expected_kills(route, 80) +
               MissileThreat(terrain, std::span(&other, 1)).expected_kills(route, 80)));
}

TEST_CASE("A missile site does not reach behind a ridge") {
  const Terrain terrain =
      make_terrain(201, 100, [](double north, double) { return north == 12000 ? 400.0 : 0.0; });
  const MissileThreat threat(terrain, std::span(&kMissiles, 1));
  const Position low[] = {{13000, 2000, 300}, {13000, 18000, 300}};
  CHECK(threat.expected_kills(low, 100) == 0);
  const Position high[] = {{13000, 2000, 900}, {13000, 18000, 900}};
  CHECK(threat.expected_kills(high, 100) > 0);
}
