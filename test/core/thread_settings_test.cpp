#include "core/threads/thread_settings.hpp"

#include <pthread.h>
#include <sched.h>
#include <sys/resource.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <catch2/catch.hpp>
#include <future>

#include "skein/error.hpp"
#include "skein/executor.hpp"
#include "test/tools/eventually.hpp"
#include "test/tools/log.hpp"

using namespace skein;
using skein::test::Log;
using namespace std::chrono_literals;
using Scheduling = ThreadSettings::Scheduling;

namespace {

/// How the system runs the thread that reads it.
struct Seen {
  int policy = -1;
  int priority = -1;
  int nice = -1;
  std::vector<unsigned> cpus;

  static Seen here() {
    Seen seen;
    sched_param parameters{};
    pthread_getschedparam(pthread_self(), &seen.policy, &parameters);
    seen.priority = parameters.sched_priority;
    seen.nice = getpriority(PRIO_PROCESS, static_cast<id_t>(syscall(SYS_gettid)));
    cpu_set_t set;
    sched_getaffinity(0, sizeof set, &set);
    for (unsigned cpu = 0; cpu < CPU_SETSIZE; ++cpu) {
      if (CPU_ISSET(cpu, &set)) seen.cpus.push_back(cpu);
    }
    return seen;
  }
};

Seen seen_by_thread_with(const ThreadSettings& settings) {
  ThreadExecutor executor("settings", 1, 8, settings);
  std::promise<Seen> seen;
  executor.post([&] { seen.set_value(Seen::here()); });
  return seen.get_future().get();
}

/// Either the thread runs as asked, or the log says why not and what to do.
void check_obeyed_or_explained(bool obeyed, const Log& log, const std::string& what) {
  if (obeyed) {
    CHECK(log.text() == "");
  } else {
    WARN("refused on this machine: " + log.text());
    CHECK_THAT(log.text(), Catch::Contains(what) && Catch::Contains("CAP_SYS_NICE"));
  }
}

}  // namespace

TEST_CASE("an executor's thread runs with the real-time policy and priority that it was given") {
  const auto scheduling = GENERATE(Scheduling::Fifo, Scheduling::RoundRobin);
  const int policy = scheduling == Scheduling::Fifo ? SCHED_FIFO : SCHED_RR;
  Log log;
  const Seen seen = seen_by_thread_with({.scheduling = scheduling, .priority = 7});
  check_obeyed_or_explained(seen.policy == policy && seen.priority == 7, log, "priority 7");
}

TEST_CASE("an executor's thread is as nice as it was told, and the others are not") {
  Log log;
  const int before = Seen::here().nice;
  const int wanted = std::min(before + 3, 19);
  const Seen seen = seen_by_thread_with({.nice = wanted});
  check_obeyed_or_explained(seen.nice == wanted, log, "nice");
  CHECK(Seen::here().nice == before);
}

TEST_CASE("an executor's thread stays on its CPUs") {
  const auto allowed = Seen::here().cpus;
  for (const unsigned cpu : allowed) {
    CHECK(seen_by_thread_with({.cpus = {cpu}}).cpus == std::vector<unsigned>{cpu});
  }
}

TEST_CASE("settings that can never work are refused at the start, with the reason") {
  const auto refused = [](const ThreadSettings& settings, const std::string& why) {
    CHECK_THROWS_AS(ThreadExecutor("planner", 1, 8, settings), InvalidArgument);
    CHECK_THROWS_WITH(ThreadExecutor("planner", 1, 8, settings),
                      Catch::Contains("planner") && Catch::Contains(why));
  };
  refused({.cpus = {1000}}, "there is no CPU 1000");
  refused({.cpus = {4000}}, "there is no CPU 4000");
  refused({.scheduling = Scheduling::Fifo}, "priority 0 is not between 1 and 99");
  refused({.scheduling = Scheduling::Fifo, .priority = 100}, "priority 100");
  refused({.scheduling = Scheduling::RoundRobin, .priority = 1, .nice = 1}, "give a priority");
  refused({.priority = 3}, "give nice instead");
  refused({.nice = 20}, "nice 20");
  refused({.spin = -1us}, "spin");
}

TEST_CASE("a thread that looks for work before it sleeps runs every task, and ends") {
  const auto spin = GENERATE(1us, 1'000'000us);
  ThreadExecutor executor("spinning", 2, 1024, {.spin = spin});
  std::atomic<int> ran = 0;
  for (int i = 0; i < 500; ++i) {
    REQUIRE(executor.post([&] { ++ran; }));
    if (i % 7 == 0) std::this_thread::yield();
  }
  CHECK(skein::test::eventually([&] { return ran == 500; }));
  executor.stop();
}
