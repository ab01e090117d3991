#include "lookout_service.hpp"

#include <stdexcept>

#include "skein/error.hpp"

namespace skein::test {

foreign::Sighting LookoutService::look(double bearing_deg, std::uint64_t distance_m,
                                       std::int16_t& turns, std::string& remark) {
  constexpr std::int64_t kLimitM = 5000;
  if (turns < 0) throw foreign::Asleep();
  if (distance_m > kLimitM) throw foreign::OutOfSight(kLimitM, "beyond the horizon");
  ++turns;
  remark = "clear";
  return {foreign::Kind::Ship, "Anna", bearing_deg, {1, 2, 3}};
}

std::string LookoutService::echo(const std::string& text) {
  ++echoes;
  if (text == "overload") throw Overloaded("too much");
  if (text == "reject") throw InvalidArgument("not that");
  if (text == "break") throw std::runtime_error("broken");
  return text;
}

void LookoutService::remember(const std::string&) { ++remembered_; }

}  // namespace skein::test
