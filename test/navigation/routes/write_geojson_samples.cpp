#include <fstream>

#include "navigation/routes/flight_plan.hpp"
#include "navigation/routes/geojson.hpp"
#include "test/navigation/made_geography.hpp"

using namespace skein::navigation;
using namespace skein::navigation::testing;

namespace {

void write(const std::filesystem::path& file, const std::string& text) {
  std::ofstream(file) << text;
}

}  // namespace

/// Writes zones, sites and a route of two places into the folder that its argument names; and a
/// plan whose zones were read from the GeoJSON, where they are cut at the antimeridian.
int main(int, char** arguments) {
  const std::filesystem::path folder = arguments[1];
  auto made = problem();
  made.no_fly_zones.push_back(forked_zone());
  const std::vector<PicturedRoute> routes{route()};
  for (const auto& [name, terrain] :
       {std::pair{std::string("rhine"), level(51.5, 6.5)}, {"fiji", level(-17.5, 179.9)}}) {
    const std::string geojson = to_geojson(terrain, made, routes);
    write(folder / (name + ".geojson"), geojson);
    write(folder / (name + ".plan"), to_flight_plan(terrain, made, routes[0].route).text);
    auto read = made;
    read.no_fly_zones = zones_from_geojson(geojson, name, terrain);
    write(folder / (name + "_read.plan"), to_flight_plan(terrain, read, routes[0].route).text);
  }
}
