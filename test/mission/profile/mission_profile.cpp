#include "mission/profile/mission_profile.hpp"

#include <catch2/catch.hpp>

#include "profile_folder.hpp"
#include "test/tools/places.hpp"

using namespace skein::profile;
using namespace std::chrono_literals;
using skein::test::project_file;

TEST_CASE("The mission that is shipped reads as it is described, without a finding") {
  const std::filesystem::path file =
      project_file("mission_profiles/route_planning/route_planning.xml");
  CHECK(to_text(check_file(file)) == "");
  const auto mission = read_checked_profile(file);
  const auto* navigator = mission.find_peer("navigator");
  REQUIRE(navigator != nullptr);
  CHECK(navigator->vendor == "cyclonedds");
  CHECK(navigator->system == "uav-1");
  CHECK(navigator->component->name == "Navigator");
  REQUIRE(navigator->csps.size() == 3);
  REQUIRE(navigator->find_csp("AStar") != nullptr);
  CHECK(navigator->find_csp("AStar")->process == CspProcess::InOwner);
  REQUIRE(navigator->find_csp("RRTstar") != nullptr);
  CHECK(navigator->find_csp("RRTstar")->process == CspProcess::Own);
  CHECK(navigator->find_csp("RRTstar")->vendor == "cyclonedds");
  const auto* station = mission.find_peer("ground_station");
  REQUIRE(station != nullptr);
  CHECK(station->runs_mission);
  CHECK(station->plugin == "skein_ground_station");
  CHECK(mission.find_peer("flight_controller")->vendor == "fastdds");
}

TEST_CASE(
    "A peer without settings speaks on this host alone, must not be lost, and is not restarted") {
  ProfileFolder folder;
  const auto mission =
      read_mission_profile(folder.mission(R"(<peer name="f" component="f.xml"/>)"));
  const auto& peer = mission.peers.at(0);
  CHECK(peer.interface.empty());
  CHECK(peer.host.empty());
  CHECK(peer.rules.on_loss == LossPolicy::Abort);
  CHECK(peer.rules.progress_timeout == 0ns);
  CHECK_FALSE(peer.runs_mission);
  CHECK(peer.rules.restart.policy == RestartPolicy::Never);
  CHECK(mission.domain == 0);
}

TEST_CASE("Whom a peer asks for others is the mission's to say, unless it says otherwise") {
  ProfileFolder folder;
  const auto file = folder.mission("");
  folder.write("m.xml", R"(<mission name="m" interface="eth0" peers=" 10.0.0.1,far-1.example  near "
       multicast="true">
<peer name="a" component="f.xml"/><peer name="b" component="f.xml" peers="10.0.0.3"
  multicast="false"/><peer name="c" component="f.xml" peers=""/></mission>)");
  const auto mission = read_mission_profile(file);
  using Hosts = std::vector<std::string>;
  CHECK(mission.peers.at(0).peers == Hosts{"10.0.0.1", "far-1.example", "near"});
  CHECK(mission.peers.at(0).multicast);
  CHECK(mission.peers.at(1).peers == Hosts{"10.0.0.3"});
  CHECK_FALSE(mission.peers.at(1).multicast);
  CHECK(mission.peers.at(2).peers.empty());
}

TEST_CASE("What is no list of hosts is refused, and so are hosts that a peer could not reach") {
  ProfileFolder folder;
  CHECK(
      folder.check(R"(<peer name="f" component="f.xml" interface="eth0" peers="10.0.0.1;b"/>)") ==
      "m.xml:2:51: error: peers is \"10.0.0.1;b\", no list of hosts; write names or addresses, as "
      "in \"10.0.0.2 10.0.0.3\", at most 64\n");
  CHECK(folder.check(R"(<peer name="f" component="f.xml" multicast="yes"/>)") ==
        "m.xml:2:34: error: multicast is \"yes\"; write true or false\n");
  const std::string unreachable =
      "m.xml:2:1: error: \"f\" is to look for peers of other hosts, but speaks on 127.0.0.1 alone; "
      "name its network interface: interface=\"...\"\n";
  CHECK(folder.check(R"(<peer name="f" component="f.xml" peers="10.0.0.1"/>)") == unreachable);
  CHECK(folder.check(R"(<peer name="f" component="f.xml" multicast="true"/>)") == unreachable);
}

