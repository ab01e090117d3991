#include <catch2/catch.hpp>
#include <cmath>

#include "made_terrain.hpp"
#include "navigation/route_checker/height_grid.hpp"
#include "skein/error.hpp"

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
    CHECK(terrain.post_m(0, 0) == 0);
    CHECK(terrain.post_m(made.rows - 1, 0) == (made.rows - 1) / 3);
    CHECK(terrain.post_m(0, made.columns - 1) == -((made.columns - 1) / 4));
    CHECK(terrain.north_extent_m() == Approx(111195.08));
    CHECK(terrain.east_extent_m() == Approx(111195.08 * std::cos(53.5 * 3.14159265358979 / 180)));
  }
}

TEST_CASE("A DTED tile of the southern hemisphere is as large as its latitude says") {
  const DtedFile file(MadeDted{0, 300, "0540000S"}.bytes(slopes));
  CHECK(read_dted(file.path()).east_extent_m() ==
        Approx(111195.08 * std::cos(53.5 * 3.14159265358979 / 180)));
}

TEST_CASE("A void of a DTED tile becomes as high as the highest post beside it") {
  const DtedFile file(MadeDted{}.bytes([](int row, int column) {
    if (row >= 10 && row <= 12 && column >= 10 && column <= 15) return -32767;
    return row == 13 && column == 12 ? 777 : -50;
  }));
  const Terrain terrain = read_dted(file.path());
  CHECK(terrain.post_m(11, 11) == 777);
  CHECK(terrain.post_m(10, 15) == 777);
  CHECK(terrain.lowest_m() == -50);
}

TEST_CASE("The checker reads a DTED tile by its own means, and finds the same ground") {
  const DtedFile file(MadeDted{0, 600}.bytes([](int row, int column) {
    return row % 9 == 4 && column % 7 < 2 ? -32767 : slopes(row, column);
  }));
  const Terrain terrain = read_dted(file.path());
  const HeightGrid ground = read_height_grid(file.path());
  CHECK(ground.heights_m == terrain.heights_m());
  CHECK(ground.north_spacing_m == Approx(terrain.north_spacing_m()).epsilon(1e-12));
  CHECK(ground.east_spacing_m == Approx(terrain.east_spacing_m()).epsilon(1e-12));
}

TEST_CASE("A problem finds its DTED tile by the file's name") {
  const DtedFile file(MadeDted{}.bytes(slopes));
  TerrainProvider provider({file.path().parent_path()});
  CHECK(provider.load("n53.dt0")->post_m(120, 0) == 360);
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
  CHECK_THAT(spoilt(kFirst + 3 * kRecord, "x"), Contains("column 3 does not begin with AA"));
  CHECK_THAT(spoilt(kFirst + 3 * kRecord + 5, "\4"), Contains("column 3 says that it is column 4"));
  CHECK_THAT(spoilt(kFirst + 3 * kRecord + 20, "\x7f"), Contains("the checksum of column 3"));
  CHECK_THAT(refusal(MadeDted{}.bytes([](int row, int) { return row == 7 ? -12000 : 0; })),
             Contains("-12000 m in column 0, row 7"));
  CHECK_THAT(refusal(MadeDted{}.bytes([](int, int) { return -32767; })), Contains("only voids"));
  CHECK_THROWS_WITH(read_dted("nowhere/n53.dt0"), Contains("nowhere/n53.dt0: cannot be read"));
}
