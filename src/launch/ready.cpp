#include "skein/launch/ready.hpp"

#include <unistd.h>

#include <atomic>
#include <charconv>
#include <cstdlib>
#include <cstring>

namespace skein::launch {

void report_ready() noexcept {
  static std::atomic<bool> reported{false};
  const char* text = std::getenv(kReadyVariable);
  if (text == nullptr || reported.exchange(true)) return;
  int descriptor = -1;
  const char* end = text + std::strlen(text);
  const auto result = std::from_chars(text, end, descriptor);
  if (result.ec != std::errc() || result.ptr != end || descriptor < 3) return;
  // A launcher that is gone does not matter here: the kernel ends this process with it.
  [[maybe_unused]] const auto written = ::write(descriptor, "\n", 1);
  ::close(descriptor);
}

}  // namespace skein::launch
