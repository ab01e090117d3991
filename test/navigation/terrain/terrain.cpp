#include "navigation/terrain/terrain.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <thread>

#include "navigation/terrain/terrain_ceilings.hpp"
#include "skein/error.hpp"
#include "test/navigation/made_terrain.hpp"

using namespace skein::navigation;
using namespace skein::navigation::testing;

TEST_CASE("Between posts the ground is bilinear") {
  const Terrain terrain("t", 2, 3, 10, 20, {0, 10, 20, 40, 50, 100});
  CHECK(terrain.height_m(0, 0) == 0);
  CHECK(terrain.height_m(0, 20) == 10);
  CHECK(terrain.height_m(10, 40) == 100);
  CHECK(terrain.height_m(5, 10) == Approx(25));
  CHECK(terrain.height_m(5, 30) == Approx(45));
  CHECK(terrain.north_extent_m() == 10);
  CHECK(terrain.east_extent_m() == 40);
}

TEST_CASE("Beyond its edge a terrain is as high as at its edge") {
  const Terrain terrain("t", 2, 2, 10, 10, {1, 2, 3, 4});
  CHECK(terrain.height_m(-5, -5) == 1);
  CHECK(terrain.height_m(50, 50) == 4);
  CHECK_FALSE(terrain.contains(10.1, 5));
  CHECK(terrain.contains(10, 0));
}

TEST_CASE("A terrain that does not hold together is refused with what is wrong") {
  using Catch::Contains;
  const auto message = [](auto make) -> std::string {
    try {
      make();
    } catch (const skein::InvalidArgument& error) {
      return error.what();
    }
    return "accepted";
  };
  const float nan = std::nanf("");
  CHECK_THAT(message([] { Terrain("t", 1, 2, 1, 1, {0, 0}); }), Contains("1 x 2 posts"));
  CHECK_THAT(message([] { Terrain("t", 2, 2, 0, 1, {0, 0, 0, 0}); }), Contains("0 m by 1 m"));
  CHECK_THAT(message([] { Terrain("t", 2, 2, 1, 1, {0, 0, 0}); }), Contains("3 heights"));
  CHECK_THAT(message([=] { Terrain("t", 2, 2, 1, 1, {0, nan, 0, 0}); }), Contains("not finite"));
}

TEST_CASE("The same seed invents the same mountains, another seed others") {
  const Terrain one = make_synthetic_terrain(7);
  CHECK(one.heights_m() == make_synthetic_terrain(7).heights_m());
  CHECK(one.heights_m() != make_synthetic_terrain(8).heights_m());
  CHECK(one.name() == "synthetic:7");
  CHECK(one.highest_m() - one.lowest_m() > 1000);
}

TEST_CASE("A provider reads each terrain once, whoever asks first") {
  TerrainProvider provider;
  std::vector<std::shared_ptr<const Terrain>> got(4);
  std::vector<std::thread> threads;
  for (auto& terrain : got) threads.emplace_back([&] { terrain = provider.load("synthetic:3"); });
  for (auto& thread : threads) thread.join();
  for (const auto& terrain : got) CHECK(terrain == got[0]);
}

TEST_CASE("A provider gives a terrain of the caller's own by its name") {
  TerrainProvider provider;
  const auto own =
      std::make_shared<const Terrain>(make_terrain(3, 100, [](double, double) { return 7; }));
  provider.add(own);
  CHECK(provider.load("made") == own);
}

TEST_CASE("A provider names what it was asked for and where it looked") {
  TerrainProvider provider({"/nowhere/tiles"});
  CHECK_THROWS_WITH(provider.load("synthetic:seven"), Catch::Contains("'synthetic:seven'"));
  CHECK_THROWS_WITH(provider.load("synthetic:-1"), Catch::Contains("from 0 to 4294967295"));
  CHECK_THROWS_WITH(provider.load("alps"), Catch::Contains("'alps'"));
  CHECK_THROWS_WITH(provider.load("N01E001.hgt"), Catch::Contains("/nowhere/tiles/N01E001.hgt"));
}

TEST_CASE("No ground along a short edge is above the ceilings of its blocks") {
  const Terrain terrain = make_synthetic_terrain(5);
  const TerrainCeilings ceilings(terrain);
  std::uint32_t state = 1;
  const auto random = [&] { return (state = state * 1664525u + 1013904223u) / 4294967296.0; };
  for (int i = 0; i < 20000; ++i) {
    const double heading = random() * 6.283;
    const double length = random() * ceilings.block_m();
    const AE_navigator::Position a{random() * terrain.north_extent_m(),
                                   random() * terrain.east_extent_m(), 0};
    const AE_navigator::Position b{a.north_m + length * std::cos(heading),
                                   a.east_m + length * std::sin(heading), 0};
    const double share = random();
    const double height = terrain.height_m(std::lerp(a.north_m, b.north_m, share),
                                           std::lerp(a.east_m, b.east_m, share));
    REQUIRE(height <= ceilings.above(a, b) + 1e-3);
  }
}
