#include <catch2/catch.hpp>
#include <cstdlib>

#include "../tools/places.hpp"
#include "mission_run.hpp"

using namespace skein::test;
using Catch::Contains;

namespace {

std::filesystem::path tile() {
  const char* data = std::getenv("SKEIN_TEST_DATA");
  if (data && *data) return std::filesystem::absolute(data) / "terrain" / "N53E027.hgt";
  std::fputs("skipped: SKEIN_TEST_DATA names no folder with test data\n", stderr);
  std::_Exit(77);
}

}  // namespace

TEST_CASE("the mission flies over an SRTM tile that is given by a relative path",
          "[.][real_terrain]") {
  const auto from_mission_folder =
      std::filesystem::relative(tile(), std::filesystem::temp_directory_path() / "any");
  const MissionRun run(project_file("mission_profiles/route_planning.xml"),
                       {"--set", "ground_station.Terrain=" + from_mission_folder.string(), "--set",
                        "ground_station.Time limit=10 s"});
  INFO(run.output());
  CHECK(run.exit_code() == 0);
  CHECK_THAT(run.output(), Contains("Route planning over N53E027.hgt"));
  CHECK_THAT(run.output(),
             Contains("5 routes, all valid; the unreachable goal was refused as such"));
}
