#include "mission/supervise/supervisor.hpp"

#include <fcntl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <catch2/catch.hpp>
#include <csignal>

#include "core/system/file_descriptor.hpp"
#include "mission/supervise/supervised_child.hpp"
#include "shell_mission.hpp"
#include "test/tools/temporary_folder.hpp"

using namespace skein::launch;
using namespace std::chrono_literals;
using skein::profile::LossPolicy;
using skein::profile::RestartPolicy;

namespace {

ChildPlan supervised_mission(const std::string& script) {
  auto child = shell_child("mission", script);
  child.runs_mission = true;
  return child;
}

}  // namespace

TEST_CASE("The exit code of the mission's peer is the mission's") {
  const auto [script, code] = GENERATE(table<std::string, int>({
      {"exit 0", 0},
      {"ready; exit 0", 0},
      {"exit 3", 3},
      {"kill -SEGV $$", 128 + SIGSEGV},
      {"kill -KILL $$", 128 + SIGKILL},
  }));
  RecordedMission mission({shell_child("other", kWait), supervised_mission(script)});
  const auto result = mission.run();
  CHECK(result.exit_code == code);
  CHECK_THAT(result.reason, Catch::StartsWith("mission, which runs the mission, ended"));
}

TEST_CASE("A mission without a peer that runs it ends when all processes have ended") {
  auto failing = shell_child("b", "ready; exit 1");
  failing.rules.on_loss = LossPolicy::Continue;
  RecordedMission fine({shell_child("a", "exit 0"), shell_child("b", "exit 0")});
  CHECK(fine.run().exit_code == 0);
  RecordedMission marred({shell_child("a", "exit 0"), failing});
  const auto result = marred.run();
  CHECK(result.exit_code == kPeerLost);
  CHECK(result.reason == "b ended with exit code 1");
}

TEST_CASE("Output comes line by line with the name of its process, also without a line break") {
  RecordedMission mission({supervised_mission("echo one; echo two >&2; printf 'three\\n\\nrest'")});
  mission.run();
  CHECK(mission.lines == std::vector<std::string>{"mission|one", "mission|two", "mission|three",
                                                  "mission|", "mission|rest"});
}

TEST_CASE("No output is lost when a process ends in the middle of much of it") {
  RecordedMission mission({supervised_mission(
      "i=0; while [ $i -lt 20000 ]; do echo line $i; i=$((i+1)); done; exit 5")});
  CHECK(mission.run().exit_code == 5);
  REQUIRE(mission.lines.size() == 20000);
  CHECK(mission.lines.back() == "mission|line 19999");
}

TEST_CASE("A program that does not exist is a failed start that names it") {
  auto child = shell_child("a", "");
  child.argv = {"/no/such/program"};
  RecordedMission mission({shell_child("b", kWait), child});
  const auto result = mission.run();
  CHECK(result.exit_code == kStartFailed);
  CHECK(result.reason ==
        "a could not be started: cannot execute /no/such/program: No such file or directory");
}

TEST_CASE("A restart for which there are no descriptors left is tried again") {
  TemporaryFolder folder;
  folder.write("starts", "");
  const std::string starts = (folder.path() / "starts").string();
  auto child = shell_child("a", "echo $$ >> " + starts + "; ready; [ $(wc -l < " + starts +
                                    ") -gt 1 ] || exit 1; while :; do sleep 1000; done");
  child.rules.restart.policy = RestartPolicy::OnFailure;
  child.rules.restart.max_restarts = 1000;
  RecordedMission mission({child, supervised_mission("ready; while [ $(wc -l < " + starts +
                                                     ") -lt 2 ]; do sleep 0.01; done")});
  std::vector<skein::FileDescriptor> hoard;
  rlimit before{};
  ::getrlimit(RLIMIT_NOFILE, &before);
  const rlimit few{64, before.rlim_max};
  mission.on_event = [&](const ChildEvent& event) {
    if (event.text.find("Too many open files") != std::string::npos) hoard.clear();
    if (event.text.find("ended with exit code 1") == std::string::npos) return;
    ::setrlimit(RLIMIT_NOFILE, &few);
    do {
      hoard.emplace_back(::open("/dev/null", O_RDONLY));
    } while (hoard.back());
  };
  const auto result = mission.run();
  ::setrlimit(RLIMIT_NOFILE, &before);
  CHECK(result.exit_code == 0);
  CHECK(mission.saw("a: the launcher cannot make a pipe: Too many open files; restart number 2"));
  CHECK_THAT(result.first_fault, Catch::Contains("a ended with exit code 1"));
}

