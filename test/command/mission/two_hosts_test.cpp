// `skein launch` on two hosts: two network namespaces, joined by a pair of veth devices.
#include "two_hosts.hpp"

#include <catch2/catch.hpp>
#include <csignal>
#include <memory>

#include "errand.hpp"
#include "test/tools/command_run.hpp"
#include "test/tools/installed.hpp"

using namespace skein::test;
using Catch::Contains;

namespace {

std::string peers_on(const std::string& office_host, const std::string& client_host,
                     const std::string& office_vendor, const std::string& client_vendor) {
  return "<peer name='office' component='office.xml' vendor='" + office_vendor + "' host='" +
         office_host + "'/><peer name='client' component='client.xml' role='mission' vendor='" +
         client_vendor + "' host='" + client_host + "'/>";
}

/// The office's launcher runs on alpha, the client's on beta.
void flies(const TwoHosts& hosts, const std::string& profile,
           const std::vector<std::string>& on_alpha, const std::vector<std::string>& on_beta) {
  std::vector<std::string> words{"launch", profile};
  words.insert(words.end(), on_alpha.begin(), on_alpha.end());
  CommandRun office(words, {.network = hosts.alpha.descriptor()});
  words.resize(2);
  words.insert(words.end(), on_beta.begin(), on_beta.end());
  CommandRun client(words, {.network = hosts.beta.descriptor()});
  const int exit_code = client.wait();
  INFO("office: " << office.output() << "\nclient: " << client.output());
  CHECK(exit_code == 0);
  CHECK_THAT(client.output(), Contains("the desk says: yes, dear"));
  CHECK_THAT(client.output(), Contains("not started here: office on "));
  CHECK(office.writes("the peer that runs the mission is not among them"));
  CHECK_THAT(office.output(), Contains("not started here: client on "));
  office.signal(SIGINT);
  CHECK(office.wait() == 128 + SIGINT);
}

/// What a profile calls the two hosts.
enum class HostsBy { Address, Name };

/// Each vendor is the office's once, with these attributes of the mission.
void fly_both_ways(const std::string& attributes, HostsBy hosts_by) {
  const auto [office, client] = GENERATE(
      table<std::string, std::string>({{"fastdds", "cyclonedds"}, {"cyclonedds", "fastdds"}}));
  if (!installed(office) || !installed(client)) return;
  CAPTURE(office, client);
  const TwoHosts hosts;
  const Errand errand;
  if (hosts_by == HostsBy::Address) {
    flies(hosts, errand.profile(attributes, peers_on("10.78.0.1", "10.78.0.2", office, client)), {},
          {});
  } else {
    flies(hosts, errand.profile(attributes, peers_on("alpha.test", "beta.test", office, client)),
          {"--host", "alpha.test"}, {"--host", "beta.test"});
  }
}

}  // namespace

TEST_CASE("a mission flies over two hosts whose addresses are all that its profile names") {
  fly_both_ways("interface='skein0'", HostsBy::Address);
}

TEST_CASE("a mission flies over two hosts that ask the peers that its profile names") {
  fly_both_ways("interface='skein0' peers='10.78.0.1 10.78.0.2'", HostsBy::Name);
}

TEST_CASE("a mission flies over two hosts that find each other by multicast") {
  fly_both_ways("interface='skein0' multicast='true'", HostsBy::Name);
}

TEST_CASE("whose address a profile does not allow never finds the service, and is counted") {
  const auto [office_vendor, caller_vendor] = GENERATE(
      table<std::string, std::string>({{"fastdds", "cyclonedds"}, {"cyclonedds", "fastdds"}}));
  if (!installed(office_vendor) || !installed(caller_vendor)) return;
  CAPTURE(office_vendor, caller_vendor);
  const TwoHosts hosts;
  const Errand errand;
  const std::string network = "interface='skein0' peers='10.78.0.1 10.78.0.2 10.78.0.3'";
  CommandRun office(
      {"launch", errand.profile(network + " allowed_sources='10.78.0.2'",
                                "<peer name='office' component='office.xml' vendor='" +
                                    office_vendor + "' host='10.78.0.1'/>")},
      {.network = hosts.alpha.descriptor()});
  REQUIRE(office.writes("all 1 processes are ready"));
  const auto look = [&](const std::string& seconds) {
    return std::make_unique<CommandRun>(
        std::vector<std::string>{"services", "--domain", "48", "--vendor", caller_vendor, "--wait",
                                 seconds, "--interface", "skein0", "--peers", "10.78.0.1"},
        CommandOptions{.network = hosts.beta.descriptor()});
  };

  hosts.beta.run("ip addr flush dev skein0 && ip addr add 10.78.0.3/24 dev skein0");
  const auto stranger = look("600");
  const std::string refused =
      "refused a message from 10.78.0.3: its address is not among the allowed sources (refused so "
      "far for this reason: ";
  CHECK(office.writes(refused + "1)"));
  CHECK(office.writes(refused + "10)"));
  stranger->signal(SIGINT);
  stranger->wait();
  CHECK_THAT(stranger->output(), Contains("0 services in domain 48"));

  hosts.beta.run("ip addr flush dev skein0 && ip addr add 10.78.0.2/24 dev skein0");
  CHECK(eventually([&] {
    const auto friendly = look("2");
    return friendly->wait() == 0 &&
           friendly->output().find("1 service in domain 48") != std::string::npos;
  }));
}

