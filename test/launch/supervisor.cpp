#include "launch/supervisor.hpp"

#include <catch2/catch.hpp>
#include <csignal>

#include "shell_mission.hpp"
#include "temporary_folder.hpp"

using namespace skein::launch;
using namespace std::chrono_literals;
using skein::profile::RestartPolicy;

namespace {

ChildPlan mission_child(const std::string& script) {
  auto child = shell_child("mission", script);
  child.runs_mission = true;
  return child;
}

const std::string kWait = "ready; while :; do sleep 1000; done";

}  // namespace

TEST_CASE("The exit code of the mission's peer is the mission's") {
  const auto [script, code] = GENERATE(table<std::string, int>({
      {"exit 0", 0},
      {"ready; exit 0", 0},
      {"exit 3", 3},
      {"kill -SEGV $$", 128 + SIGSEGV},
      {"kill -KILL $$", 128 + SIGKILL},
  }));
  RecordedMission mission({shell_child("other", kWait), mission_child(script)});
  const auto result = mission.run();
  CHECK(result.outcome == Outcome::MissionEnded);
  CHECK(result.exit_code == code);
  CHECK_THAT(result.reason, Catch::StartsWith("mission, which runs the mission, ended"));
}

TEST_CASE("A mission without a peer that runs it ends when all processes have ended") {
  auto failing = shell_child("b", "ready; exit 1");
  failing.required = false;
  RecordedMission fine({shell_child("a", "exit 0"), shell_child("b", "exit 0")});
  CHECK(fine.run().exit_code == 0);
  RecordedMission marred({shell_child("a", "exit 0"), failing});
  const auto result = marred.run();
  CHECK(result.exit_code == kPeerLost);
  CHECK(result.reason == "b ended with exit code 1");
}

TEST_CASE("Output comes line by line with the name of its process, also without a line break") {
  RecordedMission mission({mission_child("echo one; echo two >&2; printf 'three\\n\\nrest'")});
  mission.run();
  CHECK(mission.lines == std::vector<std::string>{"mission|one", "mission|two", "mission|three",
                                                  "mission|", "mission|rest"});
}

TEST_CASE("No output is lost when a process ends in the middle of much of it") {
  RecordedMission mission(
      {mission_child("i=0; while [ $i -lt 20000 ]; do echo line $i; i=$((i+1)); done; exit 5")});
  CHECK(mission.run().exit_code == 5);
  REQUIRE(mission.lines.size() == 20000);
  CHECK(mission.lines.back() == "mission|line 19999");
}

TEST_CASE("A program that does not exist is a failed start that names it") {
  auto child = shell_child("a", "");
  child.argv = {"/no/such/program"};
  RecordedMission mission({shell_child("b", kWait), child});
  const auto result = mission.run();
  CHECK(result.outcome == Outcome::StartFailed);
  CHECK(result.exit_code == kStartFailed);
  CHECK(result.reason ==
        "a could not be started: cannot execute /no/such/program: No such file or directory");
}

TEST_CASE("A required process that never becomes ready fails the start") {
  auto child = shell_child("a", "while :; do sleep 1000; done");
  child.rules.ready_timeout = 50ms;
  child.runs_mission = GENERATE(false, true);
  RecordedMission mission({shell_child("b", kWait), child});
  const auto result = mission.run();
  CHECK(result.outcome == Outcome::StartFailed);
  CHECK(result.exit_code == kStartFailed);
  CHECK(result.reason == "a did not become ready");
}

TEST_CASE("What a process said it waits for is part of the reason why it did not become ready") {
  auto child = shell_child("a",
                           "echo '?for b' >&$SKEIN_READY_FD; echo '?for \033c' >&$SKEIN_READY_FD; "
                           "while :; do sleep 1000; done");
  child.rules.ready_timeout = 500ms;
  RecordedMission hung({child});
  const auto result = hung.run();
  CHECK(result.exit_code == kStartFailed);
  CHECK(result.reason == "a did not become ready (last it said: for \\x1bc)");
  CHECK(hung.saw("a: is not ready after 0.50 s (last it said: for \\x1bc): killed"));

  RecordedMission gave_up({shell_child("a", "echo '?for b' >&$SKEIN_READY_FD; exit 3")});
  CHECK(gave_up.run().reason == "a ended with exit code 3 (last it said: for b)");
}

