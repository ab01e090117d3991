#include "time_limits.hpp"

#include <cmath>
#include <string_view>

#include "rpc/wire/common.hpp"

namespace skein::command {

Duration duration_of(double seconds) { return Duration(std::llround(seconds * 1e9)); }

std::string at_command_line(std::string text) {
  const std::string_view remedy = rpc::kMoreTime;
  const std::size_t place = text.find(remedy);
  const std::string option = "; --within DURATION sets a longer limit";
  if (place == std::string::npos) return text + option;
  return text.replace(place, remedy.size(), option);
}

}  // namespace skein::command
