#include "repeated_messages.hpp"

namespace skein::dds {
namespace {

/// Further kinds are counted as one.
constexpr std::size_t kMaxKinds = 100;

}  // namespace

std::optional<std::string> RepeatedMessages::next(std::string_view text) {
  std::string_view kind = text.substr(0, text.find_first_of("0123456789"));
  std::uint64_t count = 0;
  {
    std::lock_guard lock(mutex_);
    if (!counts_.contains(kind) && counts_.size() >= kMaxKinds) kind = "";
    count = ++counts_[std::string(kind)];
  }
  if (!is_told(count)) return std::nullopt;
  if (count == 1) return std::string(text);
  return std::string(text) + " (messages like this so far: " + std::to_string(count) + ")";
}

}  // namespace skein::dds
