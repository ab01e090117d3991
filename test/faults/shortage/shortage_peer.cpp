// Makes entities that call each other while the system gives this process n more threads, or n more
// descriptors, n = 0, 1, …, until that is enough; then with all that it has. Tells how often that
// ended with an error of Skein's. Anything else ends the program.
#include <dlfcn.h>
#include <fcntl.h>
#include <pthread.h>
#include <sys/resource.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstdio>
#include <memory>
#include <string>

#include "dds/port/port.hpp"
#include "entity/entity_access.hpp"
#include "lone_entity.hpp"
#include "skein/error.hpp"
#include "test/connector/echo_service.hpp"

using namespace skein;
using ::test::LouderEcho;

namespace {

constexpr int kAll = 1 << 20;
std::atomic<int> threads_left{kAll};

struct Thread {
  void* (*run)(void*);
  void* argument;
};

void* run_and_give_back(void* given) {
  const std::unique_ptr<Thread> thread(static_cast<Thread*>(given));
  void* const result = thread->run(thread->argument);
  ++threads_left;
  return result;
}

}  // namespace

/// Before the C library's, for all libraries of this program.
extern "C" int pthread_create(pthread_t* thread, const pthread_attr_t* attributes,
                              void* (*run)(void*), void* argument) {
  using Create = decltype(&pthread_create);
  static const auto create = reinterpret_cast<Create>(dlsym(RTLD_NEXT, "pthread_create"));
  if (--threads_left < 0) {
    ++threads_left;
    return EAGAIN;
  }
  return create(thread, attributes, run_and_give_back, new Thread{run, argument});
}

namespace {

/// Beside those that run now, and do not end before the next call.
void limit_threads(int count) { threads_left = count; }

void limit_descriptors(int count) {
  const int lowest = open("/dev/null", O_RDONLY | O_CLOEXEC);
  close(lowest);
  rlimit limit{};
  getrlimit(RLIMIT_NOFILE, &limit);
  limit.rlim_cur = std::min<rlim_t>(limit.rlim_max, static_cast<rlim_t>(lowest + count));
  setrlimit(RLIMIT_NOFILE, &limit);
}

void call(const std::shared_ptr<dds::Vendor>& vendor) {
  const auto server = skein::test::make_lone_entity(vendor, "server");
  server->provide<LouderEcho>(std::make_shared<skein::test::EchoService>());
  const auto client = skein::test::make_lone_entity(vendor, "client");
  dds::Qos watched;
  watched.deadline = std::chrono::seconds(10);
  const auto writer =
      EntityAccess::participant(*client).create_writer({"octets", "octets", false}, watched);
  if (client->connect<LouderEcho>().echo("x") != "x") throw Internal("another echo");
}

bool tries(const std::shared_ptr<dds::Vendor>& vendor, std::string& text) {
  try {
    call(vendor);
    return true;
  } catch (const Error& error) {
    text = error.what();
    return false;
  }
}

}  // namespace

int main(int, char** arguments) {
  const auto vendor = dds::load_vendor(arguments[1]);
  const bool threads = arguments[2] == std::string("threads");
  const auto limit = threads ? limit_threads : limit_descriptors;
  int failed = 0;
  std::string text;
  for (int n = 0;; ++n) {
    limit(n);
    const bool worked = tries(vendor, text);
    limit(kAll);
    if (worked) break;
    ++failed;
  }
  std::printf("failed %d\n", failed);
  std::printf("text %s\n", text.c_str());
  const bool works = tries(vendor, text);
  std::printf("%s\n", works ? "works" : text.c_str());
}
