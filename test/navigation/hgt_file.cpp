#include <catch2/catch.hpp>
#include <cmath>

#include "made_terrain.hpp"
#include "skein/error.hpp"

using namespace skein::navigation;
using namespace skein::navigation::testing;
using Catch::Contains;

TEST_CASE("A tile is read with its first row in the north") {
  const TemporaryFolder folder;
  const auto file = folder.path() / "N53E027.hgt";
  write_hgt(file, [](int row, int column) { return row == 1200 ? 900 : column == 0 ? -7 : 300; });
  const Terrain terrain = read_hgt(file);
  CHECK(terrain.rows() == 1201);
  CHECK(terrain.post_m(1200, 600) == 900);
  CHECK(terrain.post_m(600, 0) == -7);
  CHECK(terrain.post_m(600, 1) == 300);
}

TEST_CASE("A tile is as large as its degree on the earth") {
  const TemporaryFolder folder;
  for (const char* name : {"N53E027.hgt", "s54w001.hgt"}) {
    write_hgt(folder.path() / name, [](int, int) { return 1; });
    const Terrain terrain = read_hgt(folder.path() / name);
    CHECK(terrain.north_extent_m() == Approx(111195.08));
    CHECK(terrain.east_extent_m() == Approx(111195.08 * std::cos(53.5 * 3.14159265358979 / 180)));
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
  CHECK(terrain.post_m(11, 11) == 777);
  CHECK(terrain.post_m(10, 15) == 777);
  CHECK(terrain.post_m(900, 1200) == 50);
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
  write_hgt(at("N04E001.hgt"), [](int, int) { return -32768; });
  CHECK_THAT(refusal(at("N04E001.hgt")), Contains("only voids"));
  write_hgt(at("N05E001.hgt"), [](int row, int) { return row == 7 ? 12000 : 0; });
  CHECK_THAT(refusal(at("N05E001.hgt")), Contains("12000 m in row 1194, column 1"));
  std::filesystem::create_directory(at("N06E001.hgt"));
  CHECK_THAT(refusal(at("N06E001.hgt")), Contains("cannot be read"));
}
