#include <unistd.h>

#include <catch2/catch.hpp>
#include <fstream>

#include "navigation/grid/scenario.hpp"
#include "skein/error.hpp"

using namespace skein;
using namespace skein::navigation::grid;
using Catch::Contains;

namespace {

/// A file with this text, gone with the object.
class TextFile {
 public:
  explicit TextFile(const std::string& text)
      : path_(std::filesystem::temp_directory_path() /
              ("skein_grid_" + std::to_string(::getpid()) + "_" + std::to_string(++count_))) {
    std::ofstream(path_) << text;
  }
  ~TextFile() { std::filesystem::remove(path_); }
  TextFile(const TextFile&) = delete;
  TextFile& operator=(const TextFile&) = delete;

  const std::filesystem::path& path() const { return path_; }

 private:
  static inline int count_ = 0;
  std::filesystem::path path_;
};

GridMap map_of(const std::string& text) { return read_grid_map(TextFile(text).path()); }

std::vector<Scenario> scenarios_of(const std::string& text, const GridMap& map) {
  return read_scenarios(TextFile(text).path(), map);
}

}  // namespace

TEST_CASE("A plane is read with its free and its blocked letters") {
  const GridMap map = map_of("type octile\r\nheight 2\r\nwidth 4\r\nmap\r\n.GS@\r\nOTW.\r\n");
  CHECK(map.width() == 4);
  CHECK(map.height() == 2);
  CHECK(map.is_plane());
  for (const int x : {0, 1, 2}) {
    CHECK(map.is_free({x, 0}));
    CHECK_FALSE(map.is_free({x, 1}));
  }
  CHECK_FALSE(map.is_free({3, 0}));
  CHECK(map.is_free({3, 1}));
}

TEST_CASE("A space is free but for the cells that are listed") {
  const GridMap map = map_of("voxel 3 4 5\n2 3 4\n0 0 1\n");
  CHECK(map.depth() == 5);
  CHECK_FALSE(map.is_free({2, 3, 4}));
  CHECK_FALSE(map.is_free({0, 0, 1}));
  CHECK(map.is_free({0, 0, 0}));
  CHECK_FALSE(map.is_free({0, 0, 5}));
}

TEST_CASE("What is wrong with a map is said with its line") {
  CHECK_THROWS_WITH(map_of(""), Contains(":1: ") && Contains("type octile"));
  CHECK_THROWS_WITH(map_of("type tile\n"), Contains(":1: "));
  CHECK_THROWS_WITH(map_of("type octile\nheight x\n"), Contains(":2: 'x' is not a whole number"));
  CHECK_THROWS_WITH(map_of("type octile\nheight 1\n\n"), Contains("ends before 'width'"));
  CHECK_THROWS_WITH(map_of("type octile\nheight 0\nwidth 1\nmap\n"), Contains("no map of 1 x 0"));
  CHECK_THROWS_WITH(map_of("type octile\nheight 2\nwidth 2\nmap\n..\n...\n"),
                    Contains(":6: the row has 3 cells instead of 2"));
  CHECK_THROWS_WITH(map_of("type octile\nheight 1\nwidth 2\nmap\n.?\n"),
                    Contains(":5: '?' in column 1"));
  CHECK_THROWS_WITH(map_of("type octile\nheight 2\nwidth 2\nmap\n..\n"),
                    Contains(":6: the file ends after 1 of 2 rows"));
  CHECK_THROWS_WITH(map_of("type octile\nheight 1\nwidth 2\nmap\n..\n..\n"),
                    Contains(":6: there is more"));
  CHECK_THROWS_WITH(map_of("voxel 2 2 2\n0 0\n"), Contains(":2: expected a blocked cell"));
  CHECK_THROWS_WITH(map_of("voxel 2 2 2\n\n0 0 2\n"), Contains(":3: '0 0 2' is outside"));
  CHECK_THROWS_WITH(map_of("voxel 99999 99999 99999\n"), Contains(":1: there is no map"));
  CHECK_THROWS_AS(read_grid_map("no such file"), InvalidArgument);
}

TEST_CASE(
    "Scenarios are read with tabs or blanks, and a length of 0 between two cells means no path") {
  const GridMap map(3, 2);
  const auto scenarios = scenarios_of(
      "version 1.0\n0\tm\t3\t2\t0\t1\t2\t0\t2.41421\n0 m 3 2 0 0 1 1 0\n"
      "0 m 3 2 1 1 1 1 0\n",
      map);
  REQUIRE(scenarios.size() == 3);
  CHECK(scenarios[0].start == Cell{0, 1});
  CHECK(scenarios[0].goal == Cell{2, 0});
  CHECK(scenarios[0].length == 2.41421);
  CHECK_FALSE(scenarios[1].length);
  CHECK(scenarios[2].length == 0.0);
}

TEST_CASE("A result is the recorded one within its precision, and no path is a result") {
  const Scenario found{{0, 0}, {2, 0}, 2.0};
  CHECK(is_recorded_result(found, 2.009));
  CHECK_FALSE(is_recorded_result(found, 2.011));
  CHECK_FALSE(is_recorded_result(found, std::nullopt));
  const Scenario none{{0, 0}, {2, 0}, std::nullopt};
  CHECK(is_recorded_result(none, std::nullopt));
  CHECK_FALSE(is_recorded_result(none, 0.0));
}

TEST_CASE("What is wrong with scenarios is said with its line") {
  const GridMap plane(3, 2);
  CHECK_THROWS_WITH(scenarios_of("0 m 3 2 0 0 1 1 0\n", plane), Contains(":1: "));
  CHECK_THROWS_WITH(scenarios_of("version 1\n0 m 3 2 0 0 1 1\n", plane),
                    Contains(":2: expected 9 columns, found 8"));
  CHECK_THROWS_WITH(scenarios_of("version 1\n0 m 4 2 0 0 1 1 0\n", plane),
                    Contains(":2: is meant for a map of 4 x 2"));
  CHECK_THROWS_WITH(scenarios_of("version 1\n0 m 3 2 3 0 1 1 0\n", plane),
                    Contains(":2: the start is outside"));
  CHECK_THROWS_WITH(scenarios_of("version 1\n0 m 3 2 0 0 1 1 1.x\n", plane),
                    Contains(":2: '1.x' is not a number"));
  const GridMap space(3, 2, 2);
  CHECK_THROWS_WITH(scenarios_of("version 1\nm\n0 0 0 1 1 2 1.7 1\n", space),
                    Contains(":3: the goal is outside"));
}
