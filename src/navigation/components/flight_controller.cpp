#include "flight_controller.hpp"

#include <fmt/core.h>

#include "skein/error.hpp"
#include "values.hpp"

namespace skein::navigation {
namespace {

void require(bool right, const char* name, double value, const char* range) {
  if (right) return;
  throw InvalidArgument(fmt::format("parameter '{}' is {}; it must be {}", name, value, range));
}

}  // namespace

FlightController::FlightController(const ParameterValues& values)
    : limits_{number_of(values, "Cruising speed", 60), number_of(values, "Climb angle", 12),
              number_of(values, "Bank angle", 30), number_of(values, "Highest altitude", 4000)} {
  const double climb = limits_.maximum_climb_angle_deg;
  const double bank = limits_.maximum_bank_angle_deg;
  require(limits_.speed_m_s > 0, "Cruising speed", limits_.speed_m_s, "greater than 0 m/s");
  require(climb > 0 && climb < 90, "Climb angle", climb, "between 0 and 90 degrees, both excluded");
  require(bank >= 0 && bank < 90, "Bank angle", bank, "from 0 to less than 90 degrees");
}

}  // namespace skein::navigation