TEST_CASE("A required process that never becomes ready fails the start") {
  auto child = shell_child("a", "while :; do sleep 1000; done");
  child.rules.ready_timeout = 50ms;
  child.runs_mission = GENERATE(false, true);
  RecordedMission mission({shell_child("b", kWait), child});
  const auto result = mission.run();
  CHECK(result.exit_code == kStartFailed);
  CHECK(result.reason == "a did not become ready within 0.05 s");
}

TEST_CASE("What a process said it waits for is part of the reason why it did not become ready") {
  auto child = shell_child("a",
                           "echo '?for b' >&$SKEIN_READY_FD; echo '?for \033c' >&$SKEIN_READY_FD; "
                           "while :; do sleep 1000; done");
  child.rules.ready_timeout = 500ms;
  RecordedMission hung({child});
  const auto result = hung.run();
  CHECK(result.exit_code == kStartFailed);
  CHECK(result.reason == "a did not become ready within 0.50 s (last it said: for \\x1bc)");
  CHECK(hung.saw("a: did not become ready within 0.50 s (last it said: for \\x1bc): killed"));

  RecordedMission gave_up({shell_child("a", "echo '?for b' >&$SKEIN_READY_FD; exit 3")});
  CHECK(gave_up.run().reason == "a ended with exit code 3 (last it said: for b)");
}

TEST_CASE("A process that has waited and is ready has no reason any more") {
  RecordedMission mission({shell_child("a", "printf '?for b\\n\\n' >&$SKEIN_READY_FD; exit 3")});
  const auto result = mission.run();
  CHECK(result.exit_code == kPeerLost);
  CHECK(result.reason == "a ended with exit code 3");
}

TEST_CASE(
    "A launcher without the peer that runs the mission says so, and ends with its processes") {
  RecordedMission ending({shell_child("a", "ready; exit 0")});
  ending.plan.mission_elsewhere = "client on beta";
  CHECK(ending.run().exit_code == 0);
  RecordedMission waiting({shell_child("a", kWait)});
  waiting.plan.mission_elsewhere = "client on beta";
  Supervisor* running = nullptr;
  waiting.on_event = [&](const ChildEvent& event) {
    if (event.text.find("the peer that runs the mission is not among them") != std::string::npos)
      running->request_stop();
  };
  Supervisor supervisor(waiting.plan, waiting.options());
  running = &supervisor;
  CHECK(supervisor.run().exit_code == kInterrupted + SIGTERM);
}

TEST_CASE(
    "A required process that is lost after it was ready is another outcome than a failed start") {
  const auto [script, code] = GENERATE(table<std::string, int>({
      {"ready; exit 4", kPeerLost},
      {"exit 4", kStartFailed},
  }));
  RecordedMission mission({shell_child("a", script), supervised_mission(kWait)});
  const auto result = mission.run();
  CHECK(result.exit_code == code);
  CHECK(result.reason == "a ended with exit code 4");
}

TEST_CASE("Readiness is reported for each process, and for all of them together") {
  TemporaryFolder folder;
  const std::string go = (folder.path() / "go").string();
  RecordedMission mission({shell_child("a", kWait), supervised_mission("ready; while [ ! -e " + go +
                                                                       " ]; do sleep 0.01; done")});
  mission.on_event = [&](const ChildEvent& event) {
    if (event.text.find("all 2 processes are ready") != std::string::npos) folder.write("go", "");
  };
  CHECK(mission.run().exit_code == 0);
  CHECK(mission.saw("a: ready after"));
  CHECK(mission.saw("mission: ready after"));
}

