// `skein param`: parameters of a peer that runs, on each vendor.
#include <catch2/catch.hpp>
#include <csignal>
#include <nlohmann/json.hpp>

#include "test/command/mission/errand.hpp"
#include "test/tools/command_run.hpp"
#include "test/tools/installed.hpp"
#include "test/tools/places.hpp"
#include "test/tools/temporary_folder.hpp"

using namespace skein::test;
using Catch::Contains;
using Words = std::vector<std::string>;

namespace {

/// What a command prints, and how it ends.
struct Said {
  std::string text;
  int code;
};

Words on_domain(Words words, const std::string& vendor) {
  words.insert(words.end(), {"--domain", "48", "--vendor", vendor});
  return words;
}

Said say_as_it_is(const Words& words) {
  CommandRun run(words);
  const int code = run.wait();
  return {run.output(), code};
}

Said say(const Words& words, const std::string& vendor) {
  return say_as_it_is(on_domain(words, vendor));
}

pid_t process_of(const std::string& entity, const std::string& vendor) {
  const Said peers = say({"peers", "--json"}, vendor);
  REQUIRE(peers.code == 0);
  for (const auto& peer : nlohmann::json::parse(peers.text))
    if (peer["name"] == entity) return peer["pid"];
  FAIL("no " << entity << " among the peers");
  return -1;
}

/// The guide's beacon, which refuses to wait for more than 10 s.
class Patrol {
 public:
  explicit Patrol(const std::string& vendor, const std::string& system = "uav-1",
                  const std::string& mission = "patrol")
      : vendor_(vendor), launch_({"launch", "--verbose", "--no-log", profile(system, mission)}) {
    REQUIRE(launch_.writes("beacon: ready"));
  }

  Said param(Words words) const {
    words.insert(words.begin(), "param");
    return say(words, vendor_);
  }

 private:
  std::string profile(const std::string& system, const std::string& mission) const {
    const std::string guide = project_file("test/guide/");
    return folder_.write(
        "patrol.xml", "<mission name='" + mission + "' domain='48' system='" + system +
                          "' vendor='" + vendor_ + "' plugin='patrol_components' dictionary='" +
                          guide + "dictionary.xml'><peer name='beacon' component='" + guide +
                          "beacon.xml'><parameter name='Period' value='0.1 s'/></peer></mission>");
  }

  const std::string vendor_;
  const TemporaryFolder folder_;
  CommandRun launch_;
};

void on_each_vendor(const std::function<void(const std::string& vendor)>& test) {
  for (const std::string vendor : {"cyclonedds", "fastdds"}) {
    if (!installed(vendor)) continue;
    CAPTURE(vendor);
    test(vendor);
  }
}

/// What does not depend on the vendor.
void on_one_vendor(const std::function<void(const std::string& vendor)>& test) {
  if (installed("cyclonedds")) test("cyclonedds");
}

}  // namespace

TEST_CASE("a parameter that may change is listed, read, and set while its peer runs") {
  on_each_vendor([](const std::string& vendor) {
    const Patrol patrol(vendor);
    CHECK(patrol.param({"get", "beacon", "Period"}).text == "100 ms\n");
    Said listed;
    REQUIRE(eventually([&] {
      listed = patrol.param({"list"});
      return listed.text.find("uav-1/beacon\n") != std::string::npos;
    }));
    CHECK(listed.code == 0);
    CHECK_THAT(listed.text, Contains("Period = 100 ms") &&
                                Contains("duration, at least 1 ms, at most 60000 ms"));
    const auto set = patrol.param({"set", "uav-1/beacon", "Period", "0.25 s"});
    CHECK((set.code == 0 && set.text == "uav-1/beacon: Period = 250 ms\n"));
    const auto told =
        nlohmann::json::parse(patrol.param({"get", "uav-1/beacon", "Period", "--json"}).text);
    CHECK(told["value"] == 250);
    const auto changed = nlohmann::json::parse(
        patrol.param({"set", "uav-1/beacon", "Period", "0.25 s", "--json"}).text);
    CHECK((changed["entity"] == "uav-1/beacon" && changed["value"] == 250));
    CHECK((told["unit"] == "ms" && told["live"] == true && told["maximum"] == 60000));
    const auto all = nlohmann::json::parse(patrol.param({"list", "uav-1/beacon", "--json"}).text);
    CHECK(all[0]["entity"] == "uav-1/beacon");
    CHECK(all[0]["parameters"][0] == told);
  });
}

TEST_CASE("completion is told the names that a domain has now") {
  on_one_vendor([](const std::string& vendor) {
    const Patrol patrol(vendor);
    const auto completed = [&](const Words& typed, const std::string& names,
                               const Words& last = {""}) {
      CAPTURE(typed, last);
      Words words{"complete", "--"};
      words.insert(words.end(), typed.begin(), typed.end());
      words = on_domain(words, vendor);
      words.insert(words.end(), last.begin(), last.end());
      Said said;  // it listens for a short time
      CHECK(eventually([&] { return said = say_as_it_is(words), said.text == names; }));
      CHECK(said.code == 0);
    };
    completed({"echo", "--json"}, "pose\n");
    completed({"record"}, "pose\n", {"--topics", ""});
    completed({"param", "get"}, "beacon\n");
    completed({"param", "get", "beacon"}, "Period\n");
    completed({"param", "get", "beacon", "--within", "500ms"}, "Period\n");
    completed({"call"}, "");
    completed({"describe"}, "pose\n");
  });
}

