// What the commands say and return where something is not as it should be.
#include <sys/resource.h>
#include <unistd.h>

#include <catch2/catch.hpp>
#include <csignal>
#include <fstream>
#include <nlohmann/json.hpp>
#include <regex>

#include "errand.hpp"
#include "skein/detail/type_support.hpp"
#include "skein/entity.hpp"
#include "skein/head.hpp"
#include "skein/introspection.idl.hpp"
#include "skein/selection.hpp"
#include "test/tools/command_run.hpp"
#include "test/tools/installed.hpp"
#include "test/tools/network_space.hpp"
#include "worker.idl.hpp"

using namespace skein;
using namespace skein::test;
using Catch::Contains;

namespace {

const std::string kOffice = "<peer name='office' component='office.xml'/>";
const std::string kClient = "<peer name='client' component='client.xml' role='mission'/>";

class Desk final : public crew::Desk {
 public:
  std::string ask(const std::string& text) override { return text; }
};

}  // namespace

TEST_CASE("a command that is none is named, with the nearest") {
  CommandRun run({"lanuch", "x.xml"});
  CHECK(run.wait() == 64);
  CHECK_THAT(run.output(), Contains("there is no command 'lanuch' (did you mean 'launch'?)"));
  CommandRun nested({"bench", "latncy"});
  CHECK(nested.wait() == 64);
  CHECK_THAT(nested.output(),
             Contains("there is no command 'bench latncy' (did you mean 'latency'?)"));
}

TEST_CASE("an option that is none is named, with the nearest and with where to look") {
  CommandRun run({"services", "--domian", "3"});
  CHECK(run.wait() == 64);
  CHECK_THAT(run.output(),
             Contains("--domian (did you mean '--domain'?) 3; see `skein services --help`"));
}

TEST_CASE("who types another tool's command is told Skein's") {
  CommandRun run({"service", "list"});
  CHECK(run.wait() == 64);
  CHECK_THAT(run.output(), Contains("there is no command 'service'; in Skein: skein services"));
}

TEST_CASE("a process that a mission has not is told with those that it has") {
  const Errand errand;
  CommandRun run({"peer", errand.profile("", kOffice + kClient), "offcie"});
  CHECK(run.wait() == 78);
  CHECK_THAT(run.output(), Contains("mission 'errand' has no process 'offcie' (did you mean "
                                    "'office'?); it has office, client"));
}

TEST_CASE("output that cannot be written is no success") {
  const Errand errand;
  const std::string profile = errand.profile("", kOffice + kClient);
  for (const std::vector<std::string>& words : {std::vector<std::string>{"check", profile},
                                                {"launch", "--dry-run", profile},
                                                {"--help"},
                                                {"services", "--wait", "0.1"}}) {
    CAPTURE(words.front());
    CommandRun run(words, {.output = "/dev/full"});
    CHECK(run.wait() == 74);
    // The reason is known only of what fits into stdio's buffer, which the help does not.
    const std::string reason = words.front() == "--help" ? "" : "No space left on device";
    CHECK_THAT(run.output(), Contains("the output could not be written: " + reason));
  }
}

TEST_CASE("commands that watch end in order when they are interrupted") {
  const std::string command = GENERATE("calls", "decisions", "graph", "peers", "services", "top");
  const int signal = GENERATE(SIGINT, SIGTERM);
  CAPTURE(command, signal);
  const bool waits = command == "graph" || command == "peers" || command == "services";
  CommandRun run({command, waits ? "--wait" : command == "top" ? "--every" : "--for", "600"});
  const std::string status = "/proc/" + std::to_string(run.pid()) + "/status";
  REQUIRE(eventually([&] {  // until it blocks the signals, they would end it as they do any program
    std::ifstream file(status);
    for (std::string line; std::getline(file, line);) {
      if (line.starts_with("SigBlk:")) return std::stoull(line.substr(7), nullptr, 16) != 0;
    }
    return false;
  }));
  run.signal(signal);
  CHECK(run.wait() == 0);
  if (command == "services") CHECK_THAT(run.output(), Contains("0 services in domain 0"));
}