TEST_CASE("an onlooker of a mission sees the services of both hosts, by the mission's profile") {
  if (!installed("cyclonedds")) return;
  const TwoHosts hosts;
  const Errand errand;
  const std::string profile = errand.profile(
      "interface='skein0'",
      "<peer name='first' component='office.xml' vendor='cyclonedds' host='10.78.0.1'/>"
      "<peer name='second' component='office.xml' vendor='cyclonedds' host='10.78.0.2'/>");
  CommandRun first({"launch", profile}, {.network = hosts.alpha.descriptor()});
  CommandRun second({"launch", profile}, {.network = hosts.beta.descriptor()});
  REQUIRE(first.writes("all 1 processes are ready"));
  REQUIRE(second.writes("all 1 processes are ready"));
  const std::vector<std::string> ways[] = {
      {"services", "--profile", profile},
      {"services", "--domain", "48", "--interface", "skein0", "--peers", "10.78.0.2"}};
  for (const auto& way : ways) {
    CHECK(eventually([&] {
      CommandRun services(way, {.network = hosts.alpha.descriptor()});
      return services.wait() == 0 &&
             services.output().find("2 services in domain 48") != std::string::npos;
    }));
  }
}

TEST_CASE("what keeps two hosts from meeting is said at once, and nothing is started") {
  const TwoHosts hosts;
  const Errand errand;
  const std::string command = GENERATE("check", "launch");
  CAPTURE(command);
  // What may yet come, as a device does that is plugged in, is tried again.
  const int passing = command == "check" ? 78 : 71;
  const auto says = [&](int code, const std::string& attributes, const std::string& other_host,
                        const std::string& part) {
    const std::string profile =
        errand.profile(attributes, peers_on("10.78.0.1", other_host, "cyclonedds", "cyclonedds"));
    CommandRun run({command, profile}, {.network = hosts.alpha.descriptor()});
    CHECK(run.wait() == code);
    CHECK_THAT(run.output(), Contains(part));
  };
  says(78, "", "10.78.0.2", "'office' speaks on 127.0.0.1 alone, and the mission has peers on");
  says(passing, "interface='skein0'", "beta.test", "host 'beta.test' has no IPv4 address");
  says(passing, "interface='skein9'", "10.78.0.2", "no such interface");
  says(passing, "interface='skein9'", "10.78.0.2", "it has lo (127.0.0.1), skein0 (10.78.0.1)");
  says(78, "interface='sklein0'", "10.78.0.2", "did you mean 'skein0'?");
}

TEST_CASE("a launcher that has nothing to start says where the mission's peers are, and fails") {
  const TwoHosts hosts;
  const Errand errand;
  const std::string profile = errand.profile(
      "interface='skein0'", peers_on("10.78.0.2", "10.78.0.3", "cyclonedds", "cyclonedds"));
  CommandRun run({"launch", profile}, {.network = hosts.alpha.descriptor()});
  CHECK(run.wait() == 78);
  CHECK_THAT(run.output(), Contains("10.78.0.2 (office); 10.78.0.3 (client)") &&
                               Contains("skein0 (10.78.0.1)") && Contains("--host"));
  CommandRun misled({"launch", "--host", "10.78.0.4", profile});
  CHECK(misled.wait() == 78);
  CHECK_THAT(misled.output(), Contains("did you mean '10.78.0.2'?"));
}
