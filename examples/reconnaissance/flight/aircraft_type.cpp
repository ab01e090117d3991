#include "aircraft_type.hpp"

#include <functional>
#include <map>
#include <string>

#include "skein/error.hpp"

namespace reconnaissance {
namespace {

AircraftType tactical() {
  AircraftType type;
  type.airframe = {.empty_mass_kg = 9.5,
                   .wing_area_m2 = 0.55,
                   .greatest_lift = 1.6,
                   .parasitic_drag = 0.03,
                   .induced_drag = 0.0232,
                   // What engine and propeller of the description do between 25 and 40 m/s.
                   .greatest_power_w = 1000,
                   .greatest_thrust_n = 40,
                   .fuel_per_joule_kg = 0.7 / 3.6e6,
                   .never_exceed_m_s = 50};
  type.rules = {.cruise_m_s = 35,
                .approach_m_s = 22,
                .greatest_climb_rad = 0.0873,
                .rotate_m_s = 21,
                .flare_height_m = 5};
  type.fuel_kg_s = 1e-4;
  return type;
}

}  // namespace

const AircraftType& aircraft_type(std::string_view name) {
  static const std::map<std::string, AircraftType, std::less<>> kTypes{
      {"medium", {.fuel_kg_s = 0.006}}, {"tactical", tactical()}};
  const auto found = kTypes.find(name);
  if (found != kTypes.end()) return found->second;
  throw skein::InvalidArgument("'" + std::string(name) +
                               "' is no aircraft; there are medium and tactical");
}

}  // namespace reconnaissance