TEST_CASE("what a peer says of itself cannot drive a terminal, nor fill it") {
  if (!installed("cyclonedds")) return;
  Entity rogue({.name = "rogue", .vendor = dds::load_vendor("cyclonedds"), .domain = 49});
  ServiceOptions options;
  options.attributes = {{"colour\x1b[2J", "red"}};
  CHECK_THROWS_WITH(rogue.provide<crew::Desk>(std::make_shared<Desk>(), options),
                    Contains("control characters"));
  options.attributes = {{"long", std::string(4096, 'x')}};
  rogue.provide<crew::Desk>(std::make_shared<Desk>(), options);
  std::string output;
  REQUIRE(eventually([&] {
    CommandRun run({"services", "--domain", "49"});
    output = run.wait() == 0 ? run.output() : "";
    return output.find("1 service in domain 49") != std::string::npos;
  }));
  CHECK_THAT(output, Contains("xxx... (4096 bytes)"));
  CHECK(output.size() < 4096);
}

TEST_CASE("what is printed as JSON can be read by programs") {
  if (!installed("cyclonedds")) return;
  Entity rogue({.name = "rogue", .vendor = dds::load_vendor("cyclonedds"), .domain = 53});
  ServiceOptions options;
  options.attributes = {{"colour", "gr\xc3\xbcn"}};
  rogue.provide<crew::Desk>(std::make_shared<Desk>(), options);
  nlohmann::json services;
  REQUIRE(eventually([&] {
    CommandRun run({"services", "--domain", "53", "--json"});
    services = run.wait() == 0 ? nlohmann::json::parse(run.output()) : nlohmann::json();
    return services.size() == 1;
  }));
  CHECK(services[0]["service"] == "crew/Desk");
  CHECK(services[0]["entity"] == "rogue");
  CHECK(services[0]["pid"] == getpid());
  CHECK(services[0]["attributes"]["colour"] == "gr\xc3\xbcn");
}

TEST_CASE("decisions from a log cannot drive a terminal either") {
  introspection::Decision record;
  record.entity = "uav\x1b[2J";
  record.strategy = "declared";
  record.execution = "one";
  record.failure = "no\nanswer";
  const auto file = std::filesystem::temp_directory_path() /
                    ("skein-decisions-" + std::to_string(getpid()) + ".jsonl");
  std::ofstream(file) << idl::to_json(record) << '\n';
  CommandRun run({"decisions", "--log", file});
  CHECK(run.wait() == 0);
  CommandRun as_json({"decisions", "--log", file, "--json"});
  CHECK(as_json.wait() == 0);
  CHECK(idl::from_json<introspection::Decision>(as_json.output()) == record);
  std::filesystem::remove(file);
  CHECK_THAT(run.output(), Contains("of uav\\x1b[2J") && Contains("no\\x0aanswer"));
}

TEST_CASE("the mission's own text reaches the terminal without control characters") {
  if (!installed("fastdds")) return;
  const Errand errand;
  CommandRun run({"launch", errand.profile("", kOffice + kClient)});
  CHECK(run.wait() == 0);
  CHECK_THAT(run.output(), Contains("the desk says: yes, dear \\x1b[31mclient"));
}

TEST_CASE("peers of one component fly together, and a component reads its arguments") {
  if (!installed("fastdds")) return;
  const Errand errand;
  const std::string offices = "<peer name='office' component='office.xml' count='2'/>";
  const std::string client =
      "<peer name='client' component='client.xml' role='mission'>"
      "<argument value='--loud'/><argument value='two words'/></peer>";
  CommandRun run({"launch", errand.profile("", offices + client), "--verbose"});
  CHECK(run.wait() == 0);
  CHECK_THAT(run.output(), Contains("* office-1: started") && Contains("* office-2: started") &&
                               Contains("argument: --loud\nargument: two words\nthe desk says: "));
}

