#include "core/threads/stall_watch.hpp"

#include <sys/syscall.h>
#include <unistd.h>

#include <utility>
#include <vector>

#include "core/log.hpp"

namespace skein {
namespace {

void tell_of_stall(const std::string& name, pid_t thread) {
  log(LogLevel::Warning, "watchdog",
      "'" + name + "' has been in one piece of work for over 1 s, and others wait: `gdb -p " +
          std::to_string(thread) + " -batch -ex bt` shows where");
}

}  // namespace

WatchedThread::WatchedThread(std::string name)
    : WatchedThread(std::move(name), StallWatch::of_this_process()) {}

WatchedThread::WatchedThread(std::string name, StallWatch& watch)
    : name_(std::move(name)), thread_(static_cast<pid_t>(syscall(SYS_gettid))), watch_(watch) {
  std::lock_guard lock(watch_.mutex_);
  watch_.threads_.try_emplace(this);
}

WatchedThread::~WatchedThread() {
  std::lock_guard lock(watch_.mutex_);
  watch_.threads_.erase(this);
}

StallWatch::StallWatch(Tell tell) : tell_(std::move(tell)) {}

StallWatch& StallWatch::of_this_process() {
  static auto& watch = *new StallWatch(tell_of_stall);  // never destroyed: threads may outlive main
  return watch;
}

std::chrono::milliseconds StallWatch::look(Instant now) {
  std::vector<Stalled> stalled;
  const auto until_next = look(now, stalled);
  for (const auto& [name, thread] : stalled) tell_(name, thread);
  return until_next;
}

std::chrono::milliseconds StallWatch::look(Instant now, std::vector<Stalled>& stalled) {
  const std::lock_guard lock(mutex_);
  if (now < last_ + kPeriod)
    return std::chrono::ceil<std::chrono::milliseconds>(last_ + kPeriod - now);
  // Where it comes late, this process did not run meanwhile, or not well.
  const bool anew = now > last_ + 2 * kPeriod;
  last_ = now;
  for (auto& [thread, seen] : threads_) {
    if (has_stalled(*thread, seen, anew)) stalled.push_back({thread->name_, thread->thread_});
  }
  return kPeriod;
}

/// True once, of one that is to be told of.
bool StallWatch::has_stalled(const WatchedThread& thread, Seen& seen, bool anew) {
  const std::uint64_t steps = thread.steps_.load(std::memory_order_relaxed);
  const bool within_a_piece = steps % 2 == 1;
  const bool same = std::exchange(seen.steps, steps) == steps && within_a_piece;
  if (seen.quiet > 0) --seen.quiet;
  seen.looks = same && !anew ? seen.looks + 1 : 0;
  if (seen.looks != kLooks || seen.quiet > 0) return false;
  seen.quiet = kQuietLooks;
  return true;
}

}  // namespace skein
