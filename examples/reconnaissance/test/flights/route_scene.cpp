// Writes the page of routes into a folder, its argument: `routes.html`, in which a name tries to be
// markup and a number of the third route is none.
#include <cmath>
#include <fstream>

#include "navigation/routes/route_picture.hpp"
#include "test/navigation/demo.hpp"

namespace route_planning {
std::string page_of(const std::string& json);
}

int main(int, char** arguments) {
  using namespace skein::navigation;
  testing::Demo demo;
  demo.problem.no_fly_zones[0].name = "</text><script>alert(1)</script>&";
  demo.problem.missile_sites.push_back({"Sierra", {20'000, 15'000}, 20, 4000, 0.02});
  const auto route = demo.plan("AStar");
  std::vector<PicturedRoute> routes{{"first", route}, {"second", route}, {"third", route}};
  routes[2].route.waypoints[3].north_m = std::nan("");
  std::ofstream(std::string(arguments[1]) + "/routes.html")
      << route_planning::page_of(route_picture(*demo.terrain, demo.problem, routes, "Routes"));
}
