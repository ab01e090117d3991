#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <catch2/catch.hpp>
#include <cerrno>
#include <csignal>
#include <functional>

#include "shell_mission.hpp"
#include "test/tools/places.hpp"
#include "test/tools/refuse_system_call.hpp"
#include "test/tools/temporary_folder.hpp"

using skein::test::built_program;
using skein::test::refuse_system_call;

namespace {

/// A launcher in its own process with two children; each has a child of its own, and one more in a
/// session of that one's own. Each of the six processes has written its number into a file when
/// this constructor returns.
class LauncherProcess {
 public:
  explicit LauncherProcess(
      const std::string& preamble = "", const char* stop_timeout_ms = "500",
      const std::function<void()>& prepare = [] {}) {
    folder_.write("pids", "");
    const std::string pids = (folder_.path() / "pids").string();
    const std::string script = preamble + "echo $$ >> " + pids + "; (" + preamble +
                               "while :; do sleep 1000; done) & echo $! >> " + pids +
                               "; setsid sh -c '" + "echo $$ >> " + pids +
                               "; while :; do sleep 1000; done' & " +
                               "ready; while :; do sleep 1000 & wait $!; done";
    const std::string helper = built_program("launch_helper");
    id_ = ::fork();
    if (id_ == 0) {
      prepare();
      const int nowhere = ::open("/dev/null", O_WRONLY);
      ::dup2(nowhere, 1);
      ::dup2(nowhere, 2);
      ::setenv("STOP_TIMEOUT_MS", stop_timeout_ms, 1);
      ::execl(helper.c_str(), helper.c_str(), script.c_str(), script.c_str(), nullptr);
      ::_exit(127);
    }
    REQUIRE(wait_until([&] { return numbers_in(pids).size() == 6; }));
    processes_ = numbers_in(pids);
  }
  ~LauncherProcess() {
    if (id_ > 0) ::kill(id_, SIGKILL);
    if (id_ > 0) ::waitpid(id_, nullptr, 0);
  }

  void send(int signal) const { ::kill(id_, signal); }

  /// Waits for the end of the launcher; its status as wait(2) tells it.
  int wait() {
    int status = 0;
    REQUIRE(wait_until([&] { return ::waitpid(id_, &status, WNOHANG) == id_; }));
    id_ = -1;
    return status;
  }

  /// Zombies count as gone: a container's init may not wait for orphans.
  bool all_gone() const {
    for (const pid_t process : processes_) {
      std::ifstream file("/proc/" + std::to_string(process) + "/stat");
      std::string text;
      std::getline(file, text);
      const auto end = text.rfind(") ");
      if (end != std::string::npos && text[end + 2] != 'Z') return false;
    }
    return true;
  }

 private:
  TemporaryFolder folder_;
  pid_t id_ = -1;
  std::vector<pid_t> processes_;
};

}  // namespace

TEST_CASE("A signal to the launcher ends the mission in order, and the exit code says which") {
  const int signal = GENERATE(SIGINT, SIGTERM, SIGHUP);
  LauncherProcess launcher;
  launcher.send(signal);
  const int status = launcher.wait();
  REQUIRE(WIFEXITED(status));
  CHECK(WEXITSTATUS(status) == 128 + signal);
  CHECK(launcher.all_gone());
}

TEST_CASE("A launcher that was started with a signal ignored, as by nohup or `&`, goes on") {
  const int signal = GENERATE(SIGHUP, SIGINT);
  LauncherProcess launcher("", "500", [&] { ::signal(signal, SIG_IGN); });
  launcher.send(signal);
  launcher.send(SIGTERM);
  const int status = launcher.wait();
  REQUIRE(WIFEXITED(status));
  CHECK(WEXITSTATUS(status) == 128 + SIGTERM);
  CHECK(launcher.all_gone());
}

TEST_CASE("A signal that comes twice at once, as from timeout(1), ends the mission in order") {
  TemporaryFolder folder;
  const std::string ended = (folder.path() / "ended").string();
  for (std::size_t run = 1; run <= 5; ++run) {
    LauncherProcess launcher(
        "trap \"trap '' TERM; sleep 0.05; echo 1 >> " + ended + "; exit 0\" INT; ", "60000");
    launcher.send(SIGTERM);
    launcher.send(SIGTERM);
    const int status = launcher.wait();
    REQUIRE(WIFEXITED(status));
    CHECK(WEXITSTATUS(status) == 128 + SIGTERM);
    CHECK(numbers_in(ended).size() == 2 * run);  // a shell's own processes ignore SIGINT
  }
}

TEST_CASE("Processes that ignore SIGINT and SIGTERM do not survive the launcher") {
  LauncherProcess launcher("trap \"\" INT TERM; ");
  launcher.send(SIGTERM);
  const int status = launcher.wait();
  REQUIRE(WIFEXITED(status));
  CHECK(WEXITSTATUS(status) == 128 + SIGTERM);
  CHECK(launcher.all_gone());
}

TEST_CASE(
    "Nothing survives a kill -9 of the launcher, its children's children neither, nor those that "
    "left for a session of their own") {
  LauncherProcess launcher;
  launcher.send(SIGKILL);
  CHECK(WIFSIGNALED(launcher.wait()));
  CHECK(wait_until([&] { return launcher.all_gone(); }));
}

TEST_CASE("A launcher ends with all of its processes where close_range is refused") {
  // By a kernel before 5.9, or by a container's filter.
  const int error = GENERATE(ENOSYS, EPERM);
  const int signal = GENERATE(SIGTERM, SIGKILL);
  CAPTURE(error, signal);
  LauncherProcess launcher("", "500", [&] { refuse_system_call(SYS_close_range, error); });
  launcher.send(signal);
  const int status = launcher.wait();
  if (signal == SIGTERM) CHECK((WIFEXITED(status) && WEXITSTATUS(status) == 128 + SIGTERM));
  CHECK(wait_until([&] { return launcher.all_gone(); }));
}