TEST_CASE("Who has ended by himself is not waited for before it is told who is ready") {
  TemporaryFolder folder;
  const std::string go = (folder.path() / "go").string();
  const std::string end = GENERATE("exit 0", "exit 1");
  auto brief = shell_child("brief", end);
  brief.rules.on_loss = LossPolicy::Continue;
  const bool ready_before_the_other_ends = GENERATE(true, false);
  const std::string ended = (folder.path() / "ended").string();
  const std::string begin = ready_before_the_other_ends
                                ? "ready; "
                                : "while [ ! -e " + ended + " ]; do sleep 0.01; done; ready; ";
  RecordedMission mission(
      {brief, supervised_mission(begin + "while [ ! -e " + go + " ]; do sleep 0.01; done")});
  mission.on_event = [&](const ChildEvent& event) {
    if (event.text.starts_with("ended with exit code")) folder.write("ended", "");
    if (event.text.starts_with("1 of 2 processes are ready after ") &&
        event.text.ends_with("; the others have ended"))
      folder.write("go", "");
  };
  const auto result = mission.run();
  CAPTURE(result.reason, mission.events);
  CHECK(result.exit_code == 0);
  CHECK_FALSE(mission.saw("all 2 processes are ready"));
}

TEST_CASE("A failing process is restarted by its rules and then given up") {
  TemporaryFolder folder;
  const std::string starts = (folder.path() / "starts").string();
  auto child = shell_child("a", "ready; echo $$ >> " + starts + "; exit 1");
  child.rules.restart.policy = RestartPolicy::OnFailure;
  child.rules.restart.max_restarts = 3;
  RecordedMission mission({child, supervised_mission(kWait)});
  const auto result = mission.run();
  CHECK(result.exit_code == kPeerLost);
  CHECK(result.reason == "a ended with exit code 1, given up after 3 restarts");
  CHECK(numbers_in(starts).size() == 4);
}

TEST_CASE("A dependant starts when what it depends on is ready, and not before") {
  TemporaryFolder folder;
  const std::string go = (folder.path() / "go").string();
  auto dependant = supervised_mission("exit 0");
  dependant.layer = 1;
  dependant.after = {{"M/I", {"a"}}, {"M/J", {"b"}}};
  RecordedMission mission(
      {dependant, shell_child("a", "while [ ! -e " + go + " ]; do sleep 0.01; done; " + kWait),
       shell_child("b", kWait)});
  bool ready = false;
  mission.on_event = [&](const ChildEvent& event) {
    if (event.child == "b" && event.state == ChildState::Ready) folder.write("go", "");
    if (event.child == "a" && event.state == ChildState::Ready) ready = true;
    if (event.child == "mission" && event.text.starts_with("started")) CHECK(ready);
  };
  CHECK(mission.run().exit_code == 0);
}

TEST_CASE("A process that runs and makes no progress is killed and started again") {
  TemporaryFolder folder;
  folder.write("starts", "");
  const std::string starts = (folder.path() / "starts").string();
  auto child = shell_child("a", "echo $$ >> " + starts +
                                    "; ready; ready; echo '?deadlocked' >&$SKEIN_READY_FD; "
                                    "while :; do :; done");
  child.rules.progress_timeout = 100ms;
  child.rules.restart.policy = RestartPolicy::OnFailure;
  RecordedMission mission({child, supervised_mission("ready; while [ $(wc -l < " + starts +
                                                     ") -lt 2 ]; do sleep 0.01; done")});
  CHECK(mission.run().exit_code == 0);
  CHECK(mission.saw("a: made no progress for 0.10 s (last it said: deadlocked): killed"));
  CHECK(mission.saw("restart number 1 follows"));
}

TEST_CASE("A process that makes progress is left alone, however often it says so") {
  TemporaryFolder folder;
  const std::string signs = (folder.path() / "signs").string();
  folder.write("signs", "");
  auto child = shell_child("a", "ready; while :; do ready; echo >> " + signs + "; done");
  child.rules.progress_timeout = 20s;
  RecordedMission mission({child, supervised_mission("ready; while [ $(wc -l < " + signs +
                                                     ") -lt 5000 ]; do sleep 0.01; done")});
  CHECK(mission.run().exit_code == 0);
  CHECK_FALSE(mission.saw("a: made no progress"));
}

TEST_CASE("A process that is ready as soon as it runs can report progress, too") {
  TemporaryFolder folder;
  const std::string signs = (folder.path() / "signs").string();
  folder.write("signs", "");
  auto child = shell_child("a", "for i in $(seq 12); do ready; echo >> " + signs +
                                    "; sleep 0.2; done; while :; do sleep 1000; done");
  child.tells_ready = false;
  child.rules.progress_timeout = 2s;
  RecordedMission mission({child});
  const auto result = mission.run();
  CHECK(result.reason == "a made no progress for 2.00 s");
  std::ifstream file(signs);
  CHECK(std::count(std::istreambuf_iterator<char>(file), {}, '\n') == 12);
}

