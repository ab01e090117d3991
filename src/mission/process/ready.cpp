#include "mission/process/ready.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <charconv>
#include <cstdlib>
#include <cstring>

#include "core/system/held_signal.hpp"

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

// A launcher that is gone does not matter here: the kernel ends this process with it. One that is
// stopped does not read, and must not stop this process, too.
void write_text(int descriptor, std::string_view text) noexcept {
  ::fcntl(descriptor, F_SETFL, ::fcntl(descriptor, F_GETFL) | O_NONBLOCK);
  const HeldSignal held(SIGPIPE);
  [[maybe_unused]] const auto written = ::write(descriptor, text.data(), text.size());
}

}  // namespace

void report_ready() noexcept {
  const int descriptor = ready_descriptor();
  if (reported.exchange(true) || descriptor < 0) return;
  ::fcntl(descriptor, F_SETFD, FD_CLOEXEC);  // what this process starts cannot speak for it
  write_text(descriptor, "\n");
}

void report_progress() noexcept {
  if (!reported) return;
  const int descriptor = ready_descriptor();
  if (descriptor >= 0) write_text(descriptor, "\n");
}

void report_waiting(std::string_view reason) noexcept {
  const int descriptor = ready_descriptor();
  if (descriptor < 0) return;
  std::array<char, kLongestReason + 2> line;
  line.front() = '?';
  auto end = std::replace_copy(
      reason.begin(),
      reason.begin() + static_cast<std::ptrdiff_t>(std::min(reason.size(), kLongestReason)),
      line.begin() + 1, '\n', ' ');
  *end++ = '\n';
  write_text(descriptor, {line.data(), static_cast<std::size_t>(end - line.begin())});
}

}  // namespace skein::launch
