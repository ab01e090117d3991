#include <catch2/catch.hpp>

#include "profile_folder.hpp"

using namespace skein::profile;
using namespace std::chrono_literals;

namespace {

/// What the rules for a topic make of a QoS.
skein::TopicQos changed(const PeerProfile& peer, const char* topic, skein::TopicQos qos = {}) {
  const auto* rules = find_topic(peer.topics, topic);
  REQUIRE(rules != nullptr);
  rules->change(qos);
  return qos;
}

}  // namespace

TEST_CASE("A topic may have each QoS, or none of it") {
  ProfileFolder folder;
  const auto mission = read_mission_profile(folder.mission(R"(<peer name="f" component="f.xml">
<topic name="a/b" reliability="best-effort" durability="transient-local" history="4"
       deadline="100 ms" lifespan="2 s" lease="1 min" ownership="exclusive" strength="3"/>
<topic name="c" history="all" deadline="none" ownership="shared"/></peer>)"));
  REQUIRE(mission.peers.at(0).topics.size() == 2);
  const auto all = changed(mission.peers[0], "a/b");
  CHECK_FALSE(all.reliable);
  CHECK(all.transient_local);
  CHECK(all.max_waiting == 0);
  CHECK(all.history_depth == 4U);
  CHECK(all.deadline == 100ms);
  CHECK(all.lifespan == 2s);
  CHECK(all.liveliness_lease == 1min);
  CHECK(all.exclusive);
  CHECK(all.strength == 3);
  const auto some = changed(mission.peers[0], "c", all);
  CHECK_FALSE(some.history_depth);
  CHECK_FALSE(some.deadline);
  CHECK_FALSE(some.exclusive);
  CHECK(some.strength == 0);
  CHECK_FALSE(some.reliable);
  CHECK(some.lifespan == 2s);
  CHECK(find_topic(mission.peers[0].topics, "a") == nullptr);
}

TEST_CASE("A peer has the topics that it does not name from its group, then from the mission") {
  ProfileFolder folder;
  const auto mission = read_mission_profile(folder.mission(R"(<topic name="a" history="1"/>
<topic name="b" history="1"/><topic name="c" history="1" lifespan="1 s"/>
<group name="g" component="f.xml"><topic name="b" history="2"/><topic name="c" history="2"/>
<peer name="f" count="2"><topic name="c" history="${instance}0"/></peer></group>)"));
  REQUIRE(mission.peers.size() == 2);
  const auto depth = [&](const char* name) {
    return changed(mission.peers[1], name).history_depth;
  };
  CHECK(depth("a") == 1U);
  CHECK(depth("b") == 2U);
  CHECK(depth("c") == 20U);
  CHECK_FALSE(changed(mission.peers[1], "c").lifespan);
  for (const TopicRules& rules : mission.peers[1].topics) {
    CAPTURE(rules.name);
    CHECK(rules.inherited == (rules.name != "c"));
  }
}

TEST_CASE(
    "Two names that a person takes for one topic are told once, with the place of the other") {
  ProfileFolder folder;
  CHECK(
      folder.check(R"(<topic name="pose" history="1"/><topic name="Pose" history="1"/>
<peer name="f" component="f.xml" count="2"><topic name="/pose" history="2"/></peer>)") ==
      "m.xml:2:8: warning: \"pose\" and \"/pose\" are two topics; write one name everywhere; the "
      "other is at m.xml:3:51\n"
      "m.xml:2:40: warning: \"Pose\" and \"/pose\" are two topics; write one name everywhere; the "
      "other is at m.xml:3:51\n");
}

TEST_CASE("A program of one's own has none of the mission's topics, and may name none") {
  ProfileFolder folder;
  CHECK(folder.check(R"(<topic name="a" history="1"/><peer name="f" program="true"/>)") == "");
  CHECK_THAT(folder.check(R"(<peer name="f" program="true"><topic name="a" history="1"/></peer>)"),
             Catch::Contains("m.xml:2:31: error: <topic> has no effect on a program of one's own"));
}

TEST_CASE("A topic that cannot be is a finding with its remedy") {
  const auto [topic, finding] = GENERATE(table<std::string, std::string>({
      {R"(name="skein/calls" history="1")", "\"skein/calls\" is one of Skein's own topics"},
      {R"(name="my topic" history="1")", "\"my topic\" is no topic's name; it has letters"},
      {R"(history="1")", "<topic> has no name; write name="},
      {R"(name="a" reliability="realiable")", "did you mean 'reliable'?"},
      {R"(name="a" durability="persistent")", "known are \"volatile\", \"transient-local\""},
      {R"(name="a" history="0")", "history is \"0\"; write how many values"},
      {R"(name="a" history="4294967296")", "history is \"4294967296\"; write how many values"},
      {R"(name="a" deadline="50 us")", "deadline is \"50 us\"; write whole milliseconds"},
      {R"(name="a" deadline="1.5 ms")", "deadline is \"1.5 ms\"; write whole milliseconds"},
      {R"(name="a" lifespan="soon")", "or \"none\""},
      {R"(name="a" lease="10000 h")", "lease is \"10000 h\"; write whole milliseconds"},
      {R"(name="a" strength="-1")", "strength is \"-1\"; write a number: 0, or more"},
      {R"(name="a" ownership="shared" strength="1")", "means nothing with shared ownership"},
      {R"(name="a" depth="1")", "<topic> has no \"depth\""},
      {R"(name="a"/><topic name="a")", "the topic \"a\" is there twice"},
  }));
  ProfileFolder folder;
  CHECK_THAT(folder.check("<peer name=\"f\" component=\"f.xml\"><topic " + topic + "/></peer>"),
             Catch::Contains(finding));
}