TEST_CASE("A stopped process makes no progress, and cannot hold up its end") {
  auto child = shell_child("a", "ready; kill -STOP $$");
  child.rules.progress_timeout = 50ms;
  RecordedMission mission({child});
  const auto result = mission.run();
  CHECK(result.exit_code == kPeerLost);
  CHECK(result.reason == "a made no progress for 0.05 s");
}

TEST_CASE("A mission that lost what degrades it goes on, and its exit code says so in the end") {
  TemporaryFolder folder;
  const std::string go = (folder.path() / "go").string();
  const int code = GENERATE(0, 3);
  auto child = shell_child("a", "ready; exit 1");
  child.rules.on_loss = LossPolicy::Degrade;
  RecordedMission mission(
      {child, supervised_mission("ready; while [ ! -e " + go + " ]; do sleep 0.01; done; exit " +
                                 std::to_string(code))});
  mission.on_event = [&](const ChildEvent& event) {
    if (event.text == "goes on degraded, without a") folder.write("go", "");
  };
  const auto result = mission.run();
  CHECK(result.exit_code == (code == 0 ? kDegraded : code));
  CHECK_THAT(result.first_fault, Catch::Contains("a ended with exit code 1"));
}

TEST_CASE("The first fault is told beside what ended the mission, where they differ") {
  auto first = shell_child("a", "ready; exit 4");
  first.rules.on_loss = LossPolicy::Continue;
  TemporaryFolder folder;
  const std::string go = (folder.path() / "go").string();
  auto second = supervised_mission("while [ ! -e " + go + " ]; do sleep 0.01; done; exit 5");
  second.layer = 1;
  second.after = {{"M/I", {"a"}}};
  RecordedMission both({first, second});
  both.on_event = [&](const ChildEvent& event) {
    if (event.child == "a" && event.text.starts_with("ended with exit code 4"))
      folder.write("go", "");
  };
  const auto result = both.run();
  CHECK(result.reason == "mission, which runs the mission, ended with exit code 5");
  CHECK_THAT(result.first_fault, Catch::Matches("after [0-9.]+ m?s, a ended with exit code 4"));
  RecordedMission one({supervised_mission("exit 5")});
  CHECK(one.run().first_fault.empty());
}

TEST_CASE("What left its process's group and session goes with the process") {
  TemporaryFolder folder;
  folder.write("pids", "");
  const std::string pids = (folder.path() / "pids").string();
  RecordedMission mission({supervised_mission(
      "setsid sh -c 'echo $$ >> " + pids + "; (sleep 1000 & echo $! >> " + pids +
      "); exec sleep 1000' & while [ $(wc -l < " + pids + ") -lt 2 ]; do sleep 0.01; done")});
  CHECK(mission.run().exit_code == 0);
  REQUIRE(numbers_in(pids).size() == 2);
  for (const pid_t process : numbers_in(pids)) CHECK_FALSE(exists(process));
}

TEST_CASE("What becomes another program as the mission ends goes with it, too") {
  TemporaryFolder folder;
  folder.write("pids", "");
  const std::string pids = (folder.path() / "pids").string();
  RecordedMission mission({supervised_mission(
      R"(F='exec sh -c "$F"'; export F; for i in 0 1 2 3 4 5 6 7 8 9; do setsid sh -c 'echo $$ >> )" +
      pids + R"(; eval "$F"' & done; while [ $(wc -l < )" + pids +
      ") -lt 10 ]; do sleep 0.01; done")});
  CHECK(mission.run().exit_code == 0);
  REQUIRE(numbers_in(pids).size() == 10);
  for (const pid_t process : numbers_in(pids)) CHECK_FALSE(exists(process));
}

