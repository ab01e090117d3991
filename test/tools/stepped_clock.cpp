#include "stepped_clock.hpp"

#include <dlfcn.h>
#include <pthread.h>
#include <time.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <cstdint>

namespace {

constexpr std::int64_t kSecond = 1'000'000'000;
/// How soon a thread that waits notices a step.
constexpr std::int64_t kSlice = kSecond / 100;

std::atomic<std::int64_t> ahead{0};  // of the machine's clock

template <class Function>
Function next_of(const char* name) {
  return reinterpret_cast<Function>(dlsym(RTLD_NEXT, name));
}

int machine_gettime(clockid_t clock, timespec* time) {
  static const auto next = next_of<decltype(&clock_gettime)>("clock_gettime");
  return next(clock, time);
}

int machine_timedwait(pthread_cond_t* condition, pthread_mutex_t* mutex, const timespec* until) {
  static const auto next = next_of<decltype(&pthread_cond_timedwait)>("pthread_cond_timedwait");
  return next(condition, mutex, until);
}

std::int64_t to_nanoseconds(const timespec& time) { return time.tv_sec * kSecond + time.tv_nsec; }
timespec to_timespec(std::int64_t time) { return {time / kSecond, time % kSecond}; }

std::int64_t machine_now() {
  timespec now{};
  machine_gettime(CLOCK_REALTIME, &now);
  return to_nanoseconds(now);
}

}  // namespace

extern "C" int clock_gettime(clockid_t clock, timespec* time) {
  const int result = machine_gettime(clock, time);
  if (result == 0 && clock == CLOCK_REALTIME) *time = to_timespec(to_nanoseconds(*time) + ahead);
  return result;
}

extern "C" int pthread_cond_timedwait(pthread_cond_t* condition, pthread_mutex_t* mutex,
                                      const timespec* until) {
  const std::int64_t end = to_nanoseconds(*until);
  // Then the condition is of the steady clock, which counts from the machine's start.
  if (end < machine_now() / 2) return machine_timedwait(condition, mutex, until);
  for (;;) {
    const std::int64_t now = machine_now();
    const timespec slice = to_timespec(std::min(end - ahead, now + kSlice));
    const int result = machine_timedwait(condition, mutex, &slice);
    if (result != ETIMEDOUT || machine_now() + ahead >= end) return result;
  }
}

namespace skein::test {

void step_wall_clock(std::chrono::seconds step) { ahead += step.count() * kSecond; }

}  // namespace skein::test
