// Preloaded into a peer (LD_PRELOAD): counts what it does, whoever asks, C or C++.

#include <dlfcn.h>
#include <malloc.h>
#include <pthread.h>
#include <sys/epoll.h>
#include <sys/eventfd.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstdarg>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <ctime>

namespace {

struct Count {
  const char* name;
  std::atomic<std::uint64_t> value{0};

  void note() { value.fetch_add(1, std::memory_order_relaxed); }
};

Count allocations{"allocations"};
Count locks{"locks"};
Count clock_readings{"clock_readings"};
Count system_calls{"system_calls"};

// Looked up once, as looking takes locks and reads no clock.
template <class Function>
Function* real(const char* name) {
  return reinterpret_cast<Function*>(dlsym(RTLD_NEXT, name));
}

}  // namespace

extern "C" {

void* __libc_malloc(std::size_t size);
void* __libc_calloc(std::size_t number, std::size_t size);
void* __libc_realloc(void* memory, std::size_t size);
void* __libc_memalign(std::size_t alignment, std::size_t size);
int __pthread_mutex_lock(pthread_mutex_t* mutex);

/// Since the process's start, or -1 for what is not counted: `allocations` (blocks of the heap),
/// `locks` (of mutexes), `clock_readings`, and of `system_calls` those by which calls through
/// shared memory wait and wake. See harness/peer.cpp.
std::int64_t skein_benchmark_count(const char* name) {
  for (const Count* each : {&allocations, &locks, &clock_readings, &system_calls}) {
    if (std::strcmp(each->name, name) == 0) return static_cast<std::int64_t>(each->value.load());
  }
  return -1;
}

void* malloc(std::size_t size) {
  allocations.note();
  return __libc_malloc(size);
}

void* calloc(std::size_t number, std::size_t size) {
  allocations.note();
  return __libc_calloc(number, size);
}

void* realloc(void* memory, std::size_t size) {
  allocations.note();
  return __libc_realloc(memory, size);
}

void* aligned_alloc(std::size_t alignment, std::size_t size) {
  allocations.note();
  return __libc_memalign(alignment, size);
}

int posix_memalign(void** memory, std::size_t alignment, std::size_t size) {
  allocations.note();
  *memory = __libc_memalign(alignment, size);
  return *memory ? 0 : ENOMEM;
}

int pthread_mutex_lock(pthread_mutex_t* mutex) {
  locks.note();
  return __pthread_mutex_lock(mutex);
}

int clock_gettime(clockid_t clock, timespec* time) {
  static auto* const read = real<int(clockid_t, timespec*)>("clock_gettime");
  clock_readings.note();
  return read(clock, time);
}

long syscall(long number, ...) {
  static auto* const call = real<long(long, ...)>("syscall");
  system_calls.note();
  va_list given;
  va_start(given, number);
  long argument[6];
  for (long& each : argument) each = va_arg(given, long);
  va_end(given);
  return call(number, argument[0], argument[1], argument[2], argument[3], argument[4], argument[5]);
}

int eventfd_write(int descriptor, eventfd_t value) {
  static auto* const write_to = real<int(int, eventfd_t)>("eventfd_write");
  system_calls.note();
  return write_to(descriptor, value);
}

int epoll_wait(int epoll, epoll_event* events, int most, int timeout) {
  static auto* const wait = real<int(int, epoll_event*, int, int)>("epoll_wait");
  system_calls.note();
  return wait(epoll, events, most, timeout);
}
}
