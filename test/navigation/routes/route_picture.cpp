#include "navigation/routes/route_picture.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <set>

#include "test/navigation/demo.hpp"
#include "test/tools/places.hpp"

using namespace skein::navigation;
using namespace skein::navigation::testing;
using Catch::Contains;

namespace {

using Json = nlohmann::json;

/// Planned once for all tests.
const std::vector<PicturedRoute>& two_routes() {
  static const Demo demo;
  static const std::vector<PicturedRoute> routes{{"A*, 2 s", demo.plan("AStar")},
                                                 {"RRTConnect, 50 ms", demo.plan("RRTConnect")}};
  return routes;
}

}  // namespace

TEST_CASE("A picture has the ground and what radars see of it, and stays below 2 MB") {
  const Demo demo;
  const std::string text = route_picture(*demo.terrain, demo.problem, two_routes(), "Routes");
  CHECK(text.size() < 2'000'000);
  const auto ground = Json::parse(text)["ground"];
  const std::size_t columns = ground["columns"];
  REQUIRE(ground["heights_m"].size() == columns * columns);
  REQUIRE(ground["seen"].size() == columns * columns);
  const double spacing_m = ground["spacing_m"];
  CHECK(spacing_m * static_cast<double>(columns - 1) == Approx(demo.terrain->east_extent_m()));
  CHECK(ground["heights_m"][3 * columns + 5] ==
        std::lround(demo.terrain->height_m(3 * spacing_m, 5 * spacing_m)));
  const auto seen_at = [&](const AE_navigator::GroundPoint& point) {
    return ground["seen"][static_cast<std::size_t>(point.north_m / spacing_m) * columns +
                          static_cast<std::size_t>(point.east_m / spacing_m)]
        .get<int>();
  };
  for (const auto& radar : demo.problem.radar_sites) CHECK(seen_at(radar.site) > 50);
  CHECK(seen_at({500, 500}) == 0);
}

TEST_CASE("A picture names routes, zones, threats, both ends and the figures of each route") {
  Demo demo;
  demo.problem.missile_sites.push_back({"Sierra", {20'000, 15'000}, 20, 4000, 0.02});
  const auto routes = two_routes();
  const auto json = Json::parse(route_picture(*demo.terrain, demo.problem, routes, "Routes"));
  const auto names = [&](const char* list, const char* name) {
    std::set<std::string> all;
    for (const auto& each : json[list]) all.insert(each[name].get<std::string>());
    return all;
  };
  CHECK(json["title"] == "Routes");
  CHECK(json["facts"][1] == "terrain synthetic:7");
  CHECK(names("routes", "label") == std::set<std::string>{"A*, 2 s", "RRTConnect, 50 ms"});
  CHECK(names("zones", "name") == std::set<std::string>{"City", "Reserve", "Corridor"});
  CHECK(names("radars", "name") == std::set<std::string>{"Alpha", "Bravo", "Charlie", "Delta"});
  CHECK(json["missiles"] ==
        Json::parse(R"([{"name": "Sierra", "place": [20000, 15000], "range_m": 4000}])"));
  CHECK(json["goal"][0] == std::lround(demo.problem.goal.north_m));
  CHECK(json["routes"][0]["length_m"] == routes[0].route.length_m);
  CHECK(json["routes"][0]["exposure_m"] == routes[0].route.radar_exposure);
  CHECK(json["routes"][0]["points"].size() == routes[0].route.waypoints.size());
}

TEST_CASE(
    "A height profile leads over the ground to the end of the route, and tells what is seen") {
  const Demo demo;
  const auto routes = two_routes();
  const auto json = Json::parse(route_picture(*demo.terrain, demo.problem, routes, "Routes"));
  for (std::size_t i = 0; i < routes.size(); ++i) {
    const auto& profile = json["routes"][i]["profile"];
    const auto& last = routes[i].route.waypoints.back();
    REQUIRE(profile.size() > 100);
    CHECK(profile.front()[0] == 0);
    CHECK(profile.back()[0] == Approx(routes[i].route.length_m).epsilon(0.01));
    CHECK(profile.back()[1] == std::lround(demo.terrain->height_m(last.north_m, last.east_m)));
    CHECK(profile.back()[2] == std::lround(last.altitude_m));
    long seen = 0;
    for (const auto& sample : profile) {
      CHECK(sample[2].get<long>() > sample[1].get<long>());
      seen += sample[3].get<long>();
    }
    CHECK((seen > 0 && seen < 100 * static_cast<long>(profile.size())));
  }
}

// The missiles are those that the example's ground station reports before its fifth question.
TEST_CASE("The text of the route-planning example tells what A* plans today") {
  const Demo demo;
  const auto planner = make_planner("AStar", demo.terrains);
  const auto before = planner->plan(demo.problem);
  auto problem = demo.problem;
  const auto& middle = before.waypoints[before.waypoints.size() / 2];
  problem.missile_sites.push_back({"Sierra", {middle.north_m, middle.east_m}, 20, 4000, 0.02});
  problem.exposure_cap_m = 3 * before.radar_exposure + 10'000;
  problem.kill_weight_m = 100'000;
  const auto after = planner->plan(problem);

  const auto figures = [](const auto& route) {
    return fmt::format("{:.1f} km, exposure {:.1f} km", route.length_m / 1000,
                       route.radar_exposure / 1000);
  };
  std::ifstream file(skein::test::project_file("examples/route_planning/README.md"));
  const std::string text((std::istreambuf_iterator<char>(file)), {});
  CHECK_THAT(text, Contains(figures(before)) && Contains(figures(after)));
  CHECK_THAT(text, Contains(fmt::format("  route     {:.2f} km by AStar, lowest {:.0f} m above "
                                        "ground, radar exposure {:.2f} km, {} waypoints\n",
                                        after.length_m / 1000, after.lowest_height_above_ground_m,
                                        after.radar_exposure / 1000, after.waypoints.size())));
}

TEST_CASE("A route with a number that is not finite is listed, but not drawn") {
  const Demo demo;
  auto routes = two_routes();
  routes[1].route.waypoints[3].north_m = std::nan("");
  routes[1].label = "a\xff";
  const auto json = Json::parse(route_picture(*demo.terrain, demo.problem, routes, "Routes"));
  CHECK(json["routes"][1]["label"] == "a\uFFFD");
  CHECK(json["routes"][1]["points"].is_null());
  CHECK_FALSE(json["routes"][1].contains("profile"));
}
