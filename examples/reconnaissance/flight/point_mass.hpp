#pragma once

#include "geodesy/local_frame.hpp"

namespace reconnaissance {

/// Standard gravity (ISO 80000-3).
inline constexpr double kGravity_m_s2 = 9.80665;

/// An aircraft as a point: where it is, and how it moves through the air and over ground. Angles
/// of heading are clockwise from true north, a bank to the right and a climb are positive.
struct Aircraft {
  Local position{};
  double airspeed_m_s = 0;
  double heading_rad = 0;  ///< Of its motion through the air, 0 to 2 pi.
  double climb_rad = 0;    ///< Of its motion through the air, above the horizon.
  double bank_rad = 0;
  double fuel_kg = 0;
  bool on_ground = true;
  bool stalled = false;
  double north_m_s = 0;  ///< Over ground, as are the following.
  double east_m_s = 0;
  double up_m_s = 0;
};

/// What the flight controller wants.
struct Demand {
  double bank_rad = 0;
  double climb_rad = 0;
  double airspeed_m_s = 0;
};

/// How the air moves: a wind that blows from the west has a positive `east_m_s`.
struct Wind {
  double north_m_s = 0;
  double east_m_s = 0;
  double up_m_s = 0;
};

/// What an aircraft can do. The figures are those of a medium-altitude unmanned aircraft of the
/// size of an RQ-1 (US Air Force fact sheet: 1020 kg, wing span 14.8 m, wing area 11.5 m2) with an
/// engine that is strong enough for a climb of 7 degrees at 60 m/s.
struct Airframe {
  double empty_mass_kg = 920;
  double wing_area_m2 = 11.5;
  double greatest_lift = 1.5;       ///< Lift coefficient at which the wing stalls.
  double parasitic_drag = 0.03;     ///< Drag coefficient without lift.
  double induced_drag = 0.021;      ///< Times the square of the lift coefficient: 1/(pi e A).
  double air_density_kg_m3 = 1.1;   ///< At some 1100 m in the standard atmosphere.
  double greatest_power_w = 140e3;  ///< Of the propeller, on the air.
  double greatest_thrust_n = 3500;
  double fuel_per_joule_kg =
      0.3 / 3.6e6 / 0.8;  ///< 0.3 kg/kWh, and a propeller that turns 0.8 of it.
  double never_exceed_m_s = 90;
  double greatest_bank_rad = 0.5236;       ///< 30 degrees.
  double greatest_bank_rate_rad_s = 0.35;  ///< 20 degrees a second.
  double bank_time_s = 0.5;                ///< Of the first-order answer to a demand.
  double greatest_climb_rad = 0.1222;      ///< 7 degrees, up and down.
  double climb_time_s = 1.0;
  double speed_time_s = 3.0;
  double braking_m_s2 = 3.0;  ///< On the runway, with a demand for no speed.
};

double mass_kg(const Airframe& airframe, const Aircraft& aircraft);

/// The airspeed below which the wing stalls in a turn of that bank: its lift must carry 1/cos(bank)
/// times the weight.
double stall_speed_m_s(const Airframe& airframe, double mass_kg, double bank_rad);

/// The radius of a level turn in still air, V^2 / (g tan bank).
double turn_radius_m(double airspeed_m_s, double bank_rad);

/// The aircraft `seconds` later: a point mass in coordinated flight (Beard and McLain, "Small
/// Unmanned Aircraft", 2012, chapter 9), with thrust, drag, and fuel. Demands beyond the airframe's
/// limits are cut to them. An aircraft that stalls drops its nose until it flies again; one that
/// dives beyond its never-exceed speed loses its thrust. It is carried by a plane of the height
/// `ground_m`, where it rolls, takes off once it is 1.1 times as fast as it must be and a climb is
/// demanded, and brakes where no speed is demanded. Without fuel there is no thrust.
Aircraft advance(const Airframe& airframe, const Aircraft& aircraft, const Demand& demand,
                 const Wind& wind, double ground_m, double seconds);

/// The same without forces in the air: speed, climb and bank follow the demand at once within the
/// limits of their rates, and fuel is that of level flight. Quick and predictable, for tests of
/// others.
Aircraft advance_kinematic(const Airframe& airframe, const Aircraft& aircraft, const Demand& demand,
                           const Wind& wind, double ground_m, double seconds);

}  // namespace reconnaissance
