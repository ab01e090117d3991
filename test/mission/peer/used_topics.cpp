#include "mission/peer/used_topics.hpp"

#include <catch2/catch.hpp>

using namespace skein::launch;

TEST_CASE("A rule for a topic that nobody used is told, with the nearest that was used") {
  UsedTopics topics;
  CHECK(topics.unneeded({}).empty());
  topics.add("fix");
  topics.add("fix");
  topics.add("pose");
  CHECK(topics.unneeded({{.name = "fix"}, {.name = "pose"}}).empty());
  CHECK(topics.unneeded({{.name = "weather", .inherited = true}}).empty());
  const auto texts = topics.unneeded({{.name = "fixx"}, {.name = "pose"}, {.name = "weather"}});
  REQUIRE(texts.size() == 2);
  CHECK(texts[0] ==
        "its profile has a <topic name=\"fixx\">, and it used no such topic (did you mean 'fix'?)");
  CHECK(texts[1] == "its profile has a <topic name=\"weather\">, and it used no such topic");
}

TEST_CASE("A rule for several peers is told by one that used a topic of almost that name") {
  UsedTopics topics;
  topics.add("load");
  const auto texts = topics.unneeded({{.name = "laod", .inherited = true}});
  REQUIRE(texts.size() == 1);
  CHECK(
      texts[0] ==
      "its profile has a <topic name=\"laod\">, and it used no such topic (did you mean 'load'?)");
  // Which has a rule of its own: the other one is meant for others.
  CHECK(topics.unneeded({{.name = "load"}, {.name = "loads", .inherited = true}}).empty());
}
