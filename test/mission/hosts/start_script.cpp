#include "mission/hosts/start_script.hpp"

#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <catch2/catch.hpp>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <random>
#include <sstream>

#include "test/mission/supervise/shell_mission.hpp"
#include "test/tools/eventually.hpp"
#include "test/tools/seed.hpp"
#include "test/tools/temporary_folder.hpp"

using namespace skein::launch;
using namespace std::chrono_literals;
using Catch::Contains;
using skein::test::eventually;

namespace {

/// A script that runs by itself, in a folder for what it writes and what it keeps while it runs.
class ScriptRun {
 public:
  explicit ScriptRun(std::vector<ChildPlan> children)
      : file_(folder_.write("start.sh", start_script({"m", std::move(children), {}}))) {
    id_ = ::fork();
    if (id_ > 0) return;
    ::setpgid(0, 0);
    ::setenv("TMPDIR", folder_.path().c_str(), 1);
    const int output = ::open((folder_.path() / "output").c_str(), O_WRONLY | O_CREAT, 0600);
    ::dup2(output, STDOUT_FILENO);
    ::dup2(output, STDERR_FILENO);
    ::execl("/bin/sh", "sh", file_.c_str(), nullptr);
    ::_exit(126);
  }
  ~ScriptRun() {
    if (id_ < 0) return;
    ::kill(id_, SIGKILL);
    ::waitpid(id_, nullptr, 0);
    eventually([&] { return leaves_nothing(); });
  }
  ScriptRun(const ScriptRun&) = delete;
  ScriptRun& operator=(const ScriptRun&) = delete;

  void signal(int number) const { ::kill(id_, number); }

  /// The exit code, or 128 and the signal that ended the shell.
  int wait() {
    int status = 0;
    if (!eventually([&] { return ::waitpid(id_, &status, WNOHANG) == id_; }, 60s)) return -1;
    id_ = -1;
    return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  }

  std::string output() const {
    std::ostringstream text;
    text << std::ifstream(folder_.path() / "output").rdbuf();
    return text.str();
  }

  /// Where its processes may write to: the folder's path.
  std::string folder() const { return folder_.path().string(); }

  /// Neither its folder nor any process that has this run's folder in its environment. Wait for it:
  /// what was killed takes the kernel a moment, and the script cannot await its children's
  /// children.
  bool leaves_nothing() const {
    const std::string mark = "TMPDIR=" + folder();
    std::error_code error;
    for (const auto& entry : std::filesystem::directory_iterator(folder_.path()))
      if (entry.path().filename().string().starts_with("skein-script")) return false;
    for (const auto& entry : std::filesystem::directory_iterator("/proc")) {
      std::ifstream file(entry.path() / "environ");
      const std::string text{std::istreambuf_iterator<char>(file), {}};
      if (text.find(mark) != std::string::npos) return false;
    }
    return true;
  }

 private:
  TemporaryFolder folder_;
  std::string file_;
  pid_t id_ = -1;
};

ChildPlan mission_child(const std::string& script) {
  auto child = shell_child("mission", script);
  child.runs_mission = true;
  return child;
}

bool found(const std::string& program) {
  return std::system(("command -v " + program + " >/dev/null").c_str()) == 0;
}

}  // namespace

TEST_CASE("A start script ends with the code that the launcher would end with") {
  const auto [other, script, code] = GENERATE(table<std::string, std::string, int>({
      {kWait, "exit 0", 0},
      {kWait, "ready; exit 0", 0},
      {kWait, "ready; exit 3", 3},
      {kWait, "kill -SEGV $$", 128 + SIGSEGV},
      {"ready; exit 4", kWait, kPeerLost},
      {"exit 4", kWait, kStartFailed},
      {"exit 78", kWait, kConfigurationError},
      {"ready; exit 78", kWait, kConfigurationError},
  }));
  CAPTURE(other, script);
  ScriptRun run({shell_child("a", other), mission_child(script)});
  CHECK(run.wait() == code);
  CHECK(eventually([&] { return run.leaves_nothing(); }));
}

