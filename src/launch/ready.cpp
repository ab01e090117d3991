#include "launch/ready.hpp"

#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <charconv>
#include <cstdlib>
#include <cstring>

namespace skein::launch {
namespace {

std::atomic<bool> reported{false};

/// The launcher's pipe; -1 where there is none.
int ready_descriptor() noexcept {
  const char* text = std::getenv(kReadyVariable);
  if (text == nullptr) return -1;
  int descriptor = -1;
  const char* end = text + std::strlen(text);
  const auto result = std::from_chars(text, end, descriptor);
  return result.ec == std::errc() && result.ptr == end && descriptor >= 3 ? descriptor : -1;
}

}  // namespace

void report_ready() noexcept {
  const int descriptor = ready_descriptor();
  if (descriptor < 0 || reported.exchange(true)) return;
  // A launcher that is gone does not matter here: the kernel ends this process with it.
  [[maybe_unused]] const auto written = ::write(descriptor, "\n", 1);
  ::close(descriptor);
}

void report_waiting(std::string_view reason) noexcept {
  const int descriptor = ready_descriptor();
  if (descriptor < 0 || reported) return;
  std::array<char, kLongestReason + 2> line;
  const auto size = std::min(reason.size(), kLongestReason);
  line[0] = '?';
  std::replace_copy(reason.begin(), reason.begin() + static_cast<std::ptrdiff_t>(size),
                    line.begin() + 1, '\n', ' ');
  line[size + 1] = '\n';
  [[maybe_unused]] const auto written = ::write(descriptor, line.data(), size + 2);
}

}  // namespace skein::launch
