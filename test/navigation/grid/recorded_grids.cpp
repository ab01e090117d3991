#include <catch2/catch.hpp>
#include <cmath>
#include <cstdio>
#include <cstdlib>

#include "navigation/grid/scenario.hpp"
#include "reference.hpp"

using namespace skein::navigation::grid;
using namespace skein::navigation::grid::testing;

namespace {

/// The maps of the test data with this ending; ends the program as skipped where there are none.
std::vector<std::filesystem::path> maps(const char* ending) {
  const char* data = std::getenv("SKEIN_TEST_DATA");
  const std::filesystem::path folder = data ? std::filesystem::path(data) / "movingai" : "";
  std::vector<std::filesystem::path> found;
  if (data && std::filesystem::is_directory(folder)) {
    for (const auto& entry : std::filesystem::directory_iterator(folder)) {
      if (entry.path().extension() == ending) found.push_back(entry.path());
    }
  }
  if (!found.empty()) return found;
  std::fprintf(stderr, "skipped: SKEIN_TEST_DATA names no folder with movingai/*%s\n", ending);
  std::_Exit(77);
}

void check_all_recorded(const std::filesystem::path& file, const std::string& scenario_ending) {
  const auto map = std::make_shared<const GridMap>(read_grid_map(file));
  const std::vector<Scenario> scenarios = read_scenarios(file.string() + scenario_ending, *map);
  REQUIRE_FALSE(scenarios.empty());
  for (const std::string& name : grid_planner_names(*map)) {
    if (name == "theta") continue;
    INFO(name << " on " << file.filename().string());
    const auto planner = make_grid_planner(name, map);
    for (std::size_t i = 0; i < scenarios.size(); ++i) {
      INFO("scenario " << i);
      const auto path = planner->plan(scenarios[i].start, scenarios[i].goal);
      REQUIRE(is_recorded_result(scenarios[i], path ? std::optional(path->length) : std::nullopt));
      if (path) REQUIRE(fault_of(*map, *path, scenarios[i].start, scenarios[i].goal) == "");
    }
  }
}

}  // namespace

TEST_CASE("On recorded planes every exact planner finds every recorded result") {
  for (const auto& map : maps(".map")) check_all_recorded(map, ".scen");
}

TEST_CASE("In recorded spaces every planner finds every recorded result") {
  for (const auto& map : maps(".3dmap")) check_all_recorded(map, ".3dscen");
}

TEST_CASE("On recorded planes any-angle paths lie between the air line and the recorded length") {
  for (const auto& file : maps(".map")) {
    const auto map = std::make_shared<const GridMap>(read_grid_map(file));
    const auto planner = make_grid_planner("theta", map);
    for (const Scenario& scenario : read_scenarios(file.string() + ".scen", *map)) {
      const auto path = planner->plan(scenario.start, scenario.goal);
      REQUIRE(path.has_value() == scenario.length.has_value());
      if (!path) continue;
      const int dx = scenario.goal.x - scenario.start.x;
      const int dy = scenario.goal.y - scenario.start.y;
      REQUIRE(path->length >= std::hypot(dx, dy) - 1e-6);
      REQUIRE(path->length <= *scenario.length + kRecordedPrecision);
    }
  }
}
