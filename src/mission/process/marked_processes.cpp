#include "marked_processes.hpp"

#include <fcntl.h>
#include <signal.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <random>

#include "core/system/file_descriptor.hpp"
#include "numbered_entries.hpp"

namespace skein::launch {
namespace {

// Who starts processes faster than they are killed is left to the next caller.
constexpr int kMostPasses = 200;
constexpr std::size_t kLongestMark = 64;
// A process in execve() shows no environment for a moment, as one that has none always does.
constexpr int kMostLooks = 20;
constexpr timespec kBetweenLooks{0, 100'000};

enum class Mark { Yes, No, Empty };

/// Reads piece by piece; the end of one piece is searched together with the next.
Mark look_for(std::string_view mark, int file) {
  std::array<char, 4096> text;
  std::size_t kept = 0;
  bool empty = true;
  while (true) {
    const auto size = ::read(file, text.data() + kept, text.size() - kept);
    if (size < 0 && errno == EINTR) continue;
    if (size <= 0) return empty ? Mark::Empty : Mark::No;
    empty = false;
    const std::size_t all = kept + static_cast<std::size_t>(size);
    if (::memmem(text.data(), all, mark.data(), mark.size()) != nullptr) return Mark::Yes;
    kept = std::min(all, mark.size() - 1);
    std::memmove(text.data(), text.data() + all - kept, kept);
  }
}

/// False for one that has ended and for threads of the kernel.
bool runs_a_program(pid_t number) {
  std::array<char, 32> path;
  std::array<char, 1> program;
  std::snprintf(path.data(), path.size(), "/proc/%d/exe", number);
  return ::readlink(path.data(), program.data(), program.size()) > 0;
}

/// The descriptor is opened before the environment is read, so that it is that process which dies,
/// and no other that has got its number meanwhile.
bool kill_if_marked(pid_t number, std::string_view mark) {
  const FileDescriptor process(static_cast<int>(::syscall(SYS_pidfd_open, number, 0)));
  if (!process) return false;
  std::array<char, 32> path;
  std::snprintf(path.data(), path.size(), "/proc/%d/environ", number);
  Mark found = Mark::Empty;
  for (int look = 0; look < kMostLooks && found == Mark::Empty; ++look) {
    if (look > 0) ::nanosleep(&kBetweenLooks, nullptr);
    const FileDescriptor environment(::open(path.data(), O_RDONLY | O_CLOEXEC));
    if (!environment) return false;
    found = look_for(mark, environment.get());
    if (found == Mark::Empty && !runs_a_program(number)) return false;
  }
  if (found != Mark::Yes) return false;
  return ::syscall(SYS_pidfd_send_signal, process.get(), SIGKILL, nullptr, 0) == 0;
}

struct Killed {
  std::array<pid_t, 1024> processes;
  std::size_t count = 0;

  void add(pid_t process) {
    const auto end = processes.begin() + count;
    if (count < processes.size() && std::find(processes.begin(), end, process) == end)
      processes[count++] = process;
  }
};

/// One look at all processes; whether there was one to kill.
bool kill_all_marked(std::string_view mark, Killed& killed) {
  bool found = false;
  for_each_number_in("/proc", [&](pid_t process, int) {
    if (process == ::getpid() || !kill_if_marked(process, mark)) return;
    killed.add(process);
    found = true;
  });
  return found;
}

}  // namespace

std::string make_mark() {
  std::random_device random;
  std::array<char, kLongestMark> text;
  std::snprintf(text.data(), text.size(), "%d-%08x%08x%08x", ::getpid(), random(), random(),
                random());
  return text.data();
}

void kill_marked_processes(std::string_view mark) noexcept {
  Killed killed;
  for (int pass = 0; pass < kMostPasses && kill_all_marked(mark, killed); ++pass) {
  }
  for (std::size_t i = 0; i < killed.count; ++i) {
    while (::waitpid(killed.processes[i], nullptr, 0) < 0 && errno == EINTR) {
    }
  }
}

}  // namespace skein::launch
