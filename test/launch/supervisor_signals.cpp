#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <catch2/catch.hpp>
#include <csignal>

#include "shell_mission.hpp"
#include "temporary_folder.hpp"

namespace {

/// A launcher in its own process with two children; each has a child of its own, and each of the
/// four processes has written its number into a file when this constructor returns.
class LauncherProcess {
 public:
  explicit LauncherProcess(const std::string& preamble = "") {
    folder_.write("pids", "");
    const std::string pids = (folder_.path() / "pids").string();
    const std::string script = preamble + "echo $$ >> " + pids + "; (" + preamble +
                               "while :; do sleep 1000; done) & echo $! >> " + pids +
                               "; ready; while :; do sleep 1000; done";
    id_ = ::fork();
    if (id_ == 0) {
      const int nowhere = ::open("/dev/null", O_WRONLY);
      ::dup2(nowhere, 1);
      ::dup2(nowhere, 2);
      ::execl(SKEIN_LAUNCH_HELPER, SKEIN_LAUNCH_HELPER, script.c_str(), script.c_str(), nullptr);
      ::_exit(127);
    }
    REQUIRE(wait_until([&] { return numbers_in(pids).size() == 4; }));
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
    ::waitpid(id_, &status, 0);
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

TEST_CASE("Processes that ignore SIGTERM do not survive the launcher") {
  LauncherProcess launcher("trap '' TERM; ");
  launcher.send(SIGTERM);
  const int status = launcher.wait();
  REQUIRE(WIFEXITED(status));
  CHECK(WEXITSTATUS(status) == 128 + SIGTERM);
  CHECK(launcher.all_gone());
}

TEST_CASE("Nothing survives a kill -9 of the launcher, its children's children neither") {
  LauncherProcess launcher;
  launcher.send(SIGKILL);
  CHECK(WIFSIGNALED(launcher.wait()));
  CHECK(wait_until([&] { return launcher.all_gone(); }));
}
