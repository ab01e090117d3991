// What the launcher takes from a profile for its processes, and which of them it starts.
#include <catch2/catch.hpp>

#include "mission/supervise/launch_plan.hpp"
#include "test/mission/profile/profile_folder.hpp"
#include "test/mission/supervise/shell_mission.hpp"

using namespace skein;
using namespace skein::launch;
using namespace skein::profile;

namespace {

std::vector<std::string> chosen_argv(const PeerProfile& peer, const CspProfile* csp) {
  return {"skein", "peer", "m.xml", csp ? peer.name + "/" + csp->name : peer.name};
}

using Words = std::vector<std::string>;

const std::string kGrouped = R"(<group name="pair">
<peer name="a" component="f.xml"/><peer name="b" component="f.xml"/></group>
<peer name="c" component="f.xml" role="mission"/>)";

Words chosen_names(const LaunchPlan& plan) {
  Words names;
  for (const auto& child : plan.children) names.push_back(child.name);
  return names;
}

}  // namespace

TEST_CASE("Environment, arguments and CPUs of a process reach its command line") {
  ProfileFolder folder;
  const auto mission = read_mission_profile(folder.mission(R"(
<environment name="COLOUR" value="red"/><environment name="SIZE" value="1"/>
<peer name="n" component="n.xml" process_cpus="0,2-3"><environment name="SIZE" value="2"/>
  <argument value="--fast"/><argument value="a b"/>
  <csp component="p.xml" process="own"><environment name="SHAPE" value="round"/></csp></peer>)"));
  const auto plan = make_launch_plan(mission, chosen_argv);
  REQUIRE(plan.children.size() == 2);
  CHECK(plan.children[0].argv == Words{"taskset", "--cpu-list", "0,2,3", "skein", "peer", "m.xml",
                                       "n", "--", "--fast", "a b"});
  using Environment = std::vector<std::pair<std::string, std::string>>;
  CHECK(plan.children[0].environment == Environment{{"SIZE", "2"}, {"COLOUR", "red"}});
  CHECK(plan.children[1].argv == Words{"skein", "peer", "m.xml", "n/P"});
  CHECK(plan.children[1].environment ==
        Environment{{"SHAPE", "round"}, {"SIZE", "2"}, {"COLOUR", "red"}});
  CHECK_THAT(to_text(plan),
             Catch::Contains("run:   SIZE=2 COLOUR=red taskset --cpu-list 0,2,3 skein peer m.xml n "
                             "-- --fast 'a b'\n"));
}

TEST_CASE("A program of its own is run as it is, and is ready as soon as it runs") {
  ProfileFolder folder;
  const auto mission = read_mission_profile(folder.mission(R"(
<peer name="log" program="logger"><argument value="-s"/></peer>
<peer name="script" program="tools/go.sh" ready="told"/>)"));
  const auto plan = make_launch_plan(mission, chosen_argv);
  REQUIRE(plan.children.size() == 2);
  CHECK(plan.children[0].argv == Words{"logger", "-s"});
  CHECK_FALSE(plan.children[0].tells_ready);
  CHECK(plan.children[1].argv == Words{(folder.path() / "tools/go.sh").string()});
  CHECK(plan.children[1].tells_ready);
  CHECK_THAT(to_text(plan), Catch::Contains("ready: as soon as it runs"));
}

TEST_CASE("The launcher does not wait for a program that says nothing") {
  auto silent = shell_child("silent", "while :; do sleep 1000; done");
  silent.tells_ready = false;
  auto flight = shell_child("flight", "ready; while :; do sleep 1000; done");
  flight.runs_mission = true;
  RecordedMission mission({silent, flight});
  pid_t process = 0;
  mission.on_event = [&](const ChildEvent& event) {
    if (event.child == "flight" && event.text.starts_with("started as process "))
      process = std::stoi(event.text.substr(19));
    if (event.child.empty() && process != 0) ::kill(process, SIGTERM);  // all are ready
  };
  CHECK(mission.run().exit_code == 128 + SIGTERM);
  CHECK(mission.saw("silent: ready after"));
}

TEST_CASE("Some peers can be started, and others left out") {
  ProfileFolder folder;
  const auto mission = read_mission_profile(folder.mission(kGrouped));
  CHECK(chosen_names(make_launch_plan(mission, chosen_argv)) == Words{"a", "b", "c"});
  const auto plan = make_launch_plan(mission, chosen_argv, "", {"pair"});
  CHECK(chosen_names(plan) == Words{"a", "b"});
  CHECK(plan.elsewhere == Words{"c, which --only leaves out"});
  CHECK(plan.mission_elsewhere == "c, which --only leaves out");
  CHECK(chosen_names(make_launch_plan(mission, chosen_argv, "", {"c", "a"})) == Words{"a", "c"});
}

TEST_CASE("A peer to be started that there is not is refused with those that there are") {
  ProfileFolder folder;
  const auto mission = read_mission_profile(folder.mission(kGrouped));
  CHECK_THROWS_WITH(
      make_launch_plan(mission, chosen_argv, "", {"paire"}),
      "mission 'm' has no peer and no group 'paire' (did you mean 'pair'?); it has a, "
      "pair, b, c");
}
