#pragma once

#include <unistd.h>

#include <array>
#include <catch2/catch.hpp>
#include <csignal>
#include <cstring>

namespace skein::test {

/// Says which test case a program dies in by a signal; the signal then takes its course. Catch2's
/// own handler allocates, and so waits for ever where a process dies within malloc.
class DyingTest : public Catch::TestEventListenerBase {
 public:
  using Catch::TestEventListenerBase::TestEventListenerBase;

  void testRunStarting(const Catch::TestRunInfo&) override {
    struct sigaction action {};
    action.sa_sigaction = tell;
    action.sa_flags = SA_SIGINFO;
    for (const int signal : kSignals) sigaction(signal, &action, &before(signal));
  }
  void testCaseStarting(const Catch::TestCaseInfo& test) override {
    strncpy(name().data(), test.name.c_str(), name().size() - 1);
  }
  void testCaseEnded(const Catch::TestCaseStats&) override { name()[0] = 0; }

 private:
  static constexpr int kSignals[] = {SIGABRT, SIGBUS, SIGFPE, SIGILL, SIGSEGV};

  static struct sigaction& before(int signal) {
    static std::array<struct sigaction, NSIG> all;
    return all[static_cast<std::size_t>(signal)];
  }
  static std::array<char, 256>& name() {
    static std::array<char, 256> name;
    return name;
  }
  static void say(const char* text) {
    [[maybe_unused]] const auto written = write(STDERR_FILENO, text, std::strlen(text));
  }

  static void tell(int signal, siginfo_t* info, void*) {
    say("died by a signal in: ");
    say(name().data());
    say("\n");
    sigaction(signal, &before(signal), nullptr);
    if (info->si_code <= 0) raise(signal);  // was sent; otherwise the instruction is repeated
  }
};

CATCH_REGISTER_LISTENER(DyingTest)

}  // namespace skein::test