TEST_CASE("what may not be set is refused with its reason, by the code of its cause") {
  on_one_vendor([](const std::string& vendor) {
    const Patrol patrol(vendor);
    const auto expect = [&](const Words& words, int code, const std::string& reason) {
      CAPTURE(words, reason);
      const auto said = patrol.param(words);
      CHECK(said.code == code);
      CHECK_THAT(said.text, Contains(reason));
    };
    expect({"set", "uav-1/beacon", "Period", "20 s"}, 1, "nobody would see the drone move");
    expect({"set", "uav-1/beacon", "Period", "20"}, 78, "has no unit of time");
    expect({"set", "uav-1/beacon", "Period", "2 h"}, 78, "more than 60000 ms");
    expect({"set", "uav-1/beacon", "Perod", "2 s"}, 78, "did you mean 'Period'?");
    expect({"get", "uav-1/beacon", "Perod"}, 78, "did you mean 'Period'?");
    expect({"get", "becon", "Period", "--wait", "0.5s"}, 69, "did you mean 'beacon'?");
    expect({"dump", "beacon"}, 64, "in Skein: skein param list");
    CHECK(patrol.param({"get", "uav-1/beacon", "Period"}).text == "100 ms\n");
  });
}

TEST_CASE("of entities of one name in several systems none is chosen") {
  on_one_vendor([](const std::string& vendor) {
    const Patrol one(vendor);
    const Patrol other(vendor, "uav-2");
    const auto period = [&](const std::string& entity) {
      return one.param({"get", entity, "Period"}).text;
    };
    REQUIRE(period("uav-1/beacon") == "100 ms\n");
    REQUIRE(period("uav-2/beacon") == "100 ms\n");
    const auto left_open = one.param({"set", "beacon", "Period", "0.25 s"});
    CHECK(left_open.code == 78);
    CHECK_THAT(left_open.text, Contains("name one of uav-1/beacon, uav-2/beacon"));
    CHECK(one.param({"set", "uav-2/beacon", "Period", "0.25 s"}).code == 0);
    CHECK(period("uav-1/beacon") == "100 ms\n");
    CHECK(period("uav-2/beacon") == "250 ms\n");
  });
}

TEST_CASE("of processes that have one name in one system none is chosen") {
  on_one_vendor([](const std::string& vendor) {
    const Patrol one(vendor);
    const Patrol other(vendor, "uav-1", "another_patrol");
    Said said;
    REQUIRE(eventually([&] {
      said = one.param({"get", "beacon", "Period"});
      return said.code == 78;
    }));
    CHECK_THAT(said.text, Contains("several processes have the name uav-1/beacon ("));
  });
}

TEST_CASE("who asks a peer that does not answer is told so in time, and may give up before") {
  on_each_vendor([](const std::string& vendor) {
    const Errand errand;
    const CommandRun launch({"launch", "--verbose", "--no-log",
                             errand.profile("vendor='" + vendor + "'",
                                            "<peer name='thinker' component='thinker.xml'>"
                                            "<parameter name='Rate' value='5'/></peer>")});
    REQUIRE(launch.writes("thinker: ready"));
    const Words endless{"param", "set", "uav-1/thinker", "Rate", "6", "--within", "60s"};
    CommandRun given_up(on_domain(endless, vendor));
    REQUIRE(launch.writes("ponders 6"));
    given_up.signal(SIGINT);
    CHECK(given_up.wait() == 128 + SIGINT);

    const auto late = say({"param", "get", "uav-1/thinker", "Rate", "--within", "0.5s"}, vendor);
    CHECK(late.code == 124);
    CHECK_THAT(late.text,
               Contains("--within DURATION sets a longer limit") && !Contains("within()"));
    const auto list = say({"param", "list", "--within", "0.5s"}, vendor);
    CHECK(list.code == 124);
    CHECK_THAT(list.text, Contains("uav-1/thinker: ") && !Contains("nobody"));

    const pid_t thinker = process_of("uav-1/thinker", vendor);
    REQUIRE(kill(thinker, SIGSTOP) == 0);
    const auto stopped =
        say({"param", "get", "uav-1/thinker", "Rate", "--within", "1s", "--wait", "1s"}, vendor);
    CHECK((stopped.code == 69 || stopped.code == 124));
    REQUIRE(kill(thinker, SIGKILL) == 0);
    CHECK(say({"param", "get", "uav-1/thinker", "Rate", "--wait", "1s"}, vendor).code == 69);
  });
}

TEST_CASE("of a peer whose parameters are all fixed that is told, and not only when time is up") {
  on_one_vendor([](const std::string& vendor) {
    const Errand errand;
    const CommandRun launch({"launch", "--verbose", "--no-log",
                             errand.profile("vendor='" + vendor + "'",
                                            "<peer name='herald' component='herald.xml'/>")});
    REQUIRE(launch.writes("herald: ready"));
    const auto said = say({"param", "get", "herald", "Rate", "--wait", "10 min"}, vendor);
    CHECK(said.code == 69);
    CHECK_THAT(said.text, Contains("uav-1/herald has no parameter that may change while it runs"));
  });
}

TEST_CASE("where nobody has parameters that may change, that is told") {
  on_one_vendor([](const std::string& vendor) {
    const auto said = say({"param", "list", "--wait", "0.1s"}, vendor);
    CHECK(said.code == 0);
    CHECK_THAT(said.text, Contains("nobody in domain 48"));
  });
}
