#include "core/utc_text.hpp"

#include <array>
#include <cstdio>
#include <ctime>

namespace skein {

std::string utc_text(std::chrono::system_clock::time_point time) {
  using std::chrono::milliseconds;
  const auto part =
      std::chrono::duration_cast<milliseconds>(time.time_since_epoch()) % milliseconds(1000);
  const std::time_t whole = std::chrono::system_clock::to_time_t(time);
  std::tm utc{};
  gmtime_r(&whole, &utc);
  std::array<char, 32> date{};
  std::strftime(date.data(), date.size(), "%Y-%m-%dT%H:%M:%S", &utc);
  std::array<char, 48> text{};
  std::snprintf(text.data(), text.size(), "%s.%03dZ", date.data(), static_cast<int>(part.count()));
  return text.data();
}

}  // namespace skein