TEST_CASE("a missing dependency is told at once, and is the reason when the peer gives up") {
  if (!installed("fastdds")) return;
  const Errand errand;
  const std::string client =
      "<peer name='client' component='client.xml' role='mission' ready_timeout='10 s'/>";
  // The office's process is there, and provides nothing.
  const std::string office =
      "<peer name='office' component='office.xml' program='sleep'><argument value='1000'/></peer>";
  CommandRun run({"launch", errand.profile("", office + client)});
  CHECK(run.writes("waits for its dependency: no provider of 'crew/Desk'"));
  CHECK(run.wait() == 71);
  CHECK_THAT(run.output(), Contains("uav-1/client has waited in vain for its dependency"));
  CHECK_THAT(
      run.output(),
      Contains("client, which runs the mission, ended with exit code 71 (last "
               "it said: uav-1/client has waited in vain for its dependency: no provider of"));
}

TEST_CASE("too little address space is told at once with its limit") {
  const Errand errand;
  const CommandOptions options{.prepare = [] {
    const rlimit limit{200'000 << 10, 200'000 << 10};
    setrlimit(RLIMIT_AS, &limit);
  }};
  const std::vector<std::string> ways[] = {
      {"launch", errand.profile("", kOffice + kClient)},
      {"services"},
      {"peer", errand.profile("", kOffice), "office"},
  };
  for (const auto& words : ways) {
    CAPTURE(words.front());
    CommandRun run(words, options);
    CHECK(run.wait() == 71);
    CHECK_THAT(run.output(), Contains("limited to 195 MiB here (ulimit -v)"));
  }
}

TEST_CASE("a mission that ends by an exception has an exit code of its own, and its text is told") {
  if (!installed("fastdds")) return;
  const Errand errand;
  CommandRun run(
      {"launch",
       errand.profile("", "<peer name='clumsy' component='clumsy.xml' role='mission'/>")});
  CHECK(run.wait() == 76);
  CHECK_THAT(run.output(), Contains("ended by an exception: the client stumbled"));
}

TEST_CASE("an activity that throws what is no std::exception ends as one that throws") {
  if (!installed("fastdds")) return;
  const Errand errand;
  CommandRun run({"peer", errand.profile("", "<peer name='t' component='thrower.xml'/>"), "t"});
  CHECK(run.wait() == 76);
  CHECK_THAT(run.output(),
             Contains("t ended by an exception: it threw something that is no std::exception"));
}

TEST_CASE("a peer that cannot begin ends its mission at once, with its reason") {
  if (!installed("fastdds")) return;
  const Errand errand;
  const std::string herald = "<peer name='herald' component='herald.xml' role='mission'/>";
  const auto [name, reason] = GENERATE(table<std::string, std::string>({
      {"lost", "while making 'lost': there is no such way"},
      {"idle", "the factory of 'idle' returned no activity"},
  }));
  const std::string peer =
      "<peer name='l' restart='always' on_loss='degrade' component='" + name + ".xml'/>";
  CommandRun run({"launch", errand.profile("", peer + herald)});
  CHECK(run.wait() == 78);
  const std::string output = run.output();
  CHECK_THAT(output, Contains("skein: l ended with exit code 78 (last it said: ") &&
                         Contains(reason) && !Contains("restart number 1"));
  CHECK_THAT(output.substr(output.rfind("skein: l ended")), Contains(reason));
}

TEST_CASE("a mission goes on without a peer that may be missing, and says why it is") {
  if (!installed("fastdds")) return;
  const Errand errand;
  CommandRun run(
      {"launch", errand.profile("",
                                "<peer name='l' on_loss='continue' component='lost.xml'/>"
                                "<peer name='herald' component='herald.xml' role='mission'/>")});
  REQUIRE(run.writes("* l: ended with exit code 78 (last it said: "));
  REQUIRE(run.writes("hear, hear"));
  run.signal(SIGINT);
  CHECK(run.wait() == 128 + SIGINT);
  CHECK_THAT(run.output(), Contains("there is no such way"));
}

