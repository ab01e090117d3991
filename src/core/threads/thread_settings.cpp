#include "core/threads/thread_settings.hpp"

#include <linux/capability.h>
#include <pthread.h>
#include <sched.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

#include "core/log.hpp"
#include "skein/error.hpp"

namespace skein {
namespace {

using Scheduling = ThreadSettings::Scheduling;

constexpr int kGreatestPriority = 99;
constexpr int kLeastNice = -20;
constexpr int kGreatestNice = 19;

void warn(const std::string& owner, const std::string& what, int error, const std::string& remedy) {
  log(LogLevel::Warning, owner, what + ": " + std::strerror(error) + "; " + remedy);
}

void demand(bool holds, const std::string& owner, const std::string& problem) {
  if (!holds) throw InvalidArgument("the threads of " + owner + ": " + problem);
}

void apply_scheduling(const ThreadSettings& settings, const std::string& owner) {
  sched_param parameters{};
  parameters.sched_priority = settings.priority;
  const bool fifo = settings.scheduling == Scheduling::Fifo;
  const int error =
      pthread_setschedparam(pthread_self(), fifo ? SCHED_FIFO : SCHED_RR, &parameters);
  if (error == 0) return;
  warn(owner,
       std::string(fifo ? "SCHED_FIFO" : "SCHED_RR") + " with priority " +
           std::to_string(settings.priority) + " was refused",
       error, "give the process CAP_SYS_NICE or raise its RLIMIT_RTPRIO; it runs without");
}

void apply_nice(int nice, const std::string& owner) {
  // On Linux a thread's own number makes this the thread's alone.
  if (setpriority(PRIO_PROCESS, static_cast<id_t>(syscall(SYS_gettid)), nice) == 0) return;
  warn(owner, "nice " + std::to_string(nice) + " was refused", errno,
       "give the process CAP_SYS_NICE or raise its RLIMIT_NICE; it runs without");
}

void apply_affinity(const std::vector<unsigned>& cpus, const std::string& owner) {
  cpu_set_t set;
  CPU_ZERO(&set);
  std::string list;
  for (const unsigned cpu : cpus) {
    CPU_SET(cpu, &set);
    list += (list.empty() ? "" : ",") + std::to_string(cpu);
  }
  const int error = pthread_setaffinity_np(pthread_self(), sizeof set, &set);
  if (error == 0) return;
  warn(owner, "running on CPU " + list + " only was refused", error,
       "they are offline or outside of the process's cpuset; it runs where the system likes");
}

// With a limit, locking would hold for now, and some later allocation would fail instead.
bool may_lock_without_limit() {
  rlimit limit{};
  if (getrlimit(RLIMIT_MEMLOCK, &limit) == 0 && limit.rlim_cur == RLIM_INFINITY) return true;
  __user_cap_header_struct header{_LINUX_CAPABILITY_VERSION_3, 0};
  __user_cap_data_struct data[_LINUX_CAPABILITY_U32S_3]{};
  if (syscall(SYS_capget, &header, data) != 0) return false;
  return (data[CAP_TO_INDEX(CAP_IPC_LOCK)].effective & CAP_TO_MASK(CAP_IPC_LOCK)) != 0;
}

}  // namespace

void check(const ThreadSettings& settings, const std::string& owner) {
  const bool real_time = settings.scheduling != Scheduling::Normal;
  const int priority = settings.priority;
  if (real_time) {
    demand(priority >= 1 && priority <= kGreatestPriority, owner,
           "priority " + std::to_string(priority) + " is not between 1 and 99");
    demand(settings.nice == 0, owner, "nice is for normal scheduling; give a priority instead");
  } else {
    demand(priority == 0, owner,
           "a priority is for fifo and round-robin scheduling; give nice instead");
    demand(settings.nice >= kLeastNice && settings.nice <= kGreatestNice, owner,
           "nice " + std::to_string(settings.nice) + " is not between -20 and 19");
  }
  demand(settings.spin.count() >= 0, owner, "a spin budget cannot be negative");
  const long present = sysconf(_SC_NPROCESSORS_CONF);
  for (const unsigned cpu : settings.cpus) {
    demand(cpu < CPU_SETSIZE && static_cast<long>(cpu) < present, owner,
           "there is no CPU " + std::to_string(cpu) + "; this machine has 0 to " +
               std::to_string(present - 1));
  }
}

void apply(const ThreadSettings& settings, const std::string& owner) {
  if (settings.scheduling != Scheduling::Normal) apply_scheduling(settings, owner);
  if (settings.nice != 0) apply_nice(settings.nice, owner);
  if (!settings.cpus.empty()) apply_affinity(settings.cpus, owner);
}

bool lock_memory() {
  const std::string remedy =
      "give the process CAP_IPC_LOCK or raise its RLIMIT_MEMLOCK to unlimited; it runs without";
  if (!may_lock_without_limit()) {
    warn("process", "memory is not locked, as only a limited amount may be", EPERM, remedy);
    return false;
  }
  if (mlockall(MCL_CURRENT | MCL_FUTURE) == 0) return true;
  warn("process", "memory could not be locked", errno, remedy);
  return false;
}

}  // namespace skein