TEST_CASE("When run() returns, no process of any group is left") {
  TemporaryFolder folder;
  const std::string pids = (folder.path() / "pids").string();
  const std::string stubborn = "trap '' INT TERM; echo $$ >> " + pids +
                               "; (trap '' INT TERM; while :; do sleep 1000; done) & echo $! >> " +
                               pids + "; ready; while :; do sleep 1000; done";
  auto child = shell_child("a", stubborn);
  child.rules.stop_timeout = 20ms;
  const std::string leaver = "sleep 1000 & echo $! >> " + pids + "; ready";
  RecordedMission mission(
      {child, shell_child("b", leaver),
       supervised_mission("ready; while [ $(wc -l < " + pids + ") -lt 3 ]; do sleep 0.01; done")});
  folder.write("pids", "");
  CHECK(mission.run().exit_code == 0);
  CHECK(mission.saw("a: did not end within 0.02 s: killed"));
  const auto processes = numbers_in(pids);
  REQUIRE(processes.size() == 3);
  for (const pid_t process : processes) CHECK_FALSE(exists(process));
}

TEST_CASE("A child starts with a clean slate: four descriptors, no blocked or ignored signal") {
  RecordedMission mission(
      {supervised_mission("for n in $(seq 0 99); do [ -e /proc/$$/fd/$n ] && printf \"$n \"; done; "
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
  RecordedMission mission({supervised_mission("exit 6")});
  CHECK(mission.run().exit_code == 6);
  CHECK(std::signal(SIGCHLD, before) == SIG_IGN);
}

TEST_CASE("An orphan that has left its group and its environment is waited for when it ends") {
  TemporaryFolder folder;
  const std::string pid = (folder.path() / "pid").string();
  // The mission ends only when no process has that number: a zombie would have it still.
  RecordedMission mission({supervised_mission(
      "(env -i setsid sh -c 'echo $$ > " + pid + "' &); until [ -s " + pid +
      " ]; do sleep 0.01; done; while kill -0 $(cat " + pid + "); do sleep 0.01; done; exit 0")});
  CHECK(mission.run().exit_code == 0);
}

TEST_CASE("Orphans that end cost no child its exit status") {
  auto child = shell_child("a", "for i in 1 2 3 4 5; do (env -i setsid true &); done; exit 3");
  child.rules.restart.policy = RestartPolicy::OnFailure;
  child.rules.restart.max_delay = 1ms;
  child.rules.restart.max_restarts = 30;
  RecordedMission mission({child});
  CHECK(mission.run().exit_code == kStartFailed);
  CHECK(mission.saw("restart number 30"));
  for (const std::string& event : mission.events) {
    if (event.find("ended with") != std::string::npos)
      CHECK_THAT(event, Catch::Contains("ended with exit code 3"));
  }
}

TEST_CASE("An orphan that has left its group and its environment does not survive the mission") {
  TemporaryFolder folder;
  folder.write("pids", "");
  const std::string pids = (folder.path() / "pids").string();
  // It ignores signals, and has a child that has left it, too.
  const std::string stray = folder
                                .write("stray.sh", "trap '' INT TERM; echo $$ >> " + pids +
                                                       "; [ $# -gt 0 ] || setsid sh $0 child & "
                                                       "while :; do sleep 1000; done")
                                .string();
  RecordedMission mission(
      {supervised_mission("(env -i setsid sh " + stray + " &); until [ $(wc -l < " + pids +
                          ") -eq 2 ]; do sleep 0.01; done")});
  CHECK(mission.run().exit_code == 0);
  REQUIRE(numbers_in(pids).size() == 2);
  for (const pid_t orphan : numbers_in(pids)) CHECK_FALSE(exists(orphan));
}

TEST_CASE("A child that this process had before the mission outlives it") {
  const pid_t earlier = ::fork();
  if (earlier == 0) {
    while (true) ::pause();
  }
  RecordedMission mission({supervised_mission("exit 0")});
  CHECK(mission.run().exit_code == 0);
  CHECK(::waitpid(earlier, nullptr, WNOHANG) == 0);
  ::kill(earlier, SIGKILL);
  CHECK(::waitpid(earlier, nullptr, 0) == earlier);
}

TEST_CASE("A process that closes its output and says nothing more is watched all the same") {
  RecordedMission mission({supervised_mission("exec >&- 2>&- 3>&-; exit 7")});
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

TEST_CASE("a time is told in seconds, and one that would show as none in milliseconds") {
  CHECK(seconds_text(3s) == "3.00 s");
  CHECK(seconds_text(10ms) == "0.01 s");
  CHECK(seconds_text(1ms) == "1 ms");
  CHECK(seconds_text(1500us) == "1.5 ms");
}
