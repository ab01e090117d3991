#include "core/thread_stack.hpp"

#include <cxxabi.h>
#include <dlfcn.h>
#include <execinfo.h>
#include <semaphore.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cerrno>
#include <charconv>
#include <csignal>
#include <cstdint>
#include <cstdlib>
#include <ctime>
#include <iterator>
#include <memory>
#include <mutex>

namespace skein {
namespace {

constexpr long kPatienceNs = 100'000'000;
constexpr std::size_t kLongestName = 100;
/// Those of the handler itself, and of the kernel's way into it.
constexpr int kOwnFrames = 2;

pid_t this_thread() { return static_cast<pid_t>(syscall(SYS_gettid)); }

/// What the handler, which must neither wait nor allocate, and its asker share.
struct Exchange {
  Exchange() { sem_init(&answered, 0, 0); }

  /// False where no answer came in time.
  bool await_answer() {
    timespec until{};
    clock_gettime(CLOCK_MONOTONIC, &until);
    until.tv_nsec += kPatienceNs;
    until.tv_sec += until.tv_nsec / 1'000'000'000;
    until.tv_nsec %= 1'000'000'000;
    int result = -1;
    do {
      result = sem_clockwait(&answered, CLOCK_MONOTONIC, &until);
    } while (result != 0 && errno == EINTR);
    return result == 0;
  }

  std::atomic<pid_t> asked{0};  // who has not begun to answer
  std::array<void*, 32> frames{};
  std::atomic<int> count{0};
  sem_t answered{};
};

Exchange& exchange() {
  static auto& exchange = *new Exchange;  // never destroyed: a signal may come late
  return exchange;
}

void answer(int, siginfo_t*, void*) {
  const int error = errno;
  Exchange& with = exchange();
  pid_t me = this_thread();
  if (with.asked.compare_exchange_strong(me, 0)) {
    with.count = backtrace(with.frames.data(), static_cast<int>(with.frames.size()));
    sem_post(&with.answered);
  }
  errno = error;
}

/// The signal, whose handler is set; 0 where all have one.
int set_handler() {
  // The first call of backtrace() loads a library, and allocates.
  void* frame = nullptr;
  backtrace(&frame, 1);
  exchange();
  for (int signal = SIGRTMAX; signal >= SIGRTMIN; --signal) {
    struct sigaction known {};
    if (sigaction(signal, nullptr, &known) != 0 || known.sa_handler != SIG_DFL) continue;
    struct sigaction ours {};
    ours.sa_sigaction = answer;
    ours.sa_flags = SA_SIGINFO | SA_RESTART;
    sigfillset(&ours.sa_mask);
    if (sigaction(signal, &ours, nullptr) == 0) return signal;
  }
  return 0;
}

std::string readable(const char* symbol) {
  if (symbol == nullptr) return "?";
  int status = 0;
  const std::unique_ptr<char, void (*)(void*)> name(
      abi::__cxa_demangle(symbol, nullptr, nullptr, &status), std::free);
  return std::string(status == 0 ? name.get() : symbol).substr(0, kLongestName);
}

std::string hexadecimal(std::uintptr_t number) {
  char digits[2 * sizeof number];
  return "0x" + std::string(digits, std::to_chars(digits, std::end(digits), number, 16).ptr);
}

/// `address` is where the call stands, or one byte behind its beginning.
std::string described(std::uintptr_t address) {
  Dl_info found{};
  if (dladdr(reinterpret_cast<const void*>(address), &found) == 0) return hexadecimal(address);
  const std::string path = found.dli_fname;
  return readable(found.dli_sname) + " (" + path.substr(path.rfind('/') + 1) + "+" +
         hexadecimal(address - reinterpret_cast<std::uintptr_t>(found.dli_fbase)) + ")";
}

}  // namespace

std::vector<std::string> stack_of(pid_t thread) {
  static std::mutex mutex;
  const std::lock_guard one_at_a_time(mutex);
  static const int signal = set_handler();
  static bool lost = false;  // one began to answer, and did not end
  if (signal == 0 || lost) return {};
  Exchange& with = exchange();
  with.asked = thread;
  const bool sent = syscall(SYS_tgkill, getpid(), thread, signal) == 0;
  if (!sent || !with.await_answer()) {
    if (with.asked.exchange(0) == thread) return {};
    lost = !with.await_answer();
    if (lost) return {};
  }
  std::vector<std::string> functions;
  for (int i = kOwnFrames; i < with.count; ++i) {
    // A return address may stand behind its function's end.
    const auto frame = reinterpret_cast<std::uintptr_t>(with.frames[static_cast<std::size_t>(i)]);
    functions.push_back(described(i == kOwnFrames ? frame : frame - 1));
  }
  return functions;
}

}  // namespace skein
