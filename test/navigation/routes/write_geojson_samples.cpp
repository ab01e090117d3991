#include <fstream>

#include "navigation/routes/flight_plan.hpp"
#include "navigation/routes/geojson.hpp"
#include "test/navigation/made_geography.hpp"

using namespace skein::navigation;
using namespace skein::navigation::testing;

/// Writes zones, sites and a route of two places into the folder that its argument names.
int main(int, char** arguments) {
  const std::filesystem::path folder = arguments[1];
  auto made = problem();
  made.no_fly_zones.push_back(forked_zone());
  const std::vector<PicturedRoute> routes{route()};
  for (const auto& [name, terrain] :
       {std::pair{"rhine", level(51.5, 6.5)}, {"fiji", level(-17.5, 179.9)}}) {
    std::ofstream(folder / (std::string(name) + ".geojson")) << to_geojson(terrain, made, routes);
    std::ofstream(folder / (std::string(name) + ".plan"))
        << to_flight_plan(terrain, made, routes[0].route).text;
  }
}
