#include "harness/placement.hpp"

#include <sched.h>
#include <sys/resource.h>

#include <cstdlib>
#include <filesystem>

#include "skein/error.hpp"

namespace skein::benchmarks {
namespace {

cpu_set_t cores_of_this_process() {
  cpu_set_t cores;
  CPU_ZERO(&cores);
  if (sched_getaffinity(0, sizeof cores, &cores) != 0)
    throw Internal("the process's cores cannot be asked for");
  return cores;
}

// Those of the start: place_all_threads() narrows what the kernel says later.
const cpu_set_t& cores_at_the_start() {
  static const cpu_set_t cores = cores_of_this_process();
  return cores;
}

std::int64_t nanoseconds(const timeval& time) {
  return time.tv_sec * 1'000'000'000LL + time.tv_usec * 1000LL;
}

}  // namespace

std::vector<int> allowed_cores() {
  std::vector<int> cores;
  for (int core = 0; core < CPU_SETSIZE; ++core) {
    if (CPU_ISSET(core, &cores_at_the_start())) cores.push_back(core);
  }
  return cores;
}

void place_all_threads(int core) {
  cpu_set_t cores = cores_at_the_start();
  if (core >= 0) {
    CPU_ZERO(&cores);
    CPU_SET(core, &cores);
  }
  for (const auto& thread : std::filesystem::directory_iterator("/proc/self/task")) {
    const int id = std::atoi(thread.path().filename().c_str());
    if (sched_setaffinity(id, sizeof cores, &cores) != 0 &&
        std::filesystem::exists(thread.path())) {
      throw Internal("a thread cannot be put onto core " + std::to_string(core));
    }
  }
}

std::int64_t used_cpu_ns() {
  rusage used{};
  getrusage(RUSAGE_SELF, &used);
  return nanoseconds(used.ru_utime) + nanoseconds(used.ru_stime);
}

}  // namespace skein::benchmarks
