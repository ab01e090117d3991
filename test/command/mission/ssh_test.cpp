// `skein launch --ssh`: a mission over two hosts by one command. The other host is a network
// namespace in which OpenSSH's server runs.
#include <catch2/catch.hpp>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstdlib>

#include "errand.hpp"
#include "test/tools/command_run.hpp"
#include "test/tools/installed.hpp"
#include "test/tools/places.hpp"
#include "test/tools/ssh_host.hpp"
#include "two_hosts.hpp"

using namespace skein::test;
using namespace std::chrono_literals;
using Catch::Contains;
using Clock = std::chrono::steady_clock;

namespace {

const std::string kHere = "10.78.0.1";
const std::string kThere = "10.78.0.2";

std::string peer(const std::string& component, const std::string& host,
                 const std::string& more = "") {
  return "<peer name='" + component + "' component='" + component +
         ".xml' vendor='cyclonedds' host='" + host + "' " + more + "/>";
}

const std::string kBranch =
    "<peer name='branch' component='office.xml' vendor='cyclonedds' host='10.78.0.1'/>";

/// `skein launch --ssh` on alpha, which reaches beta.
class Flight {
 public:
  Flight(const TwoHosts& hosts, const SshHost& there, const std::vector<std::string>& words)
      : path_(there.client_folder().string() + ":" + std::getenv("PATH")),
        run_(with_command(words), {.network = hosts.alpha.descriptor(),
                                   .prepare = [this] { setenv("PATH", path_.c_str(), 1); }}) {}

  CommandRun& run() { return run_; }

 private:
  static std::vector<std::string> with_command(std::vector<std::string> words) {
    words.insert(words.begin(), {"launch", "--ssh"});
    return words;
  }

  std::string path_;
  CommandRun run_;
};

bool is_deserted(const SshHost& host) {
  return eventually([&] { return host.programs().empty(); }, 60s);
}

/// How long it takes until nothing of a mission is left on the other host; printed.
double seconds_until_deserted(const SshHost& host, const char* after) {
  const auto begin = Clock::now();
  CHECK(is_deserted(host));
  const double seconds = std::chrono::duration<double>(Clock::now() - begin).count();
  std::printf("nothing is left on the other host %.2f s after %s\n", seconds, after);
  return seconds;
}

constexpr double kLongestLife = 8;  // 5 s are meant; machines are loaded

}  // namespace

TEST_CASE("one command flies a mission over two hosts, wherever its mission's peer is") {
  if (!installed("cyclonedds")) return;
  const TwoHosts hosts;
  const Errand errand;
  const SshHost there(hosts.beta, kThere);
  const bool mission_there = GENERATE(false, true);
  CAPTURE(mission_there);
  const std::string profile = errand.profile(
      "interface='skein0'", peer("office", mission_there ? kHere : kThere) +
                                peer("client", mission_there ? kThere : kHere, "role='mission'"));
  Flight flight(hosts, there, {profile});
  const int code = flight.run().wait();
  INFO(flight.run().output());
  CHECK(code == 0);
  CHECK_THAT(flight.run().output(), Contains("the desk says: yes, dear"));
  CHECK(there.programs().empty());
}

TEST_CASE("the exit code of a mission on the other host is the mission's, and its text is told") {
  if (!installed("cyclonedds")) return;
  const TwoHosts hosts;
  const Errand errand;
  const SshHost there(hosts.beta, kThere);
  Flight flight(hosts, there,
                {errand.profile("interface='skein0'",
                                peer("office", kHere) + peer("clumsy", kThere, "role='mission'"))});
  CHECK(flight.run().wait() == 76);
  CHECK_THAT(flight.run().output(), Contains("ended by an exception: the client stumbled"));
}

TEST_CASE("a launcher that is interrupted or killed leaves nothing on the other host") {
  if (!installed("cyclonedds")) return;
  const TwoHosts hosts;
  const Errand errand;
  const SshHost there(hosts.beta, kThere);
  const int signal = GENERATE(SIGINT, SIGKILL);
  CAPTURE(signal);
  Flight flight(
      hosts, there,
      {errand.profile("interface='skein0'", peer("office", kHere) +
                                                "<peer name='branch' component='office.xml' "
                                                "vendor='cyclonedds' host='10.78.0.2'/>")});
  REQUIRE(flight.run().writes("all 2 processes are ready"));
  CHECK(there.programs().size() >= 2);
  flight.run().signal(signal);
  CHECK(flight.run().wait() == 128 + signal);
  if (signal == SIGINT) CHECK(there.programs().empty());
  CHECK(seconds_until_deserted(there, "the launcher's end") < kLongestLife);
}

