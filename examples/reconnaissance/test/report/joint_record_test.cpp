#include "report/joint_record.hpp"

#include <catch2/catch.hpp>

#include "traffic/encounter.hpp"

namespace joint_record_test {

using namespace reconnaissance;

namespace {

Verdict passed(double duration_s, double distance_m) {
  return {true, true, "", duration_s, distance_m, {{"survival", true, "survived"}}};
}

MissionRecord record_of(const std::string& target, double first_s) {
  MissionRecord record;
  record.survival = 0.9;
  record.tracked_s = 10;
  record.targets.push_back({.name = target, .line = {{1000, 0, 0}}});
  record.decisions.push_back({.time_s = first_s, .entity = "navigator", .chosen = "AStar"});
  record.decisions.push_back({.time_s = first_s + 10, .entity = "navigator", .chosen = "AStar"});
  record.track = {{.time_s = 0, .place = {0, 0, 180}}, {.time_s = 1, .place = {first_s, 0, 180}}};
  record.others.push_back({1, {{5, {}}}});
  record.others.push_back({kFirstCompanion, {{5, {}}}});
  record.threats.push_back({1, "short-range site", first_s, {5000 + first_s, 0, 0}, 100 + first_s});
  return record;
}

}  // namespace

TEST_CASE(
    "One verdict over several aircraft is passed if each is, and lasts as long as the longest") {
  const Verdict joint =
      joint_verdict({{"uav-1", passed(600, 30000)}, {"uav-2", passed(700, 40000)}});
  CHECK((joint.flown && joint.passed));
  CHECK(joint.duration_s == 700);
  CHECK(joint.distance_m == 70000);
  REQUIRE(joint.checks.size() == 2);
  CHECK(joint.checks[0].name == "uav-1 survival");
  CHECK(joint.checks[1].name == "uav-2 survival");
  CHECK(exit_code(joint) == kPassed);
}

TEST_CASE("Who fails is named, and one that is not flown to its end counts for all") {
  Verdict failed = passed(700, 40000);
  failed.passed = false;
  failed.reason = "targets: 2 of 3";
  const Verdict one = joint_verdict({{"uav-1", passed(600, 30000)}, {"uav-2", failed}});
  CHECK(one.flown);
  CHECK_FALSE(one.passed);
  CHECK(one.reason == "uav-2 targets: 2 of 3");
  CHECK(exit_code(one) == kFailed);
  failed.flown = false;
  CHECK(exit_code(joint_verdict({{"uav-1", failed}, {"uav-2", passed(1, 1)}})) == kNotFlown);
}

TEST_CASE("A record of two aircraft has both tracks, the targets of both, and says who decided") {
  const MissionRecord joint =
      joint_record({{"uav-1", record_of("depot", 20)}, {"uav-2", record_of("bridge", 15)}});
  CHECK(joint.track.size() == 2);
  CHECK(joint.track[1].place.north_m == 20);
  REQUIRE(joint.targets.size() == 2);
  CHECK(joint.targets[1].name == "bridge");
  CHECK(joint.survival == Approx(0.81));
  CHECK(joint.tracked_s == 20);
  std::vector<std::string> who;
  for (const DecisionTold& each : joint.decisions) who.push_back(each.entity);
  CHECK(who == std::vector<std::string>{"uav-2 navigator", "uav-1 navigator", "uav-2 navigator",
                                        "uav-1 navigator"});
  // The second's whole track, and not what the first has seen of it; intruders of both.
  std::vector<std::string> names;
  for (const OtherTrack& each : joint.others) names.push_back(each.name);
  CHECK(names == std::vector<std::string>{"", "uav-2", ""});
  CHECK(joint.others[1].number == kFirstCompanion);
  REQUIRE(joint.others[1].points.size() == 2);
  CHECK(joint.others[1].points[1].place.north_m == 15);
}

TEST_CASE("A site that both know is shown once, where it is known best and since it is known") {
  MissionRecord first = record_of("depot", 20), second = record_of("bridge", 15);
  second.threats.push_back({2, "short-range site", 30, {20000, 0, 0}, 100});
  const MissionRecord joint = joint_record({{"uav-1", first}, {"uav-2", second}});
  REQUIRE(joint.threats.size() == 2);
  CHECK(joint.threats[0].deviation_m == 115);
  CHECK(joint.threats[0].from_s == 15);
  CHECK(joint.threats[1].place.north_m == 20000);
}

}  // namespace joint_record_test