TEST_CASE("a component that could not be made is named, with its place in the profile") {
  if (!installed("fastdds")) return;
  const Errand errand;
  const bool csp = GENERATE(false, true);
  const auto [how, text, code] = GENERATE(table<std::string, std::string, int>({
      {"nothing", "the factory of 'NAME' returned no servant", 78},
      {"an int", "while making 'NAME': it threw something that is no std::exception", 71},
      {"an error", "while making 'NAME': no gauge at /dev/gauge", 71},
  }));
  const std::string profile =
      csp ? errand.profile("",
                           "<peer name='boss' component='boss.xml'><csp name='c' "
                           "component='bad_clerk.xml' process='own'/></peer>")
          : errand.profile("", "<peer name='b' component='bad.xml'/>");
  errand.write("boss.xml",
               "<component name='office'><interfaces><implements>IDL:crew/Desk</implements>"
               "</interfaces><subcomponents><subcomponent>IDL:crew/Desk</subcomponent>"
               "</subcomponents></component>");
  CAPTURE(csp, how);
  CommandRun run({"peer", profile, csp ? "boss/c" : "b", "--", how});
  CHECK(run.wait() == code);
  const std::string wanted =
      std::regex_replace(text, std::regex("NAME"), csp ? "bad_clerk" : "bad");
  CHECK_THAT(run.output(), Contains("errand.xml:1:") && Contains(": " + wanted));
}

TEST_CASE("a peer whose component is being made, and never is, obeys the signals that end it") {
  if (!installed("fastdds")) return;
  const Errand errand;
  const int signal = GENERATE(SIGINT, SIGTERM);
  CommandRun run(
      {"peer", errand.profile("", "<peer name='b' component='bad.xml'/>"), "b", "--", "never"});
  REQUIRE(run.writes("is being made"));
  run.signal(signal);
  CHECK(run.wait() == 128 + signal);
  CHECK_THAT(run.output(), Contains("told to end while 'bad' is made"));
}

TEST_CASE("of a process that dies or hangs the launcher says what it did") {
  if (!installed("fastdds")) return;
  const Errand errand;
  const auto [how, told] = GENERATE(table<std::string, std::string>({
      {"a crash",
       "b ended by signal 6 (Aborted) (last it said: dies of signal 6 while it makes 'bad')"},
      {"never", "b did not become ready within 2.00 s (last it said: makes 'bad')"},
  }));
  CommandRun run({"launch", errand.profile("",
                                           "<peer name='b' component='bad.xml' ready_timeout="
                                           "'2 s'><argument value='" +
                                               how + "'/></peer>")});
  CHECK(run.wait() == 71);
  CHECK_THAT(run.output(), Contains(told));
}

TEST_CASE("of a ready process that dies the launcher says in which thread, and its stack") {
  if (!installed("fastdds")) return;
  const Errand errand;
  CommandRun run({"launch", errand.profile("", kOffice)});
  REQUIRE(run.writes("all 1 processes are ready"));
  CommandRun call({"call", "Desk", "ask", "\"die\"", "--domain", "48"});
  CHECK(run.wait() == 70);
  CHECK_THAT(run.output(),
             Contains("office | skein: dies of signal 6 in its thread 'office'\n") &&
                 Contains("(last it said: dies of signal 6 in its thread 'office')") &&
                 Contains("(abort+0x") && Contains("skein::rpc::CallExecution::"));
}

TEST_CASE("a parameter that is set, and that no code has asked for, is told at the end") {
  if (!installed("fastdds")) return;
  const Errand errand;
  CommandRun run({"peer",
                  errand.profile("",
                                 "<peer name='h' component='herald.xml'>"
                                 "<parameter name='Time limit' value='1 s'/></peer>"),
                  "h"});
  REQUIRE(run.writes("hear, hear"));
  run.signal(SIGTERM);
  CHECK(run.wait() == 0);
  CHECK_THAT(run.output(),
             Contains("uav-1/h: 'herald' never asked for its parameter 'Time limit' ("));
}

