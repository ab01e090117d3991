#include "flight_models.hpp"

#include <fmt/format.h>

#include <cmath>

#include "convert.hpp"
#include "flight/aircraft_type.hpp"
#include "flight/guidance.hpp"
#include "jsbsim/failure.hpp"
#include "mission/places.hpp"

namespace reconnaissance {
namespace {

constexpr double kCarrotAhead_m = 400;

Motion motion_of(const recon::GuidanceInput& input) {
  return {input.north_m, input.east_m, input.north_m_s, input.east_m_s};
}

Line line_of(const recon::GuidanceInput& input) {
  return {{input.from_north_m, input.from_east_m, 0}, {input.to_north_m, input.to_east_m, 0}};
}

Circle circle_of(const recon::GuidanceInput& input) {
  return {{input.to_north_m, input.to_east_m, 0},
          std::abs(input.circle_radius_m),
          input.circle_radius_m > 0};
}

}  // namespace

FlightModel::FlightModel(const skein::ParameterValues& values, Advance advance)
    : advance_(advance),
      airframe_(
          aircraft_type(values.find<std::string>("Aircraft type").value_or("medium")).airframe) {}

void FlightModel::place(const recon::ModelState& state) { aircraft_ = aircraft(state); }

recon::ModelState FlightModel::advance(const recon::ModelInput& input) {
  aircraft_ = advance_(airframe_, aircraft_, {input.bank_rad, input.climb_rad, input.airspeed_m_s},
                       {input.wind_north_m_s, input.wind_east_m_s, input.wind_up_m_s},
                       input.ground_m, input.seconds);
  return model_state(aircraft_);
}

JsbsimModel::JsbsimModel(const skein::ParameterValues& values)
    : flight_({.program = values.find<std::string>("Program").value_or("JSBSim"),
               .origin = parse_runway(values.get<std::string>("Runway")).threshold,
               .tell = [](const std::string& what) { fmt::print(stderr, "{}\n", what); }}) {}

void JsbsimModel::place(const recon::ModelState& state) {
  try {
    flight_.place(aircraft(state));
  } catch (const JsbsimFailure& failure) {
    throw recon::Refused(failure.what());
  }
}

recon::ModelState JsbsimModel::advance(const recon::ModelInput& input) {
  if (std::abs(input.seconds - JsbsimFlight::kTick_s) > 1e-9)
    throw recon::Refused(fmt::format("JSBSim is stepped by {} s", JsbsimFlight::kTick_s));
  try {
    recon::ModelState state = model_state(flight_.advance(
        {input.bank_rad, input.climb_rad, input.airspeed_m_s},
        {input.wind_north_m_s, input.wind_east_m_s, input.wind_up_m_s}, input.ground_m));
    state.replaced = static_cast<std::uint32_t>(flight_.replaced());
    return state;
  } catch (const JsbsimFailure& failure) {
    throw recon::Refused(failure.what());
  }
}

double L1Guidance::bank_rad(const recon::GuidanceInput& input) {
  if (input.circle_radius_m != 0) return l1_bank_rad({}, motion_of(input), circle_of(input));
  return l1_bank_rad({}, motion_of(input), line_of(input));
}

double CarrotGuidance::bank_rad(const recon::GuidanceInput& input) {
  if (input.circle_radius_m != 0)
    return carrot_bank_rad(kCarrotAhead_m, motion_of(input), circle_of(input));
  return carrot_bank_rad(kCarrotAhead_m, motion_of(input), line_of(input));
}

}  // namespace reconnaissance
