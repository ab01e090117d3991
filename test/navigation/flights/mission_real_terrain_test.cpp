#include <unistd.h>

#include <catch2/catch.hpp>
#include <cstdlib>
#include <fstream>

#include "test/tools/mission_run.hpp"
#include "test/tools/places.hpp"

using namespace skein::test;
using Catch::Contains;

namespace {

std::filesystem::path tile() {
  const char* data = std::getenv("SKEIN_TEST_DATA");
  if (data && *data) return std::filesystem::absolute(data) / "terrain" / "N53E027.hgt";
  std::fputs("skipped: SKEIN_TEST_DATA names no folder with test data\n", stderr);
  std::_Exit(77);
}

std::string profile_text(const std::filesystem::path& file) {
  std::ifstream in(file);
  return {std::istreambuf_iterator<char>(in), {}};
}

}  // namespace

TEST_CASE("the mission flies over an SRTM tile that is given by a relative path",
          "[.][real_terrain]") {
  const auto from_mission_folder =
      std::filesystem::relative(tile(), std::filesystem::temp_directory_path() / "any");
  const auto zones = std::filesystem::temp_directory_path() /
                     ("skein-zones-" + std::to_string(getpid()) + ".geojson");
  std::ofstream(zones) << R"({"type": "Feature", "properties": {"name": "Moor", "margin_m": 900},
                              "geometry": {"type": "Point", "coordinates": [27.9, 53.1]}})";
  const MissionRun run(
      project_file("mission_profiles/route_planning/route_planning.xml"),
      {"--set", "ground_station.Terrain=" + from_mission_folder.string(), "--set",
       "ground_station.Time limit=10 s", "--set", "ground_station.Zones=" + zones.string()});
  std::filesystem::remove(zones);
  INFO(run.output());
  CHECK(run.exit_code() == 0);
  CHECK_THAT(run.output(), Contains("Route planning over N53E027.hgt"));
  CHECK_THAT(run.output(),
             Contains("5 routes, all valid; the unreachable goal was refused as such"));
  CHECK_THAT(run.output(), Contains("4 no-fly zones"));
  CHECK_THAT(profile_text(run.file("route.geojson")),
             Contains("Moor") && Contains("planner killed"));
  CHECK_THAT(profile_text(run.file("route.plan")), Contains("\"fileType\": \"Plan\""));
}
