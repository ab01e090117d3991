#include <sys/mman.h>

#include <catch2/catch.hpp>
#include <cstdlib>
#include <fstream>
#include <string>

#include "core/threads/thread_settings.hpp"

namespace {

long locked_kilobytes() {
  std::ifstream status("/proc/self/status");
  for (std::string line; std::getline(status, line);) {
    if (line.rfind("VmLck:", 0) == 0) return std::stol(line.substr(6));
  }
  return -1;
}

}  // namespace

TEST_CASE("locked memory shows in the process's status, what is allocated later too") {
  REQUIRE(locked_kilobytes() == 0);
  if (!skein::lock_memory()) {
    CHECK(locked_kilobytes() == 0);
    std::_Exit(77);  // the warning on the standard error says why
  }
  const long before = locked_kilobytes();
  CHECK(before > 0);
  constexpr std::size_t kSize = 16 << 20;
  const std::string later(kSize, 'x');
  CHECK(locked_kilobytes() >= before + static_cast<long>(kSize / 1024));
  munlockall();
}
