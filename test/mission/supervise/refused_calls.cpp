#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <catch2/catch.hpp>
#include <cerrno>
#include <fstream>
#include <sstream>

#include "mission/process/become_program.hpp"
#include "shell_mission.hpp"
#include "skein/error.hpp"
#include "test/tools/refuse_system_call.hpp"
#include "test/tools/temporary_folder.hpp"

using namespace skein::launch;

namespace {

/// What `body` writes in a child of this process.
template <class Body>
std::string told_by_child(const Body& body) {
  TemporaryFolder folder;
  const auto file = folder.path() / "told";
  const pid_t child = ::fork();
  if (child == 0) {
    std::ofstream(file) << body();
    ::_exit(0);
  }
  ::waitpid(child, nullptr, 0);
  std::ostringstream text;
  text << std::ifstream(file).rdbuf();
  return text.str();
}

std::string end_without(long call) {
  return told_by_child([&]() -> std::string {
    skein::test::refuse_system_call(call, EPERM);
    try {
      return RecordedMission({shell_child("a", kWait)}).run().reason;
    } catch (const skein::Unavailable& error) {
      return error.what();
    }
  });
}

}  // namespace

TEST_CASE("A start for which the kernel refuses a system call says which") {
  CHECK(end_without(SYS_setpgid) ==
        "a could not be started: cannot start /bin/sh: setpgid: Operation not permitted");
  CHECK(end_without(SYS_prctl) ==
        "a could not be started: cannot start /bin/sh: prctl: Operation not permitted");
  CHECK(end_without(SYS_setsid) ==
        "the launcher cannot make its guard process: Operation not permitted");
}

TEST_CASE("Descriptors are closed one by one where they cannot be closed at once") {
  const long also_refused = GENERATE(SYS_close_range, SYS_getdents64);  // the latter: no /proc
  const auto told = told_by_child([&] {
    skein::test::refuse_system_call(SYS_close_range, ENOSYS);
    skein::test::refuse_system_call(also_refused, ENOSYS);
    const int kept = ::dup(STDIN_FILENO);
    const int closed = ::fcntl(kept, F_DUPFD, 200);
    const int on_exec = ::fcntl(kept, F_DUPFD, 100);
    close_from(150, Closing::AtOnce);
    close_from(kept + 1, Closing::OnExec);
    std::ostringstream text;
    text << ::fcntl(closed, F_GETFD) << ::fcntl(on_exec, F_GETFD) << ::fcntl(kept, F_GETFD);
    return text.str();
  });
  CHECK(told == "-110");
}
