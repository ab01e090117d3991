#include "mission/supervise/launch_plan.hpp"

#include <catch2/catch.hpp>

#include "core/system/host.hpp"
#include "test/mission/profile/profile_folder.hpp"
#include "test/tools/places.hpp"

using namespace skein::launch;
using namespace skein::profile;
using skein::test::project_file;

namespace {

std::vector<std::string> argv_of(const PeerProfile& peer, const CspProfile* csp) {
  return {"skein", "peer", "a profile.xml", csp ? peer.name + "/" + csp->name : peer.name};
}

std::vector<std::string> names_of(const LaunchPlan& plan) {
  std::vector<std::string> names;
  for (const auto& child : plan.children) names.push_back(child.name);
  return names;
}

}  // namespace

TEST_CASE("Every peer and every CSP with a process of its own becomes one child") {
  const auto mission =
      read_checked_profile(project_file("mission_profiles/route_planning/route_planning.xml"));
  const auto plan = make_launch_plan(mission, argv_of);
  CHECK(names_of(plan) == std::vector<std::string>{"navigator", "navigator/RRTConnect",
                                                   "navigator/RRTstar", "flight_controller",
                                                   "ad_manager", "ground_station"});
  CHECK(plan.children[1].argv.back() == "navigator/RRTConnect");
  CHECK(plan.children[1].rules.on_loss == LossPolicy::Continue);
  CHECK(plan.children[0].rules.on_loss == LossPolicy::Abort);
  CHECK(plan.children[5].runs_mission);
  CHECK(plan.elsewhere.empty());
}

TEST_CASE("Peers of other hosts are named, not started") {
  ProfileFolder folder;
  const auto mission = read_mission_profile(folder.mission(R"(
      <peer name="a" component="f.xml" host="alpha"/><peer name="b" component="f.xml" host="beta"/>
      <peer name="c" component="f.xml"/><peer name="d" component="f.xml" host="localhost"/>)"));
  const auto plan = make_launch_plan(mission, argv_of, "alpha");
  CHECK(names_of(plan) == std::vector<std::string>{"a", "c", "d"});
  CHECK(plan.elsewhere == std::vector<std::string>{"b on beta"});
}

TEST_CASE(
    "A launcher that was not told where it is goes by the machine's own names and addresses") {
  ProfileFolder folder;
  const auto mission = read_mission_profile(folder.mission(
      R"(<peer name="a" component="f.xml" host=")" + skein::name_of_this_host() + R"("/>
         <peer name="b" component="f.xml" host="127.0.0.1"/>
         <peer name="c" component="f.xml" host="192.0.2.7" role="mission"/>)"));
  const auto plan = make_launch_plan(mission, argv_of);
  CHECK(names_of(plan) == std::vector<std::string>{"a", "b"});
  CHECK(plan.elsewhere == std::vector<std::string>{"c on 192.0.2.7"});
  CHECK(plan.mission_elsewhere == "c on 192.0.2.7");
}

TEST_CASE("Who has nothing to start is told the hosts of the mission, and the nearest name") {
  ProfileFolder folder;
  const auto mission = read_mission_profile(folder.mission(
      R"(<peer name="a" component="f.xml" host="alpha"/><peer name="b" component="f.xml" host="beta"/>
         <peer name="c" component="f.xml" host="alpha"/>)"));
  CHECK(
      nobody_here(mission, "betta") ==
      "no peer of mission 'm' is of this host, which is 'betta' (did you mean 'beta'?); its hosts "
      "are alpha (a, c); beta (b); say by --host which of them this is");
  CHECK_THAT(nobody_here(mission, ""), Catch::Contains(skein::name_of_this_host()));
}

TEST_CASE("The text of a plan shows commands that a shell would run, and every rule") {
  ProfileFolder folder;
  const auto mission = read_mission_profile(folder.mission(
      R"(<peer name="f" component="f.xml" restart="on-failure"/>
         <peer name="g" component="g.xml" host="beta" role="mission"/>)"));
  auto plan = make_launch_plan(mission, argv_of, "alpha");
  plan.children[0].environment = {{"LEVEL", "it's"}};
  CHECK(to_text(plan) ==
        "mission \"m\": 1 processes here, all started at once\n\n"
        "f\n"
        "  run:   LEVEL='it'\\''s' skein peer 'a profile.xml' f\n"
        "  ready: within 30 s\n"
        "  rules: restart on-failure after 0.1 s, doubling up to 5 s, given up after 5 in 30 s\n"
        "  stop:  SIGINT, after 2 s SIGTERM, after 3 s SIGKILL\n"
        "  end:   its loss ends the mission\n"
        "\nnot started here:\n"
        "  g on beta\n");
}

TEST_CASE("Peers come in layers after those who provide what they and their CSPs depend on") {
  ProfileFolder folder;
  const auto mission = read_mission_profile(folder.mission(
      R"(<peer name="g" component="g.xml"/>
         <peer name="n" component="n.xml"><csp component="p.xml" process="own"/></peer>
         <peer name="f" component="f.xml"/><peer name="f2" component="f.xml"/>)"));
  const auto plan = make_launch_plan(mission, argv_of);
  REQUIRE(names_of(plan) == std::vector<std::string>{"g", "n", "n/P", "f", "f2"});
  CHECK(plan.children[0].layer == 2);
  CHECK(plan.children[1].layer == 1);
  for (const std::size_t first : {2, 3, 4}) CHECK(plan.children[first].layer == 0);
  const std::string text = to_text(plan);
  CHECK_THAT(text, Catch::Contains("5 processes here, started in 3 layers"));
  CHECK_THAT(text, Catch::Contains("  after: M/IF of f or f2\n"));
  CHECK(text.find("layer 1\n") < text.find("\nn/P\n"));
  CHECK(text.find("\nf2\n") < text.find("layer 2\n"));
  CHECK(text.find("layer 2\n") < text.find("\nn\n"));
  CHECK(text.find("layer 3\n") < text.find("\ng\n"));
}

TEST_CASE("What a peer of another host provides is not waited for, but by the peer itself") {
  ProfileFolder folder;
  const auto mission = read_mission_profile(folder.mission(
      R"(<peer name="n" component="n.xml" host="alpha"/><peer name="g" component="g.xml" host="alpha"/>
         <peer name="f" component="f.xml" host="beta"/>)"));
  const auto plan = make_launch_plan(mission, argv_of, "alpha");
  REQUIRE(names_of(plan) == std::vector<std::string>{"n", "g"});
  CHECK(plan.children[0].after.empty());
  CHECK(plan.children[0].layer == 0);
  REQUIRE(plan.children[1].after.size() == 1);
  CHECK(plan.children[1].after[0].providers == std::vector<std::string>{"n"});
  CHECK(plan.children[1].layer == 1);
}

TEST_CASE("A cycle of dependencies holds up nobody") {
  ProfileFolder folder;
  folder.write("f.xml",
               R"(<component name="F"><interfaces><implements>M/IF</implements></interfaces>
    <dependencies><depends>M/IN</depends></dependencies></component>)");
  const auto mission = read_mission_profile(
      folder.mission(R"(<peer name="n" component="n.xml"/><peer name="f" component="f.xml"/>)"));
  for (const ChildPlan& child : make_launch_plan(mission, argv_of).children)
    CHECK(child.after.empty());
}
