#include <sys/wait.h>
#include <unistd.h>

#include <catch2/catch.hpp>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <limits>
#include <mutex>

#include "entity/entity_access.hpp"
#include "entity/head/decision_log.hpp"
#include "office.hpp"
#include "rpc/service/introspection_topic.hpp"
#include "skein/detail/type_support.hpp"
#include "skein/introspection.idl.hpp"
#include "test/tools/log.hpp"
#include "test/tools/places.hpp"

using namespace skein;
using namespace skein::test;
using namespace std::chrono_literals;
using introspection::Decision;
using Lines = std::vector<std::string>;

namespace {

struct File {
  explicit File(const std::string& name)
      : path("record_test." + std::to_string(getpid()) + "." + name) {}
  ~File() { std::remove(path.c_str()); }
  Lines lines() const {
    Lines lines;
    std::ifstream file(path);
    for (std::string line; std::getline(file, line);) lines.push_back(line);
    return lines;
  }
  const std::string path;
};

/// Two that disagree with what they declare, one that crashes, and a task with features.
struct Mixed {
  explicit Mixed(HeadOptions options) : office(std::move(options)) {
    office.add(
        "wrong", Place::Inside, [](const std::string&) { return std::string("wrong"); },
        declared("20", "0.9"));
    office.add(
        "crash", Place::Inside,
        [](const std::string&) -> std::string { throw std::runtime_error("a bug"); },
        declared("30", "0.7"));
    office.add("sound", Place::Inside, answer_as("sound"), declared("10", "0.5"));
    task.request = "route 7";
    task.quality = [](const std::string&) { return 0.3; };
  }
  void perform(int times) {
    for (int i = 0; i < times; ++i) {
      task.features = {{"size", 100.0 + i}};
      office.perform(task, 10s);
    }
  }
  Office office;
  WorkTask task = Office::task();
};

}  // namespace

TEST_CASE("each decision's choices come out of its record again, bit for bit") {
  const std::string strategy = GENERATE(from_range(StrategyFactory().names()));
  Mixed mixed({.strategy = strategy, .exploration = 0.3});
  mixed.perform(40);
  bool explored = false;
  for (const Decision& record : mixed.office.owner->head().decisions()) {
    const auto carried = idl::from_json<Decision>(idl::to_json(record));
    REQUIRE(carried == record);
    REQUIRE(replay(carried) == record.attempts);
    for (const auto& attempt : record.attempts) explored = explored || attempt.explores;
  }
  CHECK(explored == StrategyFactory().make(strategy)->reads_history());
}

TEST_CASE("a record with a quality that is no number comes out again") {
  Mixed mixed({.strategy = "learned"});
  mixed.perform(3);
  Decision record = mixed.office.owner->head().decisions().back();
  record.attempts.back().quality = {std::numeric_limits<double>::quiet_NaN()};
  const auto carried = idl::from_json<Decision>(idl::to_json(record));
  const auto again = replay(carried);
  REQUIRE(again.size() == record.attempts.size());
  for (std::size_t i = 0; i < again.size(); ++i) CHECK(same_choice(again[i], record.attempts[i]));
  record.attempts.front().reason = "another";
  CHECK_FALSE(same_choice(again.front(), record.attempts.front()));
}

TEST_CASE("a record that was changed does not come out again") {
  Mixed mixed({.strategy = "learned"});
  mixed.perform(3);
  Decision record = mixed.office.owner->head().decisions().back();
  std::swap(record.candidates.front().quality, record.candidates.back().quality);
  for (auto& candidate : record.candidates) candidate.learned.clear();
  CHECK(replay(record) != record.attempts);
  record.strategy = "no such";
  CHECK_THROWS_AS(replay(record), InvalidArgument);
}

