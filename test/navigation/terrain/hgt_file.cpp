#include <catch2/catch.hpp>
#include <cmath>

#include "skein/error.hpp"
#include "test/navigation/made_terrain.hpp"

using namespace skein::navigation;
using namespace skein::navigation::testing;
using Catch::Contains;

TEST_CASE("A tile is read with its first row in the north") {
  const TemporaryFolder folder;
  const auto file = folder.path() / "N53E027.hgt";
  write_hgt(file, [](int row, int column) { return row > 1000 ? 900 : column < 200 ? -7 : 300; });
  const Terrain terrain = read_hgt(file);
  CHECK(terrain.rows() == 1201);
  CHECK(height_at(terrain, 53.9, 27.5) == 900);
  CHECK(height_at(terrain, 53.5, 27.1) == -7);
  CHECK(height_at(terrain, 53.5, 27.9) == 300);
}

TEST_CASE("No post of a tile stands above the ground, however sharp its peaks are") {
  const TemporaryFolder folder;
  const auto file = folder.path() / "N46E008.hgt";
  const auto post = [](int row, int column) {
    return row % 7 == 3 && column % 5 == 2 ? 2000 + row % 11 : 5 * ((row * 7 + column * 13) % 30);
  };
  write_hgt(file, post);
  const Terrain terrain = read_hgt(file);
  for (int row = 20; row < 1180; row += 3) {
    for (int column = 20; column < 1180; column += 7) {
      const double ground = height_at(terrain, 46 + row / 1200.0, 8 + column / 1200.0);
      if (ground < post(row, column) - 1) {
        FAIL("post " << row << ", " << column << ": " << ground << " < " << post(row, column));
      }
    }
  }
}

TEST_CASE("Each void becomes as high as the highest post beside it") {
  const TemporaryFolder folder;
  const auto file = folder.path() / "N00E000.hgt";
  write_hgt(file, [](int row, int column) {
    if (row >= 10 && row <= 12 && column >= 10 && column <= 15) return -32768;
    if (row == 900 && column == 1200) return -32768;
    if (row == 13 && column == 12) return 777;
    if (row == 13 && column == 16) return 999;  // Beside by the corner only.
    return 50;
  });
  const Terrain terrain = read_hgt(file);
  const auto at = [&](int row, int column) {
    return height_at(terrain, row / 1200.0, column / 1200.0);
  };
  CHECK(at(11, 11) == Approx(777).margin(20));
  CHECK(at(11, 14) == Approx(777).margin(20));
  CHECK(at(900, 1200) == 50);
  CHECK(terrain.lowest_m() == 50);
}

TEST_CASE("A file that is no tile is refused with its name and the reason") {
  const TemporaryFolder folder;
  const auto at = [&](const char* name) { return folder.path() / name; };
  const auto refusal = [](const std::filesystem::path& file) -> std::string {
    try {
      read_hgt(file);
    } catch (const skein::InvalidArgument& error) {
      return error.what();
    }
    return "accepted";
  };
  CHECK_THAT(refusal(at("N01E001.hgt")), Contains("N01E001.hgt") && Contains("cannot be read"));

  std::ofstream(at("N02E001.hgt")) << std::string(2884801, 'x');
  CHECK_THAT(refusal(at("N02E001.hgt")), Contains("2884801 bytes") && Contains("cut off"));
  std::ofstream(at("N03E001.hgt")) << "";
  CHECK_THAT(refusal(at("N03E001.hgt")), Contains("0 bytes"));
  std::ofstream(at("alps.hgt")) << std::string(2884802, '\0');
  CHECK_THAT(refusal(at("alps.hgt")), Contains("must be like N53E027.hgt"));
  std::ofstream(at("N95E001.hgt")) << std::string(2884802, '\0');
  CHECK_THAT(refusal(at("N95E001.hgt")), Contains("no such latitude"));
  for (const char* polar : {"N84E001.hgt", "N89E001.hgt", "S81E001.hgt", "s90w180.hgt"}) {
    CHECK_THAT(refusal(at(polar)), Contains(polar) && Contains("80 degrees south to 84 degrees"));
  }
  CHECK_THAT(refusal(at("N01E180.hgt")), Contains("no such longitude"));
  CHECK_THAT(refusal(at("N01W181.hgt")), Contains("no such longitude"));
  CHECK_THAT(refusal(at("S00E001.hgt")), Contains("N00 and E000"));
  CHECK_THAT(refusal(at("N01W000.hgt")), Contains("N00 and E000"));
  for (const char* outermost : {"N83W180.hgt", "S80E179.hgt"}) {
    write_hgt(at(outermost), [](int, int) { return 5; });
    CHECK(refusal(at(outermost)) == "accepted");
  }
  write_hgt(at("N04E001.hgt"), [](int, int) { return -32768; });
  CHECK_THAT(refusal(at("N04E001.hgt")), Contains("only voids"));
  write_hgt(at("N05E001.hgt"), [](int row, int) { return row == 7 ? 12000 : 0; });
  CHECK_THAT(refusal(at("N05E001.hgt")), Contains("12000 m in row 1194, column 1"));
  std::filesystem::create_directory(at("N06E001.hgt"));
  CHECK_THAT(refusal(at("N06E001.hgt")), Contains("cannot be read"));
}