TEST_CASE("A process that has waited and is ready has no reason any more") {
  RecordedMission mission({shell_child("a", "printf '?for b\\n\\n' >&$SKEIN_READY_FD; exit 3")});
  const auto result = mission.run();
  CHECK(result.outcome == Outcome::PeerLost);
  CHECK(result.reason == "a ended with exit code 3");
}

TEST_CASE("A launcher whose mission runs on another host says so, and ends with its processes") {
  RecordedMission ending({shell_child("a", "ready; exit 0")});
  ending.plan.mission_elsewhere = "client on beta";
  CHECK(ending.run().exit_code == 0);
  RecordedMission waiting({shell_child("a", kWait)});
  waiting.plan.mission_elsewhere = "client on beta";
  Supervisor* running = nullptr;
  waiting.on_event = [&](const ChildEvent& event) {
    if (event.text.find("the mission runs on another host") != std::string::npos)
      running->request_stop();
  };
  Supervisor supervisor(waiting.plan, waiting.options());
  running = &supervisor;
  CHECK(supervisor.run().outcome == Outcome::Interrupted);
}

TEST_CASE(
    "A required process that is lost after it was ready is another outcome than a failed start") {
  const auto [script, outcome, code] = GENERATE(table<std::string, Outcome, int>({
      {"ready; exit 4", Outcome::PeerLost, kPeerLost},
      {"exit 4", Outcome::StartFailed, kStartFailed},
  }));
  RecordedMission mission({shell_child("a", script), mission_child(kWait)});
  const auto result = mission.run();
  CHECK(result.outcome == outcome);
  CHECK(result.exit_code == code);
  CHECK(result.reason == "a ended with exit code 4");
}

TEST_CASE("Readiness is reported for each process, and for all of them together") {
  TemporaryFolder folder;
  const std::string go = (folder.path() / "go").string();
  RecordedMission mission({shell_child("a", kWait),
                           mission_child("ready; while [ ! -e " + go + " ]; do sleep 0.01; done")});
  mission.on_event = [&](const ChildEvent& event) {
    if (event.text.find("all 2 processes are ready") != std::string::npos) folder.write("go", "");
  };
  CHECK(mission.run().exit_code == 0);
  CHECK(mission.saw("a: ready after"));
  CHECK(mission.saw("mission: ready after"));
}

TEST_CASE("A failing process is restarted by its rules and then given up") {
  TemporaryFolder folder;
  const std::string starts = (folder.path() / "starts").string();
  auto child = shell_child("a", "ready; echo $$ >> " + starts + "; exit 1");
  child.rules.restart.policy = RestartPolicy::OnFailure;
  child.rules.restart.max_restarts = 3;
  RecordedMission mission({child, mission_child(kWait)});
  const auto result = mission.run();
  CHECK(result.outcome == Outcome::PeerLost);
  CHECK(result.reason == "a ended with exit code 1, given up after 3 restarts");
  CHECK(numbers_in(starts).size() == 4);
}

TEST_CASE("A mission goes on without a process that it does not require") {
  TemporaryFolder folder;
  const std::string go = (folder.path() / "go").string();
  auto child = shell_child("a", "ready; exit 1");
  child.required = false;
  child.rules.restart.policy = RestartPolicy::Always;
  child.rules.restart.max_restarts = 2;
  RecordedMission mission(
      {child, mission_child("ready; while [ ! -e " + go + " ]; do sleep 0.01; done")});
  mission.on_event = [&](const ChildEvent& event) {
    if (event.text.find("given up after 2 restarts") != std::string::npos) folder.write("go", "");
  };
  const auto result = mission.run();
  CHECK(result.outcome == Outcome::MissionEnded);
  CHECK(result.exit_code == 0);
}

TEST_CASE("A process killed from outside comes back") {
  TemporaryFolder folder;
  const std::string starts = (folder.path() / "starts").string();
  auto child = shell_child("a", "echo $$ >> " + starts + "; " + kWait);
  child.rules.restart.policy = RestartPolicy::OnFailure;
  RecordedMission mission({child, mission_child("ready; while [ $(wc -l < " + starts +
                                                ") -lt 2 ]; do sleep 0.01; done")});
  folder.write("starts", "");
  mission.on_event = [&, killed = false](const ChildEvent& event) mutable {
    if (event.child != "a" || event.state != ChildState::Ready || killed) return;
    killed = true;
    ::kill(numbers_in(starts).at(0), SIGKILL);
  };
  CHECK(mission.run().exit_code == 0);
  CHECK(mission.saw("a: ended by signal 9 (Killed); restart number 1 follows"));
}

