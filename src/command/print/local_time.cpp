#include "local_time.hpp"

#include <array>
#include <ctime>

namespace skein::command {

std::string local_time(std::uint64_t nanoseconds, const char* format) {
  const auto seconds = static_cast<std::time_t>(nanoseconds / 1'000'000'000);
  std::tm local{};
  localtime_r(&seconds, &local);
  std::array<char, 64> text{};
  return {text.data(), std::strftime(text.data(), text.size(), format, &local)};
}

}  // namespace skein::command