TEST_CASE("A start script without a mission's peer ends when all processes have ended") {
  auto failing = shell_child("b", "ready; exit 1");
  failing.rules.on_loss = skein::profile::LossPolicy::Continue;
  ScriptRun fine({shell_child("a", "exit 0"), shell_child("b", "ready; exit 0")});
  CHECK(fine.wait() == 0);
  ScriptRun marred({shell_child("a", "exit 0"), failing});
  CHECK(marred.wait() == kPeerLost);
  CHECK_THAT(marred.output(), Contains("b ended with exit code 1"));
}

TEST_CASE("A start script ends with a wrong configuration of what would degrade it") {
  auto wrong = shell_child("a", "exit 78");
  wrong.rules.on_loss = skein::profile::LossPolicy::Degrade;
  ScriptRun run({wrong, mission_child(kWait)});
  CHECK(run.wait() == kConfigurationError);
}

TEST_CASE("A start script goes on without what is not required") {
  auto failing = shell_child("b", "ready; exit 1");
  failing.rules.on_loss = skein::profile::LossPolicy::Continue;
  ScriptRun run(
      {failing, mission_child("ready; until grep -q 'b ended' $TMPDIR/output; do :; done")});
  CHECK(run.wait() == 0);
}

TEST_CASE(
    "A start script starts layer after layer, each when the one before is ready, and ends in "
    "reverse") {
  const auto talker = [](const std::string& name, std::size_t layer) {
    auto child = shell_child(name, "trap 'echo end " + name + "; exit 0' INT; echo begin " + name +
                                       "; ready; while :; do sleep 0.01; done");
    child.layer = layer;
    child.rules.stop_timeout = 60s;  // a shell on a busy machine is slow to obey
    return child;
  };
  auto mission = mission_child("echo fly; ready; exit 0");
  mission.layer = 2;
  ScriptRun run({talker("b", 1), talker("a", 0), mission});
  CHECK(run.wait() == 0);
  std::string said;
  std::istringstream lines(run.output());
  for (std::string line; std::getline(lines, line);) {  // the script and shells say more
    const bool own = line.starts_with("begin ") || line.starts_with("end ") || line == "fly";
    if (own) said += line + "\n";
  }
  CHECK(said == "begin a\nbegin b\nfly\nend b\nend a\n");
}

TEST_CASE("A start script kills what is not ready in time, and says what it waited for") {
  auto child = shell_child(
      "a", "printf '%s\\n' '?for \\0 b' >&$SKEIN_READY_FD; while :; do sleep 1000; done");
  child.rules.ready_timeout = 1s;
  ScriptRun run({child, shell_child("b", kWait)});
  CHECK(run.wait() == kStartFailed);
  CHECK_THAT(run.output(), Contains("a did not become ready (last it said: for \\0 b)"));
  CHECK(eventually([&] { return run.leaves_nothing(); }));
}

TEST_CASE("A start script ends in order on a signal, and its code says which") {
  const int signal = GENERATE(SIGINT, SIGTERM, SIGHUP);
  ScriptRun run(
      {shell_child(
           "a",
           "trap 'echo a ends; exit 0' INT; echo a is here; ready; while :; do sleep 0.01; done"),
       shell_child("b", std::string("echo b is here; ") + kWait)});
  // A shell learns of a process after it has begun: of a, before it starts b.
  for (const char* here : {"a is here", "b is here"}) {
    REQUIRE(eventually([&] { return run.output().find(here) != std::string::npos; }));
  }
  run.signal(signal);
  CHECK(run.wait() == 128 + signal);
  CHECK_THAT(run.output(), Contains("a ends"));
  CHECK(eventually([&] { return run.leaves_nothing(); }));
}

TEST_CASE("A start script remembers that it lost what degrades the mission") {
  const auto [script, code] = GENERATE(table<std::string, int>({
      {"exit 0", kDegraded},
      {"exit 3", 3},
  }));
  auto failing = shell_child("b", "ready; exit 1");
  failing.rules.on_loss = skein::profile::LossPolicy::Degrade;
  ScriptRun run(
      {failing,
       mission_child("ready; until grep -q 'degraded, without b' $TMPDIR/output; do :; done; " +
                     script)});
  CHECK(run.wait() == code);
}