TEST_CASE(
    "a record tells of features, predictions, breakers, the check that rejected, and the request") {
  Mixed mixed({});
  mixed.perform(4);
  const auto& record = mixed.office.record;
  CHECK(record.entity == "uav-1/office");
  CHECK(record.request == "route 7");
  CHECK(record.features == std::vector<introspection::NamedValue>{{"size", 103}});
  CHECK(record.failure.empty());
  CHECK(record.number == 4);
  REQUIRE(record.candidates.size() == 3);
  for (const auto& candidate : record.candidates) {
    const bool sound = candidate.csp == "sound";
    CHECK(candidate.breaker ==
          (sound ? introspection::BreakerState::Closed : introspection::BreakerState::Open));
    CHECK(candidate.learned.empty());  // which `declared` does not ask for
  }
  CHECK(mixed.office.attempts() == Lines{"sound accepted"});
  CHECK(record.attempts[0].quality == std::vector{0.3});
  const auto first = mixed.office.owner->head().decisions().front();
  REQUIRE(first.attempts.size() == 3);
  CHECK(first.attempts[0].check == "evaluation");
  CHECK(first.attempts[0].text == "it is wrong");
  CHECK(first.attempts[2].began >= first.attempts[1].began);
}

TEST_CASE("a record tells of what was predicted, and of the runs on which that rests") {
  Mixed mixed({.strategy = "learned", .exploration = 0});
  mixed.task.utility = {Utility::Aim::GoodEnoughSoon, 0.2};
  mixed.perform(4);
  const auto& record = mixed.office.record;
  CHECK(record.utility == "good_enough_soon");
  CHECK(record.good_enough == 0.2);
  const auto& sound = record.candidates[1];
  REQUIRE(sound.csp == "sound");
  REQUIRE(sound.learned.size() == 1);
  CHECK(sound.learned[0].similar == 3);
  CHECK(sound.learned[0].reliability == 1);
  REQUIRE(sound.learned[0].runs.size() == 3);
  CHECK(sound.learned[0].runs[0].accepted);
  CHECK(sound.learned[0].runs[0].quality == std::vector{0.3});
}

TEST_CASE("a decision is explained in plain words") {
  Mixed mixed({});
  mixed.perform(4);
  CHECK_THAT(explain(mixed.office.owner->head().decisions().front()),
             Catch::Contains("on 'route 7'") && Catch::Contains("\n  for size 100\n") &&
                 Catch::Contains("wrong (in the process) declares 20 ms") &&
                 Catch::Contains("rejected after") &&
                 Catch::Contains("by the check 'evaluation': it is wrong") &&
                 Catch::Contains("failed after") && Catch::Contains("a bug") &&
                 Catch::Contains("answered after"));
  CHECK_THAT(explain(mixed.office.record),
             Catch::Contains("in quarantine for") && !Catch::Contains("has not run before"));
}

TEST_CASE("what was predicted is told, too, and who has not run before") {
  Mixed mixed({.strategy = "learned", .exploration = 0});
  mixed.perform(4);
  CHECK_THAT(explain(mixed.office.owner->head().decisions()[1]),
             Catch::Contains("over 1 similar request: median"));
  mixed.office.add("new", Place::Inside, answer_as("new"), declared("10", "0.1"));
  mixed.perform(1);
  CHECK_THAT(explain(mixed.office.record), Catch::Contains("; has not run before"));
}

TEST_CASE_METHOD(Office, "decisions without a result are recorded with the reason") {
  CHECK_THROWS_AS(perform(Office::task(), 1s), NoCandidate);
  CHECK_THAT(record.failure, Catch::Contains("crew/Worker"));
  CHECK(owner->head().decisions().size() == 1);
}

TEST_CASE("each decision is a line of the log that the entity names") {
  const File log("log");
  Mixed mixed({.log = log.path});
  mixed.perform(5);
  const Lines lines = log.lines();
  REQUIRE(lines.size() == 5);
  const auto last = idl::from_json<Decision>(lines.back());
  CHECK(last.number == 5);
  CHECK(last == mixed.office.owner->head().decisions().back());
}

TEST_CASE("a log that ends in the middle of a line is continued on a line of its own") {
  const File log("log");
  std::ofstream(log.path) << R"({"number": 1, "ent)";
  Mixed mixed({.log = log.path});
  mixed.perform(1);
  const Lines lines = log.lines();
  REQUIRE(lines.size() == 2);
  CHECK(idl::from_json<Decision>(lines[1]) == mixed.office.owner->head().decisions().back());
}

