// What people may write wrong in the missions' profiles, and is only found by who reads the value:
// the check tells it at its place, with the value's own text, before anything starts.
#include <catch2/catch.hpp>

#include "test/tools/command_run.hpp"
#include "test/tools/installed.hpp"
#include "test/tools/places.hpp"
#include "test/tools/temporary_folder.hpp"

using namespace skein::test;
using Catch::Contains;

namespace {

std::string profile(const std::string& mission) {
  return project_file("mission_profiles/reconnaissance/" + mission + ".xml");
}

struct Wrong {
  std::string mission;
  std::string variable;
  std::string value;
  std::string message;
};

const std::string kFurther = "; depot 1 5 0.3 30 53.5 27.6";

const std::vector<Wrong> kWrong{
    {"reconnaissance", "elements", "depot -3 5 0.3 30 53.4 27.6" + kFurther,
     R"("Elements": 'depot -3 5 0.3 30 53.4 27.6' is no element; write `name priority)"},
    {"reconnaissance", "elements", "depot 3 5 -0.3 30 53.4 27.6", "is no element"},
    {"reconnaissance", "elements", "depot 3 -5 0.3 30 53.4 27.6", "is no element"},
    {"reconnaissance", "elements", "depot 3 5 nan 30 53.4 27.6", "is no element"},
    {"reconnaissance", "elements", "depot 3 5 0.3 30 53.4 27.6 53.5", "is no element"},
    {"two_aircraft", "elements", "depot 3 5 0.3 30 53.4 27.6" + kFurther,
     "two elements are called 'depot'"},
    {"reconnaissance", "elements", ";", R"("Elements": it names no element)"},
    {"reconnaissance", "objects", "53.4 27.6 3 0", R"("Objects": '53.4 27.6 3 0' is no object)"},
    {"surveillance", "objects", "153.4 27.6 3 0 0", "is no object"},
    {"reconnaissance", "sites", "short-range site 53.48 27.5 never",
     R"("Sites": 'short-range site 53.48 27.5 never' is no site)"},
    {"suppression", "sites", "long-range site 53.48 27.5 0",
     R"("Sites": 'long-range site' is no site; there are )"},
    {"reconnaissance", "sites", "short-range site 53.48 27.5 0 1e999", "is no site"},
    {"two_aircraft", "runway", "53.3 27.4 180 80", R"("Runway": '53.3 27.4 180 80' is no runway)"},
    {"two_aircraft", "second_runway", "53.3 27.4 180 80 -1500", ": a runway has a length"},
    {"reconnaissance", "intruders", "150 35 12000 0", "an intruder has a distance and a speed"},
    {"reconnaissance", "failures", "4 wrong 250 400", R"("Sensor failures": '4 wrong 250 400' is)"},
    {"reconnaissance", "planner_failures", "0 killed", R"("Planner failures": '0 killed' is no)"},
    {"reconnaissance", "hills", "1e99", R"("Hills" is "1e99", which is no integer)"},
};

}  // namespace

TEST_CASE("a wrong value is told by its own text, and named by its variable") {
  for (const Wrong& wrong : kWrong) {
    const std::string assignment = wrong.variable + "=" + wrong.value;
    CAPTURE(assignment);
    CommandRun check({"check", profile(wrong.mission), "--variable", assignment});
    CHECK(check.wait() == 78);
    CHECK_THAT(check.output(),
               Contains(": error: ") && Contains(wrong.message) &&
                   (Contains("--variable " + wrong.variable + ": ") || Contains(".xml:")));
  }
}

TEST_CASE("a wrong value of one parameter is told, too") {
  const auto [setting, message] = GENERATE(table<std::string, std::string>({
      {"eoi_manager.Rate=3",
       R"("Rate": nobody can take part 3 times a second; 1, 2, 5, 10, 25 and)"},
      {"eoi_manager.Task=look",
       R"("Task": 'look' is no task; there are images, follow and locate)"},
      {"nhp.Aircraft type=large", R"("Aircraft type": 'large' is no aircraft)"},
      {"flight_simulator.Wind from=400", R"("Wind from" is 400 deg, more than 360 deg)"},
      {"flight_simulator.Fuel=nan", R"("Fuel" is "nan", which is no real in kg)"},
  }));
  CAPTURE(setting);
  CommandRun check({"check", profile("reconnaissance"), "--set", setting});
  CHECK(check.wait() == 78);
  CHECK_THAT(check.output(), Contains(message));
}

TEST_CASE("two hundred sites come from a file, and a wrong one is told by its line") {
  const TemporaryFolder folder;
  std::string sites;
  for (int i = 0; i < 200; ++i) sites += "short-range site 53.48 27.5 " + std::to_string(i) + "\n";
  const std::string given = "sites=@" + folder.write("sites.txt", sites).string();
  CommandRun right({"check", profile("reconnaissance"), "--variable", given});
  CHECK(right.wait() == 0);
  folder.write("sites.txt", sites + "short-range site 53.48 never\n");
  CommandRun wrong({"check", profile("reconnaissance"), "--variable", given});
  CHECK(wrong.wait() == 78);
  CHECK_THAT(wrong.output(), Contains("sites.txt:201:1: error: \"Sites\": "));
}

TEST_CASE("an entity whose parameters contradict each other ends the mission with its reason") {
  if (!installed("fastdds") || !installed("cyclonedds")) return;
  CommandRun run(
      {"launch", "--no-log", profile("reconnaissance"), "--set", "nhp.Required=navigator, pilot"});
  CHECK(run.wait() == 78);
  const std::string output = run.output();
  CHECK_THAT(output.substr(output.find("\nskein: ")),
             Contains("skein: nhp ended with exit code 78 (last it said: ") &&
                 Contains("parameter 'Required': 'pilot' is not of the crew, which is "));
}

TEST_CASE("a mission that waits for what never comes says for what") {
  if (!installed("fastdds") || !installed("cyclonedds")) return;
  const auto [setting, reason] = GENERATE(table<std::string, std::string>({
      {"flight_simulator.Participants=13",
       "time has not begun, since 12 take part in it: how many must is the parameter "
       "'Participants'"},
      {"nhp.Crew=navigator, flight_simulator, flight_controller, mission_manager, pilot",
       "there was no take-off within 600 s: pilot has not been heard of"},
  }));
  CAPTURE(setting);
  CommandRun run({"launch", "--no-log", profile("reconnaissance"), "--set", setting, "--set",
                  "ground_station.Patience=10 s"});
  CHECK(run.wait(std::chrono::minutes(4)) == 11);  // 600 s of the mission
  CHECK_THAT(run.output(), Contains(reason));
}
