// What `skein doctor` says of machines on which something is wrong, and of missions that fly.
#include <catch2/catch.hpp>
#include <csignal>
#include <nlohmann/json.hpp>

#include "test/command/mission/errand.hpp"
#include "test/tools/command_run.hpp"
#include "test/tools/installed.hpp"
#include "test/tools/network_space.hpp"

using namespace skein;
using namespace skein::test;
using Catch::Contains;

namespace {

const std::string kOffice = "<peer name='office' component='office.xml'/>";
const std::string kClient =
    "<peer name='client' component='client.xml' ready_timeout='20 s' restart='never'/>";

/// The finding about a thing; null where there is none.
nlohmann::json about(const std::string& thing, const std::string& output) {
  const auto report = nlohmann::json::parse(output);
  for (const auto& finding : report["findings"])
    if (finding["about"] == thing) return finding;
  return nullptr;
}

}  // namespace

TEST_CASE("on a host where peers can speak, they find each other, and nothing is an error") {
  CommandRun run({"doctor", "--domain", "51", "--json"});
  CHECK(run.wait() <= 1);
  CHECK(about("discovery", run.output())["severity"] == "fine");
  CHECK(about("loopback", run.output())["severity"] == "fine");
}

TEST_CASE("where loopback is down, that is the cause, and the exit code says so") {
  const NetworkSpace space;
  space.run("ip link set lo down");
  CommandRun run({"doctor"}, {.network = space.descriptor()});
  CHECK(run.wait() == 2);
  CHECK_THAT(run.output(),
             Contains("the loopback interface is down") && Contains("sudo ip link set lo up"));
}

TEST_CASE("an interface that is down is told by all that would speak on it, with the remedy") {
  const Errand errand;
  const NetworkSpace space;
  space.run("ip link add near type veth peer name far && ip address add 10.1.1.1/24 dev near");
  const auto [interface, problem, remedy] = GENERATE(table<std::string, std::string, std::string>({
      {"lo", "the loopback interface is down", "sudo ip link set lo up"},
      {"near", "the interface near is down", "sudo ip link set near up"},
  }));
  if (interface == "lo") space.run("ip link set lo down");
  const std::string attributes = interface == "lo" ? "" : "interface='" + interface + "'";
  const std::string profile = errand.profile(attributes, kOffice);
  for (const std::string command : {"check", "launch"}) {
    CAPTURE(command, interface);
    CommandRun run({command, profile}, {.network = space.descriptor()});
    CHECK(run.wait() == (command == "check" ? 78 : 71));
    CHECK_THAT(run.output(), Contains("errand.xml:1:") && Contains("'office' cannot speak: ") &&
                                 Contains(problem) && Contains(remedy));
  }
  for (const std::string vendor : {"fastdds", "cyclonedds"}) {
    if (!installed(vendor)) continue;
    CAPTURE(vendor, interface);
    CommandRun run({"peers", "--interface", interface, "--vendor", vendor},
                   {.network = space.descriptor()});
    CHECK(run.wait() != 0);
    CHECK_THAT(run.output(), Contains(problem) && Contains(remedy) && !Contains("port"));
  }
}

TEST_CASE("Fast DDS starts on no interface without a carrier, and says that this is the reason") {
  if (!installed("fastdds")) return;
  const NetworkSpace space;
  space.run(
      "ip link add near type veth peer name far && ip address add 10.1.1.1/24 dev near && "
      "ip link set near up");
  CommandRun run({"peers", "--interface", "near", "--vendor", "fastdds"},
                 {.network = space.descriptor()});
  CHECK(run.wait() != 0);
  CHECK_THAT(run.output(), Contains("the interface near has no carrier") &&
                               Contains("ip link show dev near") && !Contains("port"));
}

TEST_CASE("an interface without an address is an error with its remedy") {
  const NetworkSpace space;
  space.run("ip link add near type veth peer name far && ip link set near up");
  CommandRun run({"doctor", "--interface", "near", "--json"}, {.network = space.descriptor()});
  CHECK(run.wait() == 2);
  CHECK_THAT(about("interface", run.output())["cause"].get<std::string>(),
             Contains("near has no IPv4 address"));
}

TEST_CASE("what is wrong with a profile is among the findings") {
  const Errand errand;
  const std::string profile =
      errand.profile("", "<peer name='office' component='office.xml' plugin='skein_nothing'/>");
  CommandRun run({"doctor", profile, "--json"});
  CHECK(run.wait() == 2);
  const auto finding = about("profile", run.output());
  CHECK_THAT(finding["cause"].get<std::string>(), Contains("no libskein_nothing.so"));
  CHECK_THAT(finding["evidence"].get<std::string>(), Contains("errand.xml:1:"));
}