TEST_CASE("two peers of one name each warn of the other, and the doctor of both") {
  if (!installed("fastdds")) return;
  const Errand errand;
  const std::string profile = errand.profile("", kOffice);
  CommandRun first({"peer", profile, "office"});
  CommandRun second({"peer", profile, "office"});
  CHECK(
      first.writes("process " + std::to_string(second.pid()) + " runs an entity of the same name"));
  CHECK(
      second.writes("process " + std::to_string(first.pid()) + " runs an entity of the same name"));
  CommandRun doctor({"doctor", profile});
  CHECK(doctor.wait() >= 1);
  CHECK_THAT(doctor.output(), Contains("2 peers are called uav-1/office"));
}

TEST_CASE("a launcher says on which domain it flies, and that commands look on another") {
  const Errand errand;
  const std::string profile =
      errand.profile("", "<peer name='p' component='herald.xml' program='true'/>");
  const auto told = [&](const std::string& named) {
    CommandRun run({"launch", profile},
                   {.prepare = [&] { setenv("SKEIN_DOMAIN", named.c_str(), 1); }});
    CHECK(run.wait() == 0);
    return run.output();
  };
  CHECK_THAT(told("48"), Contains("* mission: flies on domain 48\n"));
  CHECK_THAT(told("7"), Contains("flies on domain 48; commands that look need --domain 48, or "
                                 "they look on domain 7, as SKEIN_DOMAIN says"));
}

TEST_CASE("a second launcher of a mission is refused and names the first") {
  if (!installed("fastdds")) return;
  const Errand errand;
  const std::string profile = errand.profile("", kOffice);
  CommandRun first({"launch", profile});
  REQUIRE(first.writes("all 1 processes are ready"));
  CommandRun second({"launch", profile});
  CHECK(second.wait() == 78);
  CHECK_THAT(second.output(), Contains("is flown here already, on domain 48, by process " +
                                       std::to_string(first.pid())));
  first.signal(SIGTERM);
  CHECK(first.wait() == 128 + SIGTERM);
  CHECK_THAT(first.output(), Contains("interrupted by signal 15 (Terminated), which process " +
                                      std::to_string(getpid()) + " sent"));
  CommandRun third({"launch", profile});
  CHECK(third.writes("all 1 processes are ready"));
}

TEST_CASE("a launcher says that another mission flies on its domain, and flies all the same") {
  const Errand errand;
  const std::string sleeper =
      "<peer name='p' component='herald.xml' program='sleep'><argument value='1000'/></peer>";
  const std::string other =
      errand.write("other.xml", "<mission name='other' domain='48' dictionary='" +
                                    project_file("mission_profiles/dictionary.xml") + "'>" +
                                    sleeper + "</mission>");
  CommandRun first({"launch", errand.profile("", sleeper)});
  REQUIRE(first.writes("all 1 processes are ready"));
  CommandRun second({"launch", other});
  CHECK(second.writes("another mission flies on domain 48 (process " + std::to_string(first.pid()) +
                      ")"));
  CHECK(second.writes("all 1 processes are ready"));
  CHECK_THAT(first.output(), !Contains("another mission"));
}

TEST_CASE("a peer that provides nothing does its own until it is told to end") {
  if (!installed("fastdds")) return;
  const Errand errand;
  const std::string role = GENERATE("", " role='mission'");
  const std::string profile =
      errand.profile("", "<peer name='h' component='herald.xml'" + role + "/>");
  CommandRun check({"check", profile});
  CHECK(check.wait() == 0);
  CommandRun run({"launch", profile, "--verbose"});
  REQUIRE(run.writes("hear, hear\nh"));
  run.signal(SIGINT);
  CHECK(run.wait() == 128 + SIGINT);
  CHECK_THAT(run.output(),
             Contains("the herald goes home") && Contains("h: ended with exit code 0"));
}

TEST_CASE("a rule for a topic that the peer never used is told at its end") {
  if (!installed("fastdds")) return;
  const Errand errand;
  CommandRun run({"peer",
                  errand.profile("",
                                 "<peer name='h' component='herald.xml'>"
                                 "<topic name='heralt' reliability='reliable'/></peer>"),
                  "h"});
  REQUIRE(run.writes("hear, hear"));
  run.signal(SIGINT);
  CHECK(run.wait() == 0);
  CHECK_THAT(run.output(), Contains("<topic name=\"heralt\">, and it used no such topic (did you "
                                    "mean 'herald'?)"));
}

