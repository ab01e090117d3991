#include "navigation/routes/route_picture.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <fstream>
#include <pugixml.hpp>

#include "../tools/places.hpp"
#include "demo.hpp"
#include "made_terrain.hpp"
#include "skein/error.hpp"

using namespace skein::navigation;
using namespace skein::navigation::testing;
using Catch::Contains;

namespace {

std::vector<PicturedRoute> two_routes(const Demo& demo) {
  return {{"A*, 2 s", demo.plan("AStar")}, {"RRTConnect, 50 ms", demo.plan("RRTConnect")}};
}

}  // namespace

TEST_CASE("A picture is well-formed, below 2 MB and refers to nothing outside of itself") {
  const Demo demo;
  const std::string svg = route_picture(*demo.terrain, demo.problem, two_routes(demo), "Routes");
  pugi::xml_document document;
  REQUIRE(document.load_string(svg.c_str()));
  CHECK(svg.size() < 2'000'000);
  CHECK(document.select_nodes("//*[local-name()='image']").size() == 1);
  for (const auto& match :
       document.select_nodes("//@*[local-name()='href' or local-name()='src']")) {
    CHECK_THAT(match.attribute().value(), Catch::StartsWith("data:image/png;base64,iVBORw0KGgo"));
  }
  for (const auto& match : document.select_nodes("//@*[contains(., 'url(')]")) {
    CHECK_THAT(match.attribute().value(), Contains("url(#"));
  }
}

TEST_CASE("A picture names routes, zones, threats, both ends and the figures of each route") {
  Demo demo;
  demo.problem.missile_sites.push_back({"Sierra", {20'000, 15'000}, 20, 4000, 0.02});
  const auto routes = two_routes(demo);
  const std::string svg = route_picture(*demo.terrain, demo.problem, routes, "Routes");
  for (const char* name :
       {"A*, 2 s", "RRTConnect, 50 ms", "City", "Reserve", "Corridor", "Alpha", "Delta", "Sierra",
        "range of missiles", "Start", "Goal", "synthetic:7"}) {
    CHECK_THAT(svg, Contains(name));
  }
  CHECK_THAT(svg,
             Contains(fmt::format("{:.1f} km, exposure {:.1f} km", routes[0].route.length_m / 1000,
                                  routes[0].route.radar_exposure / 1000)));
}

TEST_CASE("Routes that run together take turns, so that each is seen; one alone is drawn whole") {
  const Demo demo;
  const auto pieces_of_each_colour = [&](const std::vector<PicturedRoute>& routes) {
    pugi::xml_document document;
    const std::string svg = route_picture(*demo.terrain, demo.problem, routes, "Routes");
    REQUIRE(document.load_string(svg.c_str()));
    std::vector<std::size_t> pieces;
    for (const auto& match :
         document.select_nodes("/svg/g[@clip-path]/path[@stroke-width='3']/@d")) {
      const std::string path = match.attribute().value();
      pieces.push_back(static_cast<std::size_t>(std::count(path.begin(), path.end(), 'M')));
    }
    return pieces;
  };
  const PicturedRoute route = two_routes(demo)[0];
  CHECK(pieces_of_each_colour({route}) == std::vector<std::size_t>{1});
  for (const std::size_t count : {2u, 3u}) {
    const auto pieces = pieces_of_each_colour(std::vector<PicturedRoute>(count, route));
    REQUIRE(pieces.size() == count);
    for (const std::size_t piece : pieces) CHECK(piece > 5);
    CHECK(*std::max_element(pieces.begin(), pieces.end()) -
              *std::min_element(pieces.begin(), pieces.end()) <=
          1);
  }
}

TEST_CASE("A height profile has distances below it") {
  const Demo demo;
  const auto distances = [&](const std::vector<PicturedRoute>& routes) {
    pugi::xml_document document;
    const std::string svg = route_picture(*demo.terrain, demo.problem, routes, "Routes");
    REQUIRE(document.load_string(svg.c_str()));
    return document.select_nodes("//text[@class='tick' and contains(., ' km')]").size();
  };
  const auto of_the_map = distances({});
  const auto routes = two_routes(demo);
  CHECK(distances({routes[0]}) >= of_the_map + 4);
  CHECK(distances(routes) >= of_the_map + 8);
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

TEST_CASE("Names that look like XML stay names") {
  Demo demo;
  demo.problem.no_fly_zones[0].name = "</text><script>alert(1)</script>&";
  demo.problem.radar_sites[0].name = "a\x01\"b";
  const std::string svg = route_picture(*demo.terrain, demo.problem, {}, "<Routes> & \"more\"");
  pugi::xml_document document;
  REQUIRE(document.load_string(svg.c_str()));
  CHECK(document.select_nodes("//*[local-name()='script']").empty());
  CHECK(std::string(document.child("svg").child("title").text().get()) == "<Routes> & \"more\"");
}

TEST_CASE("A route with a number that is not finite is listed, but not drawn") {
  const Demo demo;
  auto routes = two_routes(demo);
  routes[1].route.waypoints[3].north_m = std::nan("");
  const std::string svg = route_picture(*demo.terrain, demo.problem, routes, "Routes");
  CHECK_THAT(svg, Contains("not drawn: not a route"));
  pugi::xml_document document;
  REQUIRE(document.load_string(svg.c_str()));
  for (const auto& path : document.select_nodes("//*[local-name()='path']/@d")) {
    CHECK_THAT(path.attribute().value(), !Contains("nan"));
  }
}

TEST_CASE("A picture that cannot be written is an error with its path") {
  const Demo demo;
  CHECK_THROWS_WITH(
      write_route_picture("/nowhere/route.svg", *demo.terrain, demo.problem, {}, "Routes"),
      Contains("/nowhere/route.svg"));
}

TEST_CASE("A written picture is the picture") {
  const Demo demo;
  const TemporaryFolder folder;
  const auto file = folder.path() / "route.svg";
  write_route_picture(file, *demo.terrain, demo.problem, {}, "Routes");
  std::ifstream in(file);
  const std::string written((std::istreambuf_iterator<char>(in)), {});
  CHECK(written == route_picture(*demo.terrain, demo.problem, {}, "Routes"));
}