TEST_CASE("A start script sends SIGINT first, and SIGTERM to those that go on") {
  // It waits for a child, since a signal ends a wait at once. It goes by itself in the end:
  // "Processes that ignore signals" has those that are killed.
  auto child = shell_child("a",
                           "trap 'echo INT' INT; trap 'echo TERM; exit' TERM; sleep 1000 & ready; "
                           "while :; do wait; done");
  child.rules.stop_timeout = 6s;  // a shell on a busy machine is slow to obey
  ScriptRun run({child, mission_child("ready; exit 0")});
  CHECK(run.wait() == 0);
  std::string said;
  std::istringstream lines(run.output());
  for (std::string line; std::getline(lines, line);)
    if (line == "INT" || line == "TERM") said += line + " ";
  CHECK(said == "INT TERM ");
  CHECK(eventually([&] { return run.leaves_nothing(); }));
}

TEST_CASE("A start script says that it does not watch progress") {
  CHECK_THAT(start_script({"m", {mission_child("exit 0")}, {}}),
             Contains("# the mission needs and that fails ends it. Nor does it watch whether"));
}

TEST_CASE("Processes that ignore signals do not survive a start script, their children neither") {
  auto child = shell_child(
      "a",
      "trap '' INT TERM; (while :; do sleep 1000; done) & ready; while :; do sleep 1000; done");
  child.rules.stop_timeout = 1s;
  ScriptRun run({child, mission_child("ready; exit 0")});
  CHECK(run.wait() == 0);
  CHECK(eventually([&] { return run.leaves_nothing(); }));
}

TEST_CASE("Nothing survives a kill -9 of a start script") {
  ScriptRun run({shell_child("a", "(while :; do sleep 1000; done) & echo a is here; " + kWait)});
  REQUIRE(eventually([&] { return run.output().find("a is here") != std::string::npos; }));
  run.signal(SIGKILL);
  CHECK(run.wait() == 128 + SIGKILL);
  CHECK(eventually([&] { return run.leaves_nothing(); }));
}

TEST_CASE("A start script hands on every word and variable as the plan has it") {
  std::mt19937 random(skein::test::seed_of_this_run());
  const std::string alphabet = " abc'\"\\$`%!#&|;<>()[]{}*?~=\t\n-\xc3\xa4";
  const auto word = [&] {
    std::string text(random() % 12, ' ');
    for (char& c : text) c = alphabet[random() % alphabet.size()];
    return text;
  };
  ChildPlan child = mission_child("");
  child.argv = {"/bin/sh", "-c", "printf '<%s>' \"$@\" \"$VALUE\"; exit 0", "sh"};
  std::string expected;
  for (int i = 0; i < 60; ++i) {
    child.argv.push_back(word());
    expected += "<" + child.argv.back() + ">";
  }
  child.environment = {{"VALUE", word()}};
  expected += "<" + child.environment[0].second + ">";
  ScriptRun run({child});
  CHECK(run.wait() == 0);
  CHECK_THAT(run.output(), Contains(expected));
}

TEST_CASE("A start script is plain POSIX shell, in which shellcheck finds nothing") {
  auto strange = shell_child("it's $(a) \"name\"", "exit 0");
  strange.environment = {{"A", "$HOME `b` 'c'"}};
  LaunchPlan plan{"a\nmission 'of' \"them\"", {strange, mission_child(kWait)}, {"c on beta"}};
  TemporaryFolder folder;
  const std::string file = folder.write("start.sh", start_script(plan));
  CHECK(std::system(("dash -n '" + file + "'").c_str()) == 0);
  if (!found("shellcheck")) {
    WARN("not checked by shellcheck, which is not installed");
    return;
  }
  CHECK(std::system(("shellcheck --shell=sh '" + file + "'").c_str()) == 0);
}
