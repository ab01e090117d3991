#include "skein/brokerless_discovery/process_watch.hpp"

#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <atomic>
#include <catch2/catch.hpp>
#include <memory>

#include "../tools/eventually.hpp"
#include "skein/brokerless_discovery/kill_process.hpp"

using skein::brokerless_discovery::kill_process;
using skein::brokerless_discovery::ProcessWatch;
using skein::test::eventually;

namespace {

/// A process that watches nothing, can be watched, and waits to be killed.
struct Child {
  pid_t pid;
  std::string address;

  Child() {
    int ends[2];
    REQUIRE(pipe(ends) == 0);
    pid = fork();
    if (pid == 0) {
      const ProcessWatch own;
      const ssize_t written = write(ends[1], own.address().data(), own.address().size());
      (void)written;
      close(ends[1]);
      while (true) pause();
    }
    close(ends[1]);
    char text[128];
    const ssize_t count = read(ends[0], text, sizeof text);
    close(ends[0]);
    REQUIRE(count > 0);
    address.assign(text, static_cast<std::size_t>(count));
  }
  ~Child() { end(); }

  void end() {
    if (pid == 0) return;
    kill(pid, SIGKILL);
    waitpid(pid, nullptr, 0);
    pid = 0;
  }
};

}  // namespace

TEST_CASE("the kernel tells of the end of a watched process, once") {
  Child child;
  ProcessWatch watch;
  std::atomic<int> ended = 0;
  watch.watch(child.address, [&] { ++ended; });
  watch.watch(child.address, [&] { ++ended; });
  CHECK(ended == 0);
  child.end();
  CHECK(eventually([&] { return ended == 1; }));
}

TEST_CASE("a stopped process has not ended") {
  Child child;
  ProcessWatch watch;
  std::atomic<int> ended = 0;
  kill(child.pid, SIGSTOP);
  watch.watch(child.address, [&] { ++ended; });
  kill(child.pid, SIGCONT);
  CHECK(ended == 0);
  child.end();
  CHECK(eventually([&] { return ended == 1; }));
}

TEST_CASE("a process that ended before it was watched is told at once") {
  Child child;
  child.end();
  ProcessWatch watch;
  std::atomic<int> ended = 0;
  watch.watch(child.address, [&] { ++ended; });
  CHECK(ended == 1);
}

TEST_CASE("a process is killed by its address, running or stopped, and once it is gone nobody is") {
  Child child;
  if (GENERATE(false, true)) kill(child.pid, SIGSTOP);
  CHECK(kill_process(child.address));
  int status = 0;
  REQUIRE(waitpid(child.pid, &status, 0) == child.pid);
  child.pid = 0;
  CHECK(WIFSIGNALED(status));
  CHECK(WTERMSIG(status) == SIGKILL);
  CHECK_FALSE(kill_process(child.address));
}

TEST_CASE("a process does not kill itself") {
  const ProcessWatch own;
  CHECK_FALSE(kill_process(own.address()));
}

TEST_CASE("processes of one network namespace are on one host") {
  CHECK_FALSE(ProcessWatch::host().empty());
  CHECK(ProcessWatch::host() == ProcessWatch::host());
}