TEST_CASE("Restart rules are read with their units") {
  ProfileFolder folder;
  const auto mission = read_mission_profile(folder.mission(
      R"(<peer name="f" component="f.xml" restart="always" restart_delay="50 ms"
           max_restart_delay="2 s" max_restarts="3" restart_window="1 min" ready_timeout="10 s"
           stop_timeout="500ms"/>)"));
  const auto& rules = mission.peers.at(0).rules;
  CHECK(rules.restart.policy == RestartPolicy::Always);
  CHECK(rules.restart.delay == 50ms);
  CHECK(rules.restart.max_delay == 2s);
  CHECK(rules.restart.max_restarts == 3);
  CHECK(rules.restart.window == 60s);
  CHECK(rules.ready_timeout == 10s);
  CHECK(rules.stop_timeout == 500ms);
}

TEST_CASE("How threads run is read for peers and CSPs") {
  ProfileFolder folder;
  const auto mission = read_mission_profile(folder.mission(
      R"(<peer name="n" component="n.xml" threads="4" scheduling="fifo" priority="20" cpus="0, 2-3"
           spin="50 us" lock_memory="true">
           <csp component="p.xml" nice="5"/>
         </peer>)"));
  const auto& threads = mission.peers.at(0).threads;
  CHECK(threads.count == 4);
  CHECK(threads.lock_memory);
  CHECK(threads.settings.scheduling == skein::ThreadSettings::Scheduling::Fifo);
  CHECK(threads.settings.priority == 20);
  CHECK(threads.settings.cpus == std::vector<unsigned>{0, 2, 3});
  CHECK(threads.settings.spin == 50us);
  CHECK(mission.peers.at(0).csps.at(0).threads.settings.nice == 5);
  CHECK(mission.peers.at(0).csps.at(0).threads.count == 0);
}

TEST_CASE("Threads that cannot run as the profile says are found, with their place") {
  ProfileFolder folder;
  const auto [attributes, finding] = GENERATE(table<std::string, std::string>({
      {R"(scheduling="fifa" priority="1")", "\"fifa\" is no scheduling; did you mean 'fifo'?"},
      {R"(scheduling="fifo")", "this scheduling needs a priority"},
      {R"(scheduling="fifo" priority="100")", "priority is \"100\"; write a number from 1 to 99"},
      {R"(priority="5")", "priority is for fifo and round-robin scheduling"},
      {R"(scheduling="round-robin" priority="1" nice="2")", "nice is for normal scheduling"},
      {R"(nice="20")", "nice is \"20\"; write a number from -20 to 19"},
      {R"(cpus="0,")", "\"0,\" is no list of CPUs"},
      {R"(cpus="3-1")", "\"3-1\" is no list of CPUs"},
      {R"(cpus="0-99999999999")", "is no list of CPUs"},
      {R"(threads="0")", "threads is \"0\"; write a number from 1 to 256"},
      {R"(spin="2 s")", "more than 100 ms"},
      {R"(spin="soon")", "\"soon\" is no length of time"},
      {R"(lock_memory="yes")", "lock_memory is \"yes\"; write true or false"},
  }));
  const std::string peer = R"(<peer name="f" component="f.xml" )" + attributes + "/>";
  CHECK_THAT(folder.check(peer), Catch::Contains("m.xml:2:") && Catch::Contains(finding));
}

TEST_CASE("A CSP without a process cannot lock memory, and none has more than one thread") {
  ProfileFolder folder;
  const auto text = folder.check(R"(<peer name="n" component="n.xml">
    <csp component="p.xml" lock_memory="true"/>
    <csp name="q" component="p.xml" threads="2"/></peer>)");
  CHECK_THAT(text, Catch::Contains("m.xml:3:28: error: lock_memory is for processes"));
  CHECK_THAT(text, Catch::Contains("m.xml:4:") && Catch::Contains("<csp> has no \"threads\""));
}

TEST_CASE("How a Head decides is read for peers; without a word it is as the Head itself has it") {
  ProfileFolder folder;
  const auto mission = read_mission_profile(folder.mission(
      R"(<peer name="n" component="n.xml" strategy="learned" history="h.json" decision_log="d.jsonl"
           exploration="0.25" max_stuck="7" quarantine_after="2" first_quarantine="300 ms"
           longest_quarantine="5 s"/>
         <peer name="f" component="f.xml"/>)"));
  const skein::HeadOptions& head = mission.peers.at(0).head;
  CHECK(head.strategy == "learned");
  CHECK(head.history == "h.json");
  CHECK(head.log == "d.jsonl");
  CHECK(head.exploration == 0.25);
  CHECK(head.max_stuck == 7);
  CHECK(head.breaker.faults == 2);
  CHECK(head.breaker.first_quarantine == 300ms);
  CHECK(head.breaker.longest_quarantine == 5s);
  const skein::HeadOptions& silent = mission.peers.at(1).head;
  const skein::HeadOptions standard;
  CHECK(silent.strategy == standard.strategy);
  CHECK(silent.history.empty());
  CHECK(silent.log.empty());
  CHECK(silent.exploration == standard.exploration);
  CHECK(silent.max_stuck == standard.max_stuck);
  CHECK(silent.breaker.faults == standard.breaker.faults);
  CHECK(silent.breaker.longest_quarantine == standard.breaker.longest_quarantine);
}

TEST_CASE("A Head that cannot decide as the profile says is found, with its place") {
  ProfileFolder folder;
  const auto [attributes, finding] = GENERATE(table<std::string, std::string>({
      {R"(strategy="lerned")",
       "warning: \"lerned\" is none of Skein's own selection strategies, and \"n\" has no plugin "
       "that "
       "could hold it; did you mean 'learned'?"},
      {R"(strategy="")", "strategy"},
      {R"(stratgy="learned")", R"(did you mean 'strategy'?)"},
      {R"(history="")", "history"},
      {R"(decision_log="")", "decision_log"},
      {R"(exploration="1.5")", "write a number from 0 to 1"},
      {R"(exploration="much")", "write a number from 0 to 1"},
      {R"(max_stuck="0")", "write a number from 1 to 1000"},
      {R"(quarantine_after="0")", "write a number from 1 to 1000"},
      {R"(first_quarantine="0 s")", "first_quarantine is zero"},
      {R"(first_quarantine="2 min")", "longest_quarantine is shorter than first_quarantine"},
      {R"(longest_quarantine="soon")", "\"soon\" is no length of time"},
  }));
  const std::string peer = R"(<peer name="n" component="n.xml" )" + attributes + "/>";
  CHECK_THAT(folder.check(peer), Catch::Contains("m.xml:2:") && Catch::Contains(finding));
}

TEST_CASE("A strategy that only a plugin may know is taken at its word") {
  ProfileFolder folder;
  const std::string peers = R"(<peer name="f" component="f.xml"/>
<peer name="n" component="n.xml" plugin="mine" strategy="steady"><csp component="p.xml"/></peer>)";
  CHECK(folder.check(peers) == "");
  CHECK(read_mission_profile(folder.mission(peers)).peers.at(1).head.strategy == "steady");
}

TEST_CASE("What a Head is told that has no CSPs to choose among is a warning") {
  ProfileFolder folder;
  CHECK(folder.check(R"(<peer name="f" component="f.xml" strategy="learned" max_stuck="3"/>)") ==
        "m.xml:2:34: warning: strategy has no effect, since the peer has no CSPs to choose among; "
        "remove it, or add a <csp>\n"
        "m.xml:2:53: warning: max_stuck has no effect, since the peer has no CSPs to choose among; "
        "remove it, or add a <csp>\n");
  CHECK(folder.check(R"(<group name="g" strategy="learned"><peer name="f" component="f.xml"/>
</group>)") == "");
}

TEST_CASE("A CSP has no Head") {
  ProfileFolder folder;
  CHECK_THAT(folder.check(R"(<peer name="n" component="n.xml">
    <csp component="p.xml" strategy="learned"/></peer>)"),
             Catch::Contains("m.xml:3:") && Catch::Contains("<csp> has no \"strategy\""));
}

TEST_CASE("What the mission says holds for every peer that does not say otherwise") {
  ProfileFolder folder;
  folder.write("m.xml", R"(<mission name="m" vendor="cyclonedds" system="uav" interface="lan0">
    <peer name="a" component="f.xml"/>
    <peer name="b" component="f.xml" vendor="fastdds" system="station"/>
  </mission>)");
  const auto mission = read_mission_profile(folder.path() / "m.xml");
  CHECK(mission.peers.at(0).vendor == "cyclonedds");
  CHECK(mission.peers.at(0).interface == "lan0");
  CHECK(mission.peers.at(1).vendor == "fastdds");
  CHECK(mission.peers.at(1).system == "station");
  CHECK(mission.peers.at(1).interface == "lan0");
}

TEST_CASE("Allowed sources are the mission's, or the peer's own") {
  ProfileFolder folder;
  folder.write("m.xml", R"(<mission name="m" allowed_sources="10.0.0.0/24  10.1.0.7">
    <peer name="plain" component="n.xml"/>
    <peer name="own" component="n.xml" allowed_sources="10.2.0.9"/>
  </mission>)");
  const auto mission = read_mission_profile(folder.path() / "m.xml");
  CHECK(mission.peers.at(0).allowed_sources == std::vector<std::string>{"10.0.0.0/24", "10.1.0.7"});
  CHECK(mission.peers.at(1).allowed_sources == std::vector<std::string>{"10.2.0.9"});
}

TEST_CASE("Allowed sources that are no addresses are found, with their place and the remedy") {
  ProfileFolder folder;
  const auto text = folder.check(R"(<peer name="n" component="n.xml" allowed_sources="10.0.0.300"/>
    <peer name="o" component="n.xml" allowed_sources=" "/>)");
  CHECK_THAT(text, Catch::Contains("m.xml:2:") && Catch::Contains("'10.0.0.300'") &&
                       Catch::Contains("10.0.0.0/24"));
  CHECK_THAT(text, Catch::Contains("m.xml:3:") && Catch::Contains("names none"));
}

TEST_CASE("Shared memory is the peer's word, and holds for its CSPs on the same vendor") {
  ProfileFolder folder;
  folder.write("m.xml", R"(<mission name="m">
    <peer name="plain" component="n.xml"/>
    <peer name="shared" component="n.xml" shared_memory="true">
      <csp component="p.xml" process="own"/>
      <csp name="other" component="p.xml" process="own" vendor="cyclonedds"/>
      <csp name="none" component="p.xml" process="own" shared_memory="false"/></peer>
  </mission>)");
  const auto mission = read_mission_profile(folder.path() / "m.xml");
  CHECK_FALSE(mission.peers.at(0).shared_memory);
  const auto& peer = mission.peers.at(1);
  CHECK(peer.shared_memory);
  CHECK(peer.csps.at(0).shared_memory);
  CHECK_FALSE(peer.csps.at(1).shared_memory);
  CHECK_FALSE(peer.csps.at(2).shared_memory);
}

TEST_CASE("Calls through shared memory are the peer's word, and its CSPs' whatever their vendor") {
  ProfileFolder folder;
  folder.write("m.xml", R"(<mission name="m">
    <peer name="plain" component="n.xml">
      <csp component="p.xml" process="own" shared_memory_calls="true"/></peer>
    <peer name="shared" component="n.xml" shared_memory_calls="true">
      <csp component="p.xml" process="own" vendor="cyclonedds"/>
      <csp name="none" component="p.xml" process="own" shared_memory_calls="false"/></peer>
  </mission>)");
  const auto mission = read_mission_profile(folder.path() / "m.xml");
  CHECK(mission.peers.at(0).shared_memory_calls == std::nullopt);
  CHECK(mission.peers.at(0).csps.at(0).shared_memory_calls == true);
  const auto& peer = mission.peers.at(1);
  CHECK(peer.shared_memory_calls == true);
  CHECK(peer.csps.at(0).shared_memory_calls == true);
  CHECK(peer.csps.at(1).shared_memory_calls == false);
}

TEST_CASE("Shared memory of a vendor that has none is found, with its place and the remedy") {
  ProfileFolder folder;
  const auto text =
      folder.check(R"(<peer name="n" component="n.xml" vendor="cyclonedds" shared_memory="true">
    <csp component="p.xml" vendor="loopback" shared_memory="true"/></peer>)");
  CHECK_THAT(text, Catch::Contains("m.xml:2:") &&
                       Catch::Contains("\"cyclonedds\" has no shared memory") &&
                       Catch::Contains("vendor=\"fastdds\""));
  CHECK_THAT(text,
             Catch::Contains("m.xml:3:") && Catch::Contains("\"loopback\" has no shared memory"));
}

TEST_CASE("A profile's words that are unknown are answered with the nearest known ones") {
  ProfileFolder folder;
  const auto [attributes, finding] = GENERATE(table<std::string, std::string>({
      {R"(vendor="fastdsd")", "\"fastdsd\" is no DDS vendor known here; did you mean 'fastdds'?"},
      {R"(restart="on_failure")",
       "\"on_failure\" is no restart policy; did you mean 'on-failure'?"},
      {R"(role="boss")", "\"boss\" is no role"},
      {R"(restrat="always")", "<peer> has no \"restrat\"; did you mean 'restart'?"},
      {R"(on_loss="abord")", "\"abord\" is no answer to a loss; did you mean 'abort'?"},
      {R"(progress_timeout="0 s")", "progress_timeout is zero"},
      {R"(progress_timeout="1 ms")",
       "progress_timeout is \"1 ms\", and a process in order may need that long to tell of its "
       "progress; write 100 ms or more"},
      {R"(stop_timeout="0 s")", "stop_timeout is zero"},
      {R"(stop_timeout="3000")",
       "stop_timeout: \"3000\" has no unit of time; write \"3000 ms\" or \"3000 s\""},
      {R"(stop_timeout="long")", "\"long\" is no length of time"},
      {R"(max_restarts="0")", "\"max_restarts\" is 0, less than 1"},
      {R"(max_restarts="3")",
       "max_restarts has no effect, since the process is never restarted; write restart="},
      {R"(restart_window="9 s")", "restart_window has no effect"},
      {R"(restart="always" restart_window="1 s")", "do not fit into restart_window"},
  }));
  const std::string peer = R"(<peer name="f" component="f.xml" )" + attributes + "/>";
  CHECK_THAT(folder.check(peer), Catch::Contains("m.xml:2:") && Catch::Contains(finding));
}

TEST_CASE("Names that would break a topic or a command line are refused") {
  ProfileFolder folder;
  const auto name =
      GENERATE(as<std::string>(), "a b", "a/b", "a.b", "\xC3\xA4", "a&#10;b", std::string(65, 'a'));
  CHECK_THAT(folder.check("<peer name=\"" + name + "\" component=\"f.xml\"/>"),
             Catch::Contains("is no name; use letters"));
}

TEST_CASE("A domain outside of what DDS has is refused") {
  ProfileFolder folder;
  const auto domain = GENERATE(as<std::string>(), "-1", "233", "x", "1.0", "99999999999");
  folder.write("m.xml", "<mission name=\"m\" domain=\"" + domain +
                            "\"><peer name=\"f\" component=\"f.xml\"/></mission>");
  CHECK_THAT(to_text(check_file(folder.path() / "m.xml")), Catch::Contains("is no DDS domain"));
}

TEST_CASE("Logs go into a folder that has a name") {
  ProfileFolder folder;
  const auto file = folder.path() / "m.xml";
  const auto write = [&](const std::string& logs) {
    folder.write("m.xml", "<mission name=\"m\" logs=\"" + logs +
                              "\"><peer name=\"f\" component=\"f.xml\"/></mission>");
  };
  write("here");
  CHECK(read_mission_profile(file).logs == "here");
  write("");
  CHECK_THAT(to_text(check_file(file)),
             Catch::Contains("m.xml:1:19: error: <mission> has an empty logs"));
}

TEST_CASE("A component that cannot be read is reported where it is named, and why") {
  ProfileFolder folder;
  folder.write("bad.xml", "<component name=\"B\">");
  const auto text = folder.check(
      "<peer name=\"a\" component=\"none.xml\"/>\n"
      "<peer name=\"b\" component=\"bad.xml\"/>");
  CHECK_THAT(text, Catch::Contains("m.xml:2:16: error: the component \"none.xml\" cannot be read"));
  CHECK_THAT(text, Catch::Contains("none.xml: error: cannot be opened: No such file"));
  CHECK_THAT(text, Catch::Contains("m.xml:3:16: error: the component \"bad.xml\" cannot be read"));
  CHECK_THAT(
      text,
      Catch::Contains(
          "bad.xml:1:1: error: malformed XML: <component> is not closed: the file ends first"));
}

TEST_CASE("Reading a profile with mistakes throws all of them") {
  ProfileFolder folder;
  const auto file = folder.mission("<peer name=\"a b\" component=\"f.xml\"/><peer/>");
  CHECK_THROWS_WITH(
      read_mission_profile(file),
      Catch::Contains("is no name") && Catch::Contains("<peer> has neither a component"));
}

TEST_CASE("A setting from the command line takes the place of the profile's") {
  ProfileFolder folder;
  auto mission = read_mission_profile(folder.mission(
      R"(<peer name="n" component="n.xml"><parameter name="Time limit" value="5 s"/></peer>
         <peer name="g" component="g.xml"/>)"));
  apply_setting(mission, "n.Time limit=2 s");
  CHECK(mission.peers[0].find_parameter("Time limit")->value == "2 s");
  apply_setting(mission, "g.Time limit=7 ms");
  CHECK(mission.peers[1].find_parameter("Time limit")->value == "7 ms");
  CHECK_THROWS_WITH(apply_setting(mission, "m.Time limit=1"), Catch::Contains("no peer \"m\""));
  CHECK_THROWS_WITH(apply_setting(mission, "n/x.Time limit=1"), Catch::Contains("no CSP \"x\""));
  CHECK_THROWS_WITH(apply_setting(mission, "n.Timelimit=1"),
                    Catch::Contains("did you mean 'Time limit'?"));
  CHECK_THROWS_WITH(apply_setting(mission, "n.Time limit=0 ms"), Catch::Contains("less than 1 ms"));
  CHECK_THROWS_WITH(apply_setting(mission, "n.Time limit=9"), Catch::Contains("no unit of time"));
  CHECK_THROWS_WITH(apply_setting(mission, "Time limit=0"),
                    Catch::Contains("PEER.PARAMETER=VALUE"));
}
