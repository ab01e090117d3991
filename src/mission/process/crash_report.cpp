#include "crash_report.hpp"

#include <cxxabi.h>
#include <execinfo.h>
#include <sys/prctl.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <csignal>
#include <cstdlib>
#include <memory>
#include <string_view>

#include "mission/process/exit_codes.hpp"
#include "mission/process/ready.hpp"

namespace skein::launch {
namespace {

constexpr std::array kDeadly{SIGSEGV, SIGBUS, SIGILL, SIGFPE, SIGABRT};
std::array<struct sigaction, kDeadly.size()> before;

/// A text that a signal handler may make and read.
class PlainText {
 public:
  void clear() { size_ = 0; }
  void add(std::string_view part) {
    const std::size_t fits = std::min(part.size(), text_.size() - size_);
    std::copy_n(part.begin(), fits, text_.begin() + static_cast<std::ptrdiff_t>(size_));
    size_ += fits;
  }
  std::string_view view() const { return {text_.data(), size_}; }

 private:
  std::array<char, 512> text_{};
  std::size_t size_ = 0;
};

PlainText step;  // of the main thread

void say(std::string_view text) {
  report_waiting(text);
  PlainText line;
  line.add("skein: ");
  line.add(text);
  line.add("\n");
  [[maybe_unused]] const auto written =
      ::write(STDERR_FILENO, line.view().data(), line.view().size());
}

/// Without names for people: to make these takes memory.
void tell_stack() {
  std::array<void*, 64> frames{};
  const int count = ::backtrace(frames.data(), static_cast<int>(frames.size()));
  ::backtrace_symbols_fd(frames.data(), count, STDERR_FILENO);
}

void tell_death(int signal, siginfo_t* cause, void*) {
  PlainText text;
  text.add("dies of signal ");
  const std::array digits{static_cast<char>('0' + signal / 10),
                          static_cast<char>('0' + signal % 10)};
  text.add(std::string_view(digits.data(), digits.size()).substr(signal < 10 ? 1 : 0));
  if (::getpid() != ::gettid()) {
    std::array<char, 16> name{};
    ::prctl(PR_GET_NAME, name.data());
    text.add(" in its thread '");
    text.add(name.data());
    text.add("'");
  } else if (!step.view().empty()) {
    text.add(" while it ");
    text.add(step.view());
  }
  say(text.view());
  tell_stack();
  const auto number = std::ranges::find(kDeadly, signal) - kDeadly.begin();
  ::sigaction(signal, &before[static_cast<std::size_t>(number)], nullptr);
  if (cause->si_code <= 0) ::raise(signal);  // otherwise the same instruction fails once more
}

void tell_exit() {
  if (step.view().empty()) return;
  PlainText text;
  text.add("is ended by a call of exit() while it ");
  text.add(step.view());
  say(text.view());
  ::_exit(kStartFailed);
}

}  // namespace

StartStep::StartStep(const std::string& what) {
  step.clear();
  step.add(what);
  report_waiting(what);
}

StartStep::~StartStep() {
  step.clear();
  report_waiting("");
}

std::string with_readable_symbols(std::string_view line) {
  const auto begin = line.find("(_Z");
  const auto end = line.find('+', begin);
  if (begin == std::string_view::npos || end == std::string_view::npos) return std::string(line);
  const std::string symbol(line.substr(begin + 1, end - begin - 1));
  int status = 0;
  const std::unique_ptr<char, void (*)(void*)> name(
      abi::__cxa_demangle(symbol.c_str(), nullptr, nullptr, &status), std::free);
  if (!name) return std::string(line);
  return std::string(line.substr(0, begin + 1)).append(name.get()).append(line.substr(end));
}

void report_crashes() {
  void* frame = nullptr;
  ::backtrace(&frame, 1);  // loads what it needs, which a signal handler must not
  struct sigaction action {};
  action.sa_sigaction = tell_death;
  action.sa_flags = SA_SIGINFO | SA_ONSTACK;
  for (std::size_t i = 0; i < kDeadly.size(); ++i) ::sigaction(kDeadly[i], &action, &before[i]);
  std::atexit(tell_exit);
}

}  // namespace skein::launch
