#include "flight_controller.hpp"

#include <fmt/core.h>

#include "skein/error.hpp"

namespace skein::navigation {
namespace {

void require(bool right, const char* name, double value, const char* range) {
  if (right) return;
  throw InvalidArgument(fmt::format("parameter '{}' is {}; it must be {}", name, value, range));
}

}  // namespace

FlightController::FlightController(const ParameterValues& values)
    : limits_{values.find<double>("Cruising speed").value_or(60),
              values.find<double>("Climb angle").value_or(12),
              values.find<double>("Bank angle").value_or(30),
              values.find<double>("Highest altitude").value_or(4000)} {
  const double climb = limits_.maximum_climb_angle_deg;
  const double bank = limits_.maximum_bank_angle_deg;
  require(limits_.speed_m_s > 0, "Cruising speed", limits_.speed_m_s, "greater than 0 m/s");
  require(climb > 0 && climb < 90, "Climb angle", climb, "between 0 and 90 degrees, both excluded");
  require(bank >= 0 && bank < 90, "Bank angle", bank, "from 0 to less than 90 degrees");
}

}  // namespace skein::navigation