TEST_CASE("when the link is cut, both sides end by themselves, and the launcher says why") {
  if (!installed("cyclonedds")) return;
  const TwoHosts hosts;
  const Errand errand;
  const SshHost there(hosts.beta, kThere);
  // Down; or up, and packets to the other host are lost, or those of both. Where the other host is
  // still heard, either its last words come first, or ssh misses an answer.
  const std::string lost = "the connection to 10.78.0.2 is lost";
  const std::string loses =
      "ip neigh replace 10.78.0.2 lladdr 02:00:00:00:00:99 dev skein0 nud permanent";
  const auto [here, beyond, why] = GENERATE_COPY(table<std::string, std::string, std::string>(
      {{"ip link set skein0 down", "true", lost},
       {loses, "true", "it hears nothing more of the launcher that attends it"},
       {loses, "ip neigh replace 10.78.0.1 lladdr 02:00:00:00:00:98 dev skein0 nud permanent",
        lost}}));
  CAPTURE(here, beyond);
  Flight flight(hosts, there,
                {errand.profile("interface='skein0'", peer("office", kThere) + kBranch)});
  REQUIRE(flight.run().writes("all 2 processes are ready"));
  hosts.beta.run(beyond);
  hosts.alpha.run(here);
  CHECK(seconds_until_deserted(there, here.c_str()) < kLongestLife);
  CHECK(flight.run().wait() == 70);
  CHECK_THAT(flight.run().output(), Contains(why) || Contains(lost));
}

TEST_CASE("peers of the other host that fail are told by name, and end the mission") {
  if (!installed("cyclonedds")) return;
  const TwoHosts hosts;
  const Errand errand;
  const SshHost there(hosts.beta, kThere);
  // Nobody serves the page: the office is a program that does not.
  errand.write("page.xml",
               "<component name='page'><dependencies><depends>IDL:crew/Desk</depends>"
               "</dependencies></component>");
  Flight flight(
      hosts, there,
      {errand.profile("interface='skein0'",
                      "<peer name='office' component='office.xml' program='sleep' host='10.78.0.1'>"
                      "<argument value='1000'/></peer>" +
                          peer("page", kThere, "ready_timeout='5 s'"))});
  CHECK(flight.run().wait() == 71);
  CHECK_THAT(flight.run().output(),
             Contains("10.78.0.2 | * page: ended with exit code 71") &&
                 Contains("waits for its dependency: no provider of 'crew/Desk'"));
}

TEST_CASE("what keeps the other host from flying is said, with what to do") {
  const TwoHosts hosts;
  const Errand errand;
  const std::string profile =
      errand.profile("interface='skein0'", peer("office", kThere) + kBranch);
  const auto folder_of = [](const std::string& file) {
    return std::filesystem::path(file).parent_path().string();
  };
  const std::string of_nothing = "mount -t tmpfs tmpfs ";
  struct Lack {
    std::string prepare;
    std::string part;
    int code;
  };
  const std::vector<Lack> lacks{
      {of_nothing + folder_of(profile), "errand.xml", 78},
      {of_nothing + folder_of(built_program("skein")), "there is no Skein on 10.78.0.2", 71},
      {"(cat " + profile + " && echo) > /run/other.xml && mount --bind /run/other.xml " + profile,
       "copy the profile with all that it names", 78}};
  const auto& [prepare, part, code] = lacks[GENERATE(0, 1, 2)];
  CAPTURE(prepare);
  const SshHost there(hosts.beta, kThere, prepare);
  Flight flight(hosts, there, {profile});
  CHECK(flight.run().wait() == code);
  CHECK_THAT(flight.run().output(), Contains(part));
  CHECK(there.programs().empty());
}

TEST_CASE("a host that ssh does not reach is a failed start, in ssh's own words") {
  const TwoHosts hosts;
  const Errand errand;
  const SshHost there(hosts.beta, kThere);
  const auto [host, part] = GENERATE(table<std::string, std::string>({
      {"10.78.0.9", "ssh: connect to host 10.78.0.9 port 22"},
      {"nowhere.invalid", "Could not resolve hostname nowhere.invalid"},
  }));
  CAPTURE(host);
  Flight flight(
      hosts, there,
      {errand.profile("interface='skein0' multicast='true'", kBranch + peer("office", host))});
  CHECK(flight.run().wait() == 71);
  CHECK_THAT(flight.run().output(), Contains(part));
  CHECK_THAT(flight.run().output(),
             Contains("skein: " + host + " ended with exit code 71 (last it said: ssh: "));
}

TEST_CASE("a dry run names the other hosts, and starts nothing") {
  const Errand errand;
  CommandRun run(
      {"launch", "--ssh", "--dry-run", "--host", kHere,
       errand.profile("interface='skein0'",
                      peer("office", kThere) + peer("client", kHere, "role='mission'"))});
  CHECK(run.wait() == 0);
  CHECK_THAT(run.output(),
             Contains("attend") && Contains(" 10.78.0.2\n") && !Contains("not started here"));
}
