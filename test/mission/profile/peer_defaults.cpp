#include <catch2/catch.hpp>

#include "profile_folder.hpp"

using namespace skein::profile;

TEST_CASE("A peer with a count becomes so many, with numbers behind its name") {
  ProfileFolder folder;
  const auto mission = read_mission_profile(
      folder.mission(R"(<peer name="f" component="f.xml" count="3" system="uav-${instance}"/>)"));
  REQUIRE(mission.peers.size() == 3);
  CHECK(mission.peers[0].name == "f-1");
  CHECK(mission.peers[2].name == "f-3");
  CHECK(mission.peers[1].system == "uav-2");
  CHECK(mission.peers[1].component == mission.peers[2].component);
}

TEST_CASE("The number of a peer may stand anywhere in its name and in what it holds") {
  ProfileFolder folder;
  const auto mission = read_mission_profile(folder.mission(R"(<variable name="n" default="2"/>
<peer name="n${instance}th" component="n.xml" count="${n}">
<csp component="p.xml" name="p${instance}"/><parameter name="Time limit" value="${instance}0 ms"/>
<environment name="NUMBER" value="${instance}"/></peer>)"));
  REQUIRE(mission.peers.size() == 2);
  CHECK(mission.peers[1].name == "n2th");
  CHECK(mission.peers[1].csps[0].name == "p2");
  CHECK(mission.peers[1].parameters[0].value == "20 ms");
  CHECK(mission.peers[1].start.environment[0].second == "2");
}

TEST_CASE("A count that is none is a finding") {
  ProfileFolder folder;
  const std::string count = GENERATE("0", "-1", "many", "1001", "");
  CHECK_THAT(folder.check("<peer name=\"f\" component=\"f.xml\" count=\"" + count + "\"/>"),
             Catch::Contains("m.xml:2:34: error: \"count\" is ") &&
                 Catch::Contains("write a number from 1 to 1000"));
}

TEST_CASE("Peers that one element makes are counted as any others") {
  ProfileFolder folder;
  CHECK_THAT(folder.check(R"(<peer name="f" component="f.xml" count="1000"/>)"),
             Catch::Contains("the mission has too much: more than 256 peers"));
  std::string csps;
  for (int i = 0; i < 200; ++i)
    csps += "<csp name=\"p" + std::to_string(i) + "\" component=\"p.xml\"/>";
  CHECK_THAT(folder.check(R"(<peer name="n" component="n.xml" count="200">)" + csps + "</peer>"),
             Catch::Contains("or 20000 elements and attributes"));
}

TEST_CASE("Two peers that write one file are a finding") {
  ProfileFolder folder;
  const auto text = folder.check(
      R"(<peer name="f" component="f.xml" count="2" history="h.json" decision_log="l-${instance}"/>)");
  CHECK_THAT(text, Catch::Contains("history or decision_log \"h.json\" is there twice; each peer "
                                   "that count makes has it; write ${instance} in it"));
  CHECK_THAT(text, !Catch::Contains("\"l-1\""));
  CHECK_THAT(
      folder.check(R"(<peer name="a" component="f.xml" host="a" interface="lo" history="h.json"/>
<peer name="b" component="f.xml" host="b" interface="lo" history="h.json"/>)"),
      !Catch::Contains("there twice"));
}

TEST_CASE("A peer has what it does not say from its group, then from the mission") {
  ProfileFolder folder;
  folder.write("m.xml", R"(<mission name="m" vendor="cyclonedds" system="all">
<group name="g" system="pair" restart="always" threads="2" component="f.xml">
<peer name="a"/><peer name="b" restart="never" system="own"/></group>
<peer name="c" component="f.xml"/></mission>)");
  const auto mission = read_mission_profile(folder.path() / "m.xml");
  REQUIRE(mission.peers.size() == 3);
  const auto& [a, b, c] = std::tie(mission.peers[0], mission.peers[1], mission.peers[2]);
  CHECK(a.group == "g");
  CHECK(a.vendor == "cyclonedds");
  CHECK(a.system == "pair");
  CHECK(a.rules.restart.policy == RestartPolicy::Always);
  CHECK(a.threads.count == 2);
  CHECK(b.rules.restart.policy == RestartPolicy::Never);
  CHECK(b.system == "own");
  CHECK(c.group.empty());
  CHECK(c.system == "all");
  CHECK(c.rules.restart.policy == RestartPolicy::Never);
}

TEST_CASE("Environment comes from the mission, the group, the peer and the CSP") {
  ProfileFolder folder;
  const auto mission = read_mission_profile(folder.mission(R"(
<environment name="A" value="mission"/><environment name="B" value="mission"/>
<environment name="C" value="mission"/><environment name="D" value="mission"/>
<group name="g"><environment name="B" value="group"/><environment name="C" value="group"/>
<peer name="n" component="n.xml"><environment name="C" value="peer"/>
<csp component="p.xml" process="own"><environment name="D" value=""/></csp></peer></group>)"));
  const auto value_of = [](const ProcessStart& start, const std::string& name) {
    for (const auto& [known, value] : start.environment) {
      if (known == name) return value;
    }
    return std::string("none");
  };
  const auto& peer = mission.peers[0].start;
  const auto& csp = mission.peers[0].csps[0].start;
  CHECK(peer.environment.size() == 4);
  CHECK(value_of(peer, "A") == "mission");
  CHECK(value_of(peer, "B") == "group");
  CHECK(value_of(peer, "C") == "peer");
  CHECK(value_of(peer, "D") == "mission");
  CHECK(value_of(csp, "C") == "peer");
  CHECK(value_of(csp, "D") == "");
}

TEST_CASE("A group has a name that no peer has, and holds no group") {
  ProfileFolder folder;
  const std::string peer = R"(<peer name="f" component="f.xml"/>)";
  CHECK_THAT(folder.check("<group>" + peer + "</group>"),
             Catch::Contains("m.xml:2:1: error: <group> has no name"));
  CHECK_THAT(folder.check("<group name=\"g\">" + peer + "</group>\n<group name=\"g\"/>"),
             Catch::Contains("m.xml:3:1: error: the group \"g\" is there twice; the first is at "
                             "m.xml:2:1"));
  CHECK_THAT(folder.check("<group name=\"f\">" + peer + "</group>"),
             Catch::Contains("\"f\" is a peer's name and a group's"));
  CHECK_THAT(
      folder.check("<group name=\"a\"><group name=\"b\">" + peer + "</group></group>" + peer),
      Catch::Contains("<group> is unknown in <group>"));
  CHECK_THAT(
      folder.check("<group name=\"a\" role=\"mission\" retsart=\"never\">" + peer + "</group>"),
      Catch::Contains("<group> has no \"role\"") &&
          Catch::Contains("<group> has no \"retsart\"; did you mean 'restart'?"));
}
