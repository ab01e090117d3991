#pragma once

#include <vector>

#include "clock/ticks.hpp"
#include "flight.idl.hpp"
#include "flight/guidance.hpp"
#include "flight/pilot.hpp"
#include "flight/point_mass.hpp"
#include "geodesy/hills.hpp"
#include "geodesy/local_frame.hpp"
#include "mission/places.hpp"
#include "skein/parameters.hpp"

namespace reconnaissance {

inline Geodetic geodetic(const recon::Position& position) {
  return {position.latitude_deg, position.longitude_deg, position.height_m};
}

inline recon::Position position(const Geodetic& place) {
  return {place.latitude_deg, place.longitude_deg, place.height_m};
}

inline recon::Position position(const LocalFrame& frame, const Local& local) {
  return position(frame.to_geodetic(local));
}

inline Local local(const LocalFrame& frame, const recon::Position& position) {
  return frame.to_local(geodetic(position));
}

inline std::vector<Local> locals(const LocalFrame& frame,
                                 const std::vector<recon::Position>& positions) {
  std::vector<Local> result;
  for (const recon::Position& each : positions) result.push_back(local(frame, each));
  return result;
}

/// The ground that a profile names by `Runway` and `Hills`, about the runway's threshold.
inline Hills ground_of(const skein::ParameterValues& values) {
  const RunwayText runway = parse_runway(values.get<std::string>("Runway"));
  return Hills(runway.threshold.height_m, values.find<std::uint64_t>("Hills").value_or(0));
}

/// Seconds of the mission.
inline double seconds_of(Tick tick) { return std::chrono::duration<double>(time_of(tick)).count(); }

inline recon::Runway runway(const RunwayText& text) {
  return {position(text.threshold), text.course_rad, text.length_m};
}

inline Strip strip(const LocalFrame& frame, const recon::Runway& runway) {
  return {local(frame, runway.threshold), runway.course_rad, runway.length_m};
}

inline recon::ModelState model_state(const Aircraft& aircraft) {
  return {aircraft.position.north_m,
          aircraft.position.east_m,
          aircraft.position.height_m,
          aircraft.airspeed_m_s,
          aircraft.heading_rad,
          aircraft.climb_rad,
          aircraft.bank_rad,
          aircraft.fuel_kg,
          aircraft.on_ground,
          aircraft.stalled,
          aircraft.north_m_s,
          aircraft.east_m_s,
          aircraft.up_m_s};
}

inline Aircraft aircraft(const recon::ModelState& state) {
  return {{state.north_m, state.east_m, state.height_m},
          state.airspeed_m_s,
          state.heading_rad,
          state.climb_rad,
          state.bank_rad,
          state.fuel_kg,
          state.on_ground,
          state.stalled,
          state.north_m_s,
          state.east_m_s,
          state.up_m_s};
}

}  // namespace reconnaissance