TEST_CASE(
    "who ends by himself is told, though nothing failed, and those who were told to are not") {
  const Errand errand;
  CommandRun run(
      {"launch", errand.profile("",
                                "<peer name='brief' component='herald.xml' program='true'/>"
                                "<peer name='long' component='herald.xml' program='sleep'>"
                                "<argument value='1000'/></peer>")});
  CHECK(run.writes("* brief: ended with exit code 0\n"));
  REQUIRE(run.writes(" processes are ready"));
  run.signal(SIGINT);
  CHECK(run.wait() == 128 + SIGINT);
  CHECK_THAT(run.output(), !Contains("long: "));
}

TEST_CASE("of a mission that is launched in part, only that part's plugins must be there") {
  const Errand errand;
  const std::string profile = errand.profile(
      "", kClient + kOffice + "<peer name='other' plugin='none' component='office.xml'/>");
  CommandRun part({"launch", "--only", "client", "--only", "office", profile});
  CHECK(part.wait() == 0);
  CommandRun whole({"launch", profile});
  CHECK(whole.wait() == 78);
  CHECK_THAT(whole.output(), Contains("the plugin 'none': no libnone.so in"));
}

TEST_CASE("plugins are not looked for where the profile says that their process finds others") {
  const Errand errand;
  const std::string profile =
      errand.profile("",
                     "<peer name='office' plugin='none' component='office.xml'><environment "
                     "name='SKEIN_MODULE_PATH' value='/elsewhere'/></peer>");
  CommandRun check({"check", profile});
  CHECK(check.wait() == 0);
  CommandRun launch({"launch", profile});
  CHECK(launch.wait() == 71);
  CHECK_THAT(launch.output(), Contains("no libnone.so in /elsewhere"));
}

TEST_CASE("a host that cannot be found by its name is a warning where multicast finds it") {
  const Errand errand;
  CommandRun run({"check", errand.profile("interface='lo' multicast='true'",
                                          "<peer name='office' component='office.xml' "
                                          "host='nowhere.invalid'/>")});
  CHECK(run.wait() == 0);
  CHECK_THAT(run.output(), Contains("warning: the host 'nowhere.invalid' of 'office' has no") &&
                               Contains("complete"));
}

TEST_CASE("a profile without a peer on this host is complete, with a warning") {
  const Errand errand;
  CommandRun run({"check", "--host", "elsewhere",
                  errand.profile("interface='eth0'",
                                 "<peer name='office' component='office.xml' host='192.0.2.1'/>"
                                 "<peer name='client' component='client.xml' host='192.0.2.2' "
                                 "role='mission'/>")});
  CHECK(run.wait() == 0);
  CHECK_THAT(run.output(), Contains("warning: no peer of mission 'errand' is of this host") &&
                               Contains("its hosts are 192.0.2.1 (office); 192.0.2.2 (client)"));
}

TEST_CASE("a network interface that is not ready yet ends nobody for good") {
  const NetworkSpace host;
  host.run("ip link add veth0 type veth peer name veth1 && ip link set veth0 up");
  const Errand errand;
  struct Case {
    const char* interface;
    int code;
    const char* text;
  };
  const auto [interface, code, text] = GENERATE(values<Case>({
      {"veth0", 71, "the interface veth0 has no IPv4 address"},
      {"veth7", 71, "no interface 'veth7'"},
      {"wlan0", 71, "no interface 'wlan0'"},
      {"10.0.0.7", 71, "no interface '10.0.0.7'"},
      {"l0", 78, "did you mean 'lo'?"},
  }));
  CAPTURE(interface);
  const std::string profile =
      errand.profile("interface='" + std::string(interface) + "'",
                     "<peer name='office' component='office.xml' vendor='cyclonedds'/>");
  CommandRun peer({"peer", profile, "office"}, {.network = host.descriptor()});
  CommandRun launch({"launch", profile}, {.network = host.descriptor()});
  CHECK(peer.wait() == code);
  CHECK_THAT(peer.output(), Contains(text));
  CHECK(launch.wait() == code);
}