TEST_CASE("When run() returns, no process of any group is left") {
  TemporaryFolder folder;
  const std::string pids = (folder.path() / "pids").string();
  const std::string stubborn = "trap '' TERM; echo $$ >> " + pids +
                               "; (trap '' TERM; while :; do sleep 1000; done) & echo $! >> " +
                               pids + "; ready; while :; do sleep 1000; done";
  auto child = shell_child("a", stubborn);
  child.rules.stop_timeout = 20ms;
  const std::string leaver = "sleep 1000 & echo $! >> " + pids + "; ready";
  RecordedMission mission(
      {child, shell_child("b", leaver),
       mission_child("ready; while [ $(wc -l < " + pids + ") -lt 3 ]; do sleep 0.01; done")});
  folder.write("pids", "");
  CHECK(mission.run().exit_code == 0);
  CHECK(mission.saw("a: did not end within 0.02 s: killed"));
  const auto processes = numbers_in(pids);
  REQUIRE(processes.size() == 3);
  for (const pid_t process : processes) CHECK_FALSE(exists(process));
}

TEST_CASE("A child starts with a clean slate: four descriptors, no blocked or ignored signal") {
  RecordedMission mission(
      {mission_child("for n in $(seq 0 99); do [ -e /proc/$$/fd/$n ] && printf \"$n \"; done; "
                     "echo $SKEIN_READY_FD; readlink /proc/$$/fd/0; "
                     "grep -E 'SigBlk|SigIgn' /proc/$$/status | tr -d '\\t'; echo $COLOUR")});
  mission.plan.children[0].environment = {{"COLOUR", "grey"}};
  ::setenv("COLOUR", "white", 1);
  const auto before = std::signal(SIGPIPE, SIG_IGN);
  mission.run();
  std::signal(SIGPIPE, before);
  CHECK(mission.lines == std::vector<std::string>{"mission|0 1 2 3 3", "mission|/dev/null",
                                                  "mission|SigBlk:0000000000000000",
                                                  "mission|SigIgn:0000000000000000",
                                                  "mission|grey"});
}

TEST_CASE("A launcher whose parent ignored SIGCHLD sees its children end all the same") {
  const auto before = std::signal(SIGCHLD, SIG_IGN);
  RecordedMission mission({mission_child("exit 6")});
  CHECK(mission.run().exit_code == 6);
  CHECK(std::signal(SIGCHLD, before) == SIG_IGN);
}

TEST_CASE("A process that closes its output and says nothing more is watched all the same") {
  RecordedMission mission({mission_child("exec >&- 2>&- 3>&-; exit 7")});
  CHECK(mission.run().exit_code == 7);
}

TEST_CASE("A request to stop ends the mission in order, from another thread or before it began") {
  RecordedMission mission({shell_child("a", kWait)});
  Supervisor supervisor(mission.plan, mission.options());
  SECTION("before") { supervisor.request_stop(); }
  std::thread other;
  SECTION("from another thread, when all is ready") {
    mission.on_event = [&](const ChildEvent& event) {
      if (event.state == ChildState::Ready && event.child == "a") {
        other = std::thread([&] { supervisor.request_stop(); });
      }
    };
  }
  const auto result = supervisor.run();
  if (other.joinable()) other.join();
  CHECK(result.outcome == Outcome::Interrupted);
  CHECK(result.exit_code == kInterrupted + SIGTERM);
}

TEST_CASE("A callback that throws leaves no process behind") {
  TemporaryFolder folder;
  const std::string pids = (folder.path() / "pids").string();
  RecordedMission mission({shell_child("a", "echo $$ >> " + pids + "; " + kWait)});
  mission.on_event = [](const ChildEvent& event) {
    if (event.state == ChildState::Ready) throw std::runtime_error("from a callback");
  };
  CHECK_THROWS_WITH(mission.run(), "from a callback");
  REQUIRE(numbers_in(pids).size() == 1);
  CHECK_FALSE(exists(numbers_in(pids)[0]));
}
