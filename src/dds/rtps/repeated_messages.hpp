#pragma once

#include <cstdint>
#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>

namespace skein::dds {

/// Whether the `count`th of many like messages is told: the 1st, the 10th, the 100th …
constexpr bool is_told(std::uint64_t count) {
  while (count % 10 == 0 && count > 0) count /= 10;
  return count == 1;
}

/// Messages of a vendor that a stranger's packets, or a network that is cut, can cause without end.
/// Those that are the same up to their first digit are of one kind. Bounded; thread-safe.
class RepeatedMessages {
 public:
  /// What to log for `text`; nothing where enough was said of its kind.
  std::optional<std::string> next(std::string_view text);

 private:
  std::mutex mutex_;
  std::map<std::string, std::uint64_t, std::less<>> counts_;
};

}  // namespace skein::dds
