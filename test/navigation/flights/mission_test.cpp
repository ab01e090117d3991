#include <fmt/core.h>

#include <catch2/catch.hpp>
#include <cstdlib>
#include <fstream>
#include <nlohmann/json.hpp>
#include <regex>

#include "test/tools/mission_run.hpp"
#include "test/tools/places.hpp"

using namespace skein::test;
using Catch::Contains;
using Catch::Matches;

namespace {

const std::filesystem::path kMission =
    project_file("mission_profiles/route_planning/route_planning.xml");
const std::filesystem::path kTestProfiles = project_file("test/navigation/flights/profiles");

/// What is shown does not depend on how fast this machine plans.
const std::vector<std::string> kTimeToThink{"--set", "ground_station.Time limit=10 s"};

/// The mission, flown once for all that is looked at.
const MissionRun& flown() {
  static const MissionRun run(kMission, kTimeToThink);
  return run;
}

std::string text_of(const std::filesystem::path& file) {
  std::ifstream text(file);
  return {std::istreambuf_iterator<char>(text), {}};
}

/// What the page of the routes draws them from.
nlohmann::json picture_in(const std::filesystem::path& page) {
  const std::string text = text_of(page), begin = "type=\"application/json\">";
  const auto from = text.find(begin) + begin.size();
  return nlohmann::json::parse(text.substr(from, text.find("</script>", from) - from));
}

}  // namespace

TEST_CASE("the mission flies: every route is valid, and the unreachable goal is refused as such") {
  const MissionRun& run = flown();
  INFO(run.output());
  CHECK(run.exit_code() == 0);
  CHECK_THAT(run.output(),
             Contains("5 routes, all valid; the unreachable goal was refused as such"));

  SECTION(
      "by what they declare the best planner answers, though the quicker one has shown as much") {
    CHECK_THAT(
        run.output(),
        Contains("RRTstar has the best declared quality (0.95) of those whose latency fits"));
  }
  SECTION("what planners declare stands beside what they have shown") {
    CHECK_THAT(run.output(), Contains("latency quality p50 p95 quality runs reliable here"));
    CHECK_THAT(run.output(), Matches(".* AStar 300 ms 0\\.90 [0-9]+ [0-9]+ ms 0\\.[0-9]+ .*"));
    CHECK_THAT(run.output(), Matches(".*[A-Za-z]+ first for [0-9]+ ms: [0-9]+ of [0-9]+ similar "
                                     "requests answered by then.*"));
  }
  SECTION("when the planner is killed the next best answers, and the launcher brings it back") {
    CHECK_THAT(run.output(), Contains("kill RRTstar (process "));
    CHECK_THAT(run.output(), Contains("navigator/RRTstar: ended by signal 9"));
    CHECK_THAT(run.output(), Contains("disconnected after"));
    CHECK_THAT(run.output(), Contains("2. AStar has the best declared quality (0.9)"));
    CHECK_THAT(run.output(), Contains("back RRTstar was started again"));
  }
  SECTION("where no route keeps the cap, planning begins anew with the AD manager's threats") {
    CHECK_THAT(run.output(), Contains("by the check 'exposure cap': its exposure is"));
    CHECK_THAT(run.output(), Contains("anew with threat picture 4, from the AD manager"));
  }
  SECTION("the goal that cannot be reached is refused with the zones that enclose it") {
    CHECK_THAT(run.output(),
               Contains("there is no route: the goal is enclosed by the no-fly zones"));
    CHECK_THAT(run.output(), Contains("refused there is no route, with a proof"));
  }
  SECTION("how it was decided is kept: as a history, and as a log that comes out the same again") {
    CHECK(std::filesystem::file_size(run.file("navigator_history.json")) > 0);
    const std::string replay = "'" + built_program("skein") + "' decisions --replay --log '" +
                               run.file("decisions.jsonl").string() + "' > /dev/null";
    CHECK(std::system(replay.c_str()) == 0);
  }
  SECTION("the picture shows each route, and refers to nothing outside of itself") {
    const std::string page = text_of(run.file("route.html"));
    CHECK_FALSE(std::regex_search(page, std::regex("https?:(?!//www.w3.org/2000/svg\")|src=|<link|"
                                                   "@import|url\\((?!#)")));
    std::string labels;
    const auto picture = picture_in(run.file("route.html"));
    for (const auto& route : picture["routes"])
      if (!route["points"].is_null()) labels += route["label"].get<std::string>() + "\n";
    CHECK_THAT(labels, Matches("10 s, by declaration: RRTstar\n.*\n[0-9]+ ms: .*\n"  // in a hurry
                               "planner killed: AStar\nfresh picture: .*\n"));
  }
}

// Of its routes, only this one depends neither on chance nor on how fast the machine is.
TEST_CASE("the example's text tells of a flight like this one") {
  const auto route = picture_in(flown().file("route.html"))["routes"][3];
  CHECK(route["label"] == "planner killed: AStar");
  const std::string figures =
      fmt::format("{:.1f} km, exposure {:.1f} km", route["length_m"].get<double>() / 1000,
                  route["exposure_m"].get<double>() / 1000);
  CHECK_THAT(text_of(project_file("examples/route_planning/README.md")), Contains(figures));
}

TEST_CASE(
    "a planner that lies about a cut corner is found out, and the next best answers in its place") {
  const MissionRun run(kTestProfiles / "lying_planner.xml", kTimeToThink);
  INFO(run.output());
  CHECK(run.exit_code() == 0);
  CHECK_THAT(run.output(), Contains("1. ShortCut has the best declared quality (0.99)"));
  CHECK_THAT(run.output(),
             Contains("rejected after") && Contains("it enters the no-fly zone 'City'"));
  CHECK_THAT(run.output(), Contains("2. RRTstar has the best declared quality (0.95)"));
}

TEST_CASE("a navigator that passes on a route through a no-fly zone fails the mission") {
  const MissionRun run(kTestProfiles / "lying_navigator.xml", kTimeToThink);
  INFO(run.output());
  CHECK(run.exit_code() == 1);
  CHECK_THAT(run.output(), Contains("check INVALID (no-fly zone)"));
  CHECK_THAT(run.output(),
             Contains("failed the route checker refuses the route (10 s, by declaration)"));
  CHECK_THAT(run.output(), Contains("a route to the unreachable goal was returned"));
}

TEST_CASE("a client's own planner that nobody can reach is refused, and the navigator lives on") {
  const MissionRun run(kTestProfiles / "unreachable_planner.xml");
  INFO(run.output());
  CHECK(run.exit_code() == 0);
  CHECK_THAT(run.output(), Contains("refused: ") && Contains("reported: "));
  CHECK_THAT(run.output(), !Contains("ended by signal"));
}

TEST_CASE("a plugin that is missing is named, with where it was looked for and what to do") {
  const MissionRun run(kTestProfiles / "missing_plugin.xml");
  INFO(run.output());
  CHECK(run.exit_code() == 78);
  CHECK_THAT(run.output(), Contains("missing_plugin.xml:3:3: error: the plugin "
                                    "'skein_no_such_plugin': no libskein_no_such_plugin.so in"));
  CHECK_THAT(run.output(), Contains("build or install the plugin"));
}

TEST_CASE("a terrain that does not exist ends the mission with its name") {
  const MissionRun run(kMission, {"--set", "ground_station.Terrain=nowhere/N00E000.hgt"});
  INFO(run.output());
  CHECK(run.exit_code() != 0);
  CHECK_THAT(run.output(), Contains("nowhere/N00E000.hgt"));
}
