#include "room_for_participant.hpp"

#include <sys/eventfd.h>
#include <sys/mman.h>

#include <cerrno>
#include <cstring>
#include <latch>
#include <string>
#include <vector>

#include "core/system/file_descriptor.hpp"
#include "core/threads/start_thread.hpp"
#include "dds/port/options_check.hpp"
#include "skein/error.hpp"

namespace skein::dds {
namespace {

// A whole entity with a service, on 127.0.0.1, was seen to take 14 descriptors and 13 threads on
// Fast DDS, 13 and 14 on Cyclone DDS, its own six threads included.
constexpr std::size_t kThreads = 10;
constexpr std::size_t kThreadsOfAddress = 3;
constexpr std::size_t kDescriptors = 16;
constexpr std::size_t kDescriptorsOfAddress = 8;
constexpr std::size_t kMemory = 32 << 20;

void require_descriptors(std::size_t count) {
  std::vector<FileDescriptor> taken;
  while (taken.size() < count) {
    taken.emplace_back(eventfd(0, EFD_CLOEXEC));
    if (taken.back()) continue;
    throw Unavailable("a participant takes up to " + std::to_string(count) +
                      " file descriptors, and this process gets " +
                      std::to_string(taken.size() - 1) + ": " + std::strerror(errno) +
                      "; close files and connections, or raise the limit (ulimit -n)");
  }
}

void require_threads(std::size_t count) {
  struct Threads {
    ~Threads() {
      over.count_down();
      for (std::thread& each : all) each.join();
    }
    std::latch over{1};
    std::vector<std::thread> all;
  } threads;
  while (threads.all.size() < count) {
    threads.all.push_back(start_thread("a participant", [&over = threads.over] { over.wait(); }));
  }
}

void require_memory() {
  void* const taken =
      mmap(nullptr, kMemory, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
  if (taken != MAP_FAILED) {
    munmap(taken, kMemory);
    return;
  }
  throw Unavailable("a participant takes up to " + std::to_string(kMemory >> 20) +
                    " MiB, and this process gets no more memory; free some, or raise the limit "
                    "(ulimit -v, or memory.max of its control group)");
}

}  // namespace

void require_room_for_participant(const ParticipantOptions& options) {
  const std::size_t addresses = interface_addresses(options.network).size();
  require_descriptors(kDescriptors + addresses * kDescriptorsOfAddress);
  require_memory();
  require_threads(kThreads + addresses * kThreadsOfAddress);
}

}  // namespace skein::dds
