// `skein param`: parameters of a peer that runs, on each vendor.
#include <catch2/catch.hpp>
#include <csignal>
#include <fstream>
#include <nlohmann/json.hpp>

#include "../tools/places.hpp"
#include "command_run.hpp"
#include "installed.hpp"

using namespace skein::test;
using Catch::Contains;
using Words = std::vector<std::string>;

namespace {

/// The guide's beacon, which refuses to wait for more than 10 s.
class Patrol {
 public:
  explicit Patrol(const std::string& vendor)
      : vendor_(vendor), launch_({"launch", "--verbose", "--no-log", profile()}) {
    REQUIRE(launch_.writes("beacon is ready"));
  }

  /// What a command prints, and how it ends.
  struct Said {
    std::string text;
    int code;
  };
  Said param(Words words) const {
    words.insert(words.begin(), "param");
    words.insert(words.end(), {"--domain", "48", "--vendor", vendor_});
    CommandRun run(words);
    const int code = run.wait();
    return {run.output(), code};
  }

  pid_t beacon() const {
    CommandRun peers({"peers", "--domain", "48", "--vendor", vendor_, "--json"});
    REQUIRE(peers.wait() == 0);
    for (const auto& peer : nlohmann::json::parse(peers.output()))
      if (peer["name"] == "uav-1/beacon") return peer["pid"];
    FAIL("no beacon among the peers");
    return -1;
  }

 private:
  std::string profile() const {
    std::string pattern = (std::filesystem::temp_directory_path() / "skein-patrol-XXXXXX").string();
    REQUIRE(mkdtemp(pattern.data()));
    folder_ = {new std::filesystem::path(pattern), [](const std::filesystem::path* path) {
                 std::error_code ignored;
                 std::filesystem::remove_all(*path, ignored);
                 delete path;
               }};
    const std::string guide = project_file("test/guide/");
    const std::string file = (*folder_ / "patrol.xml").string();
    std::ofstream(file) << "<mission name='patrol' domain='48' system='uav-1' vendor='" << vendor_
                        << "' plugin='patrol_components' dictionary='" << guide
                        << "dictionary.xml'><peer name='beacon' component='" << guide
                        << "beacon.xml'><parameter name='Period' value='0.1 s'/></peer></mission>";
    return file;
  }

  const std::string vendor_;
  mutable std::shared_ptr<const std::filesystem::path> folder_;
  CommandRun launch_;
};

void on_each_vendor(const std::function<void(const std::string& vendor)>& test) {
  for (const std::string vendor : {"cyclonedds", "fastdds"}) {
    if (!installed(vendor)) continue;
    CAPTURE(vendor);
    test(vendor);
  }
}

}  // namespace

TEST_CASE("a parameter that may change is listed, read, and set while its peer runs") {
  on_each_vendor([](const std::string& vendor) {
    const Patrol patrol(vendor);
    const auto listed = patrol.param({"list"});
    CHECK(listed.code == 0);
    CHECK_THAT(listed.text, Contains("uav-1/beacon\n") && Contains("Period = 100 ms") &&
                                Contains("duration, at least 1 ms, at most 60000 ms"));
    CHECK(patrol.param({"get", "beacon", "Period"}).text == "100 ms\n");
    const auto set = patrol.param({"set", "uav-1/beacon", "Period", "0.25 s"});
    CHECK((set.code == 0 && set.text == "Period = 250 ms\n"));
    const auto told =
        nlohmann::json::parse(patrol.param({"get", "beacon", "Period", "--json"}).text);
    CHECK(told["value"] == 250);
    CHECK((told["unit"] == "ms" && told["live"] == true && told["maximum"] == 60000));
    const auto all = nlohmann::json::parse(patrol.param({"list", "beacon", "--json"}).text);
    CHECK(all[0]["entity"] == "uav-1/beacon");
    CHECK(all[0]["parameters"][0] == told);
  });
}

TEST_CASE("completion is told the names that a domain has now") {
  on_each_vendor([](const std::string& vendor) {
    const Patrol patrol(vendor);
    const auto names = [&](Words words) {
      words.insert(words.begin(), "complete");
      words.insert(words.end(), {"--domain", "48", "--vendor", vendor});
      CommandRun run(words);
      CHECK(run.wait() == 0);
      return run.output();
    };
    CHECK(names({"topic", "echo", "--json"}) == "pose\n");
    CHECK(names({"entity", "param", "get"}) == "beacon\n");
    CHECK(names({"parameter", "param", "get", "beacon"}) == "Period\n");
    CHECK(names({"service", "call"}).empty());
    CHECK(names({"name", "describe"}) == "pose\n");
  });
}

TEST_CASE("what may not be set is refused with its reason, by the code of its cause") {
  on_each_vendor([](const std::string& vendor) {
    const Patrol patrol(vendor);
    const auto expect = [&](const Words& words, int code, const std::string& reason) {
      CAPTURE(words, reason);
      const auto said = patrol.param(words);
      CHECK(said.code == code);
      CHECK_THAT(said.text, Contains(reason));
    };
    expect({"set", "beacon", "Period", "20 s"}, 1, "nobody would see the drone move");
    expect({"set", "beacon", "Period", "20"}, 78, "has no unit of time");
    expect({"set", "beacon", "Period", "2 h"}, 78, "more than 60000 ms");
    expect({"set", "beacon", "Perod", "2 s"}, 78, "did you mean 'Period'?");
    expect({"get", "beacon", "Perod"}, 78, "did you mean 'Period'?");
    expect({"get", "becon", "Period", "--wait", "0.5s"}, 69, "did you mean 'beacon'?");
    expect({"dump", "beacon"}, 64, "in Skein: skein param list");
    CHECK(patrol.param({"get", "beacon", "Period"}).text == "100 ms\n");
  });
}

TEST_CASE("who asks a peer that is stopped or dies is not held up") {
  on_each_vendor([](const std::string& vendor) {
    const Patrol patrol(vendor);
    const pid_t beacon = patrol.beacon();
    REQUIRE(kill(beacon, SIGSTOP) == 0);
    const auto stopped =
        patrol.param({"set", "beacon", "Period", "1 s", "--within", "1s", "--wait", "1s"});
    CHECK((stopped.code == 69 || stopped.code == 124));
    REQUIRE(kill(beacon, SIGKILL) == 0);
    const auto dead = patrol.param({"get", "beacon", "Period", "--within", "60s", "--wait", "1s"});
    CHECK(dead.code == 69);
  });
}