TEST_CASE("a full log makes room for what follows, and is kept under another name") {
  const File log("full.jsonl");
  const File earlier("full.1.jsonl");
  Decision decision;
  decision.request = std::string(400, 'r');
  entity::DecisionLog file("crew/owner", log.path, 4000);
  for (decision.number = 1; decision.number <= 12; ++decision.number) file.write(decision);
  const Lines now = log.lines();
  const Lines before = earlier.lines();
  REQUIRE(!before.empty());
  REQUIRE(!now.empty());
  CHECK(std::filesystem::file_size(earlier.path) <= 4000);
  CHECK(idl::from_json<Decision>(now.back()).number == 12);
  CHECK(idl::from_json<Decision>(before.back()).number + now.size() == 12);
}

TEST_CASE("that a log is not written any more is told once, not for each decision") {
  const Log captured;
  Mixed mixed({.log = "/dev/full"});
  mixed.perform(5);
  CHECK(captured.count("a decision could not be written to '/dev/full': No space left") == 1);
}

TEST_CASE("a line of a log with an outcome that nobody knows is refused, with its place and word") {
  Mixed mixed({});
  mixed.perform(1);
  std::string line = idl::to_json(mixed.office.owner->head().decisions().back());
  const std::string known = "\"Accepted\"";
  const auto place = line.find(known);
  REQUIRE(place != std::string::npos);
  line.replace(place, known.size(), "\"Exploded\"");
  const File log("log");
  std::ofstream(log.path) << line << '\n';
  const File said("said");
  const std::string command =
      "'" + built_program("skein") + "' decisions --log " + log.path + " > " + said.path + " 2>&1";
  const int status = std::system(command.c_str());
  CHECK(WIFEXITED(status));
  CHECK(WEXITSTATUS(status) != 0);
  REQUIRE(said.lines().size() == 1);
  CHECK_THAT(said.lines()[0], Catch::Contains(log.path + ":1: ") && Catch::Contains("Exploded"));
}

TEST_CASE(
    "a log or history that cannot be written, and a strategy that is not there, are refused at the "
    "start") {
  CHECK_THROWS_WITH(Office(HeadOptions{.log = "no_such_folder/log"}),
                    Catch::Contains("no_such_folder/log': No such file or directory"));
  CHECK_THROWS_WITH(Office(HeadOptions{.history = "no_such_folder/history"}),
                    Catch::Contains("no_such_folder/history.new': No such file or directory"));
  CHECK_THROWS_WITH(Office(HeadOptions{.strategy = "learnt"}),
                    Catch::Contains("did you mean 'learned'"));
}

TEST_CASE("what a Head has learned it knows again after a restart") {
  const File history("history");
  const HeadOptions options{.strategy = "learned", .history = history.path};
  std::string learned;
  {
    Mixed mixed(options);
    mixed.perform(3);
    learned = mixed.office.owner->head().history().to_json();
  }
  const Office again(options);
  CHECK(again.owner->head().history().to_json() == learned);
}

TEST_CASE("who reads the topic of decisions gets each as it is made", "[wire]") {
  Mixed mixed({});
  const auto onlooker = make_client();
  std::mutex mutex;
  std::vector<Decision> seen;
  introspection::Reader<Decision> reader(EntityAccess::participant(*onlooker),
                                         introspection::kTopic<Decision>,
                                         [&](const Decision& decision) {
                                           const std::lock_guard lock(mutex);
                                           seen.push_back(decision);
                                         });
  REQUIRE(eventually([&] {
    mixed.perform(1);
    const std::lock_guard lock(mutex);
    return !seen.empty();
  }));
  const std::lock_guard lock(mutex);
  const auto decisions = mixed.office.owner->head().decisions();
  const auto told = std::find_if(decisions.begin(), decisions.end(), [&](const auto& each) {
    return each.number == seen.back().number;
  });
  REQUIRE(told != decisions.end());
  CHECK(*told == seen.back());
}

TEST_CASE("figures of requests of which none was similar say so") {
  Decision record;
  record.candidates.emplace_back().csp = "sound";
  introspection::LearnedFigures figures;
  figures.median = {80'000'000};
  figures.reliability = 1;
  record.candidates.front().learned = {figures};
  CHECK_THAT(explain(record),
             Catch::Contains("over requests of which none was similar: median 80 ms"));
}