TEST_CASE("a profile with gaps still tells which domain to look at") {
  const Errand errand;
  const std::string profile =
      errand.profile("", "<peer name='client' component='client.xml' role='mission'/>");
  CommandRun run({"doctor", profile, "--json"});
  CHECK(run.wait() == 2);
  CHECK_THAT(about("profile", run.output())["cause"].get<std::string>(), Contains("crew/Desk"));
  CHECK_THAT(about("discovery", run.output())["cause"].get<std::string>(), Contains("domain 48"));
}

TEST_CASE("a profile that cannot be read is an error of its own") {
  CommandRun run({"doctor", "nowhere.xml"});
  CHECK(run.wait() == 2);
  CHECK_THAT(run.output(), Contains("nowhere.xml"));
}

TEST_CASE("of a mission that flies it is told that its peers answer, and by which launcher") {
  if (!installed("fastdds") || !installed("cyclonedds")) return;
  const Errand errand;
  const std::string profile = errand.profile("", kOffice);
  CommandRun before({"doctor", profile, "--json"});
  CHECK(before.wait() <= 1);
  CHECK_THAT(about("peers", before.output())["cause"].get<std::string>(),
             Contains("does not fly now"));
  CommandRun mission({"launch", profile});
  REQUIRE(mission.writes("all 1 processes are ready"));
  CommandRun during({"doctor", profile, "--json"});
  CHECK(during.wait() <= 1);
  CHECK_THAT(about("peers", during.output())["cause"].get<std::string>(),
             Contains("all 1 peers of the mission answer"));
  CHECK_THAT(about("missions", during.output())["evidence"].get<std::string>(),
             Contains("pid " + std::to_string(mission.pid())));
}

TEST_CASE("a peer that does not answer while others do is named") {
  if (!installed("fastdds") || !installed("cyclonedds")) return;
  const Errand errand;
  CommandRun mission({"launch", errand.profile("", kOffice)});
  REQUIRE(mission.writes("all 1 processes are ready"));
  const std::string more =
      errand.profile("", kOffice + "<peer name='branch' component='office.xml'/>");
  CommandRun run({"doctor", more, "--json"});
  CHECK(run.wait() >= 1);
  const auto finding = about("peers", run.output());
  CHECK(finding["severity"] == "warning");
  CHECK_THAT(finding["cause"].get<std::string>(), Contains("the peer 'branch' does not answer"));
}

TEST_CASE("where no peer of a mission answers, though its launcher runs, the mission flies") {
  if (!installed("fastdds") || !installed("cyclonedds")) return;
  const Errand errand;
  const std::string profile = errand.profile("", kOffice);
  CommandRun mission({"launch", "--verbose", profile});
  REQUIRE(mission.writes("all 1 processes are ready"));
  CommandRun status({"status", "--json", profile});
  REQUIRE(status.wait() == 0);
  const auto pid = nlohmann::json::parse(status.output())["processes"][0]["pid"].get<pid_t>();
  REQUIRE(kill(pid, SIGSTOP) == 0);
  CommandRun run({"doctor", profile, "--json"});
  CHECK(run.wait() == 1);
  CHECK_THAT(run.output(), Contains("no peer of the mission answers, though its launcher runs"));
  CHECK(kill(pid, SIGCONT) == 0);
}

TEST_CASE("a peer that --only leaves out is not missed") {
  if (!installed("fastdds") || !installed("cyclonedds")) return;
  const Errand errand;
  const std::string profile =
      errand.profile("", kOffice + "<peer name='branch' component='office.xml'/>");
  CommandRun mission({"launch", profile, "--only", "office"});
  REQUIRE(mission.writes("all 1 processes are ready"));
  CommandRun run({"doctor", profile, "--json"});
  CHECK(run.wait() <= 1);
  const auto finding = about("peers", run.output());
  CHECK(finding["severity"] == "note");
  CHECK(finding["cause"] == "not started here, which --only leaves out: branch");
  CHECK_THAT(run.output(), Contains("all 1 peers of the mission answer"));
}

TEST_CASE("a doctor that is interrupted while it looks ends") {
  CommandRun run({"doctor", "--domain", "52"});
  run.signal(SIGINT);
  CHECK(run.wait() >= 0);
}
