#include <catch2/catch.hpp>
#include <cmath>

#include "navigation/route_checker/height_grid.hpp"
#include "skein/error.hpp"
#include "test/navigation/made_terrain.hpp"

using namespace skein::navigation;
using namespace skein::navigation::testing;
using Catch::Contains;

namespace {

int slopes(int row, int column) { return 3 * row - 2 * column; }

/// A file with these bytes, in a folder of its own.
class DtedFile {
 public:
  explicit DtedFile(const std::string& bytes) { std::ofstream(path(), std::ios::binary) << bytes; }
  std::filesystem::path path() const { return folder_.path() / "n53.dt0"; }

 private:
  TemporaryFolder folder_;
};

std::string refusal(const std::string& bytes) {
  const DtedFile file(bytes);
  try {
    read_dted(file.path());
  } catch (const skein::InvalidArgument& error) {
    CHECK_THAT(error.what(), Contains("n53.dt0: "));
    return error.what();
  }
  return "accepted";
}

}  // namespace

TEST_CASE("A DTED tile of any level is read column by column from the south-west") {
  struct Case {
    MadeDted tile;
    int rows, columns;
  };
  for (const Case& made : {Case{{0, 300}, 121, 121}, Case{{0, 600}, 121, 61},
                           Case{{1, 60}, 1201, 601}, Case{{2, 20}, 3601, 1801}}) {
    const DtedFile file(made.tile.bytes([](int row, int column) { return row / 3 - column / 4; }));
    const Terrain terrain = read_dted(file.path());
    REQUIRE(terrain.rows() == made.rows);
    REQUIRE(terrain.columns() == made.columns);
    for (const auto& [row, column] : {std::pair{0.1, 0.2}, {0.9, 0.2}, {0.1, 0.8}, {0.95, 0.95}}) {
      const double expected = row * (made.rows - 1) / 3 - column * (made.columns - 1) / 4;
      CHECK(height_at(terrain, 53 + row, 27 + column) == Approx(expected).margin(2));
    }
  }
}

TEST_CASE("A DTED tile lies where its header says, and is as large as an SRTM tile there") {
  const TemporaryFolder folder;
  MadeDted made{1, 30, "0540000S", "0710000W"};
  const auto gentle = [](int row, int column) { return row / 2 - column / 4; };
  std::ofstream(folder.path() / "s54.dt1", std::ios::binary) << made.bytes(gentle);
  write_hgt(folder.path() / "S54W071.hgt", gentle);
  const Terrain dted = read_dted(folder.path() / "s54.dt1");
  const Terrain srtm = read_hgt(folder.path() / "S54W071.hgt");
  CHECK(dted.heights_m() == srtm.heights_m());
  CHECK(dted.east_spacing_m() == srtm.east_spacing_m());
  CHECK(dted.north_spacing_m() == srtm.north_spacing_m());
  CHECK(dted.frame()->to_earth({0, 0}).longitude_deg ==
        srtm.frame()->to_earth({0, 0}).longitude_deg);
}

TEST_CASE("A void of a DTED tile becomes as high as the highest post beside it") {
  const DtedFile file(MadeDted{}.bytes([](int row, int column) {
    if (row >= 10 && row <= 12 && column >= 10 && column <= 15) return -32767;
    return row == 13 && column == 12 ? 777 : -50;
  }));
  const Terrain terrain = read_dted(file.path());
  CHECK(height_at(terrain, 53 + 11 / 120.0, 27 + 11 / 120.0) == Approx(777).margin(99));
  CHECK(height_at(terrain, 53 + 11 / 120.0, 27 + 14 / 120.0) == Approx(777).margin(99));
  CHECK(terrain.lowest_m() == -50);
}

TEST_CASE("The checker reads a DTED tile by its own means, and finds the same ground") {
  const DtedFile file(MadeDted{0, 600}.bytes([](int row, int column) {
    return row % 9 == 4 && column % 7 < 2 ? -32767 : slopes(row, column);
  }));
  const Terrain terrain = read_dted(file.path());
  const HeightGrid ground = read_height_grid(file.path());
  CHECK(largest_difference_m(ground.heights_m, terrain.heights_m()) < 0.05);
  CHECK(ground.north_spacing_m == Approx(terrain.north_spacing_m()).epsilon(1e-12));
  CHECK(ground.east_spacing_m == Approx(terrain.east_spacing_m()).epsilon(1e-12));
}

TEST_CASE("A problem finds its DTED tile by the file's name") {
  const DtedFile file(MadeDted{}.bytes(slopes));
  TerrainProvider provider({file.path().parent_path()});
  CHECK(height_at(*provider.load("n53.dt0"), 53.5, 27.5) == Approx(60));
}

TEST_CASE("A damaged DTED file is refused with its name, the place and the reason") {
  const std::string good = MadeDted{}.bytes(slopes);
  constexpr std::size_t kFirst = 3428, kRecord = 12 + 2 * 121;
  const auto spoilt = [&](std::size_t at, const std::string& text) {
    return refusal(std::string(good).replace(at, text.size(), text));
  };
  CHECK(refusal(good) == "accepted");
  CHECK_THAT(refusal(good.substr(0, 700)), Contains("700 bytes"));
  CHECK_THAT(refusal(good.substr(0, good.size() - 1)), Contains("121 columns of 121 rows"));
  CHECK_THAT(refusal(good + "x"), Contains("121 columns of 121 rows"));
  CHECK_THAT(spoilt(0, "VOL"), Contains("UHL, DSI and ACC"));
  CHECK_THAT(spoilt(80, "XXX"), Contains("UHL, DSI and ACC"));
  CHECK_THAT(spoilt(728, "XXX"), Contains("UHL, DSI and ACC"));
  CHECK_THAT(spoilt(47, "12x1"), Contains("'12x1' is no number of columns"));
  CHECK_THAT(spoilt(24, "0400"), Contains("levels 0, 1 and 2"));
  CHECK_THAT(spoilt(47, "0061"), Contains("not one degree by one degree"));
  CHECK_THAT(spoilt(12, "0533000N"), Contains("whole degree"));
  CHECK_THAT(spoilt(19, "E"), Contains("whole degree"));
  CHECK_THAT(spoilt(4, "0270030E"), Contains("lies at longitude '0270030E'"));
  CHECK_THAT(spoilt(4, "1800000E"), Contains("no such longitude"));
  CHECK_THAT(spoilt(12, "0890000N"), Contains("80 degrees south to 84 degrees north"));
  CHECK_THAT(spoilt(kFirst + 3 * kRecord, "x"), Contains("column 3 does not begin with AA"));
  CHECK_THAT(spoilt(kFirst + 3 * kRecord + 5, "\4"), Contains("column 3 says that it is column 4"));
  CHECK_THAT(spoilt(kFirst + 3 * kRecord + 20, "\x7f"), Contains("the checksum of column 3"));
  CHECK_THAT(refusal(MadeDted{}.bytes([](int row, int) { return row == 7 ? -12000 : 0; })),
             Contains("-12000 m in column 0, row 7"));
  CHECK_THAT(refusal(MadeDted{}.bytes([](int, int) { return -32767; })), Contains("only voids"));
  CHECK_THROWS_WITH(read_dted("nowhere/n53.dt0"), Contains("nowhere/n53.dt0: cannot be read"));
}
