#include "flight.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <utility>

#include "aircraft_files.hpp"
#include "failure.hpp"
#include "flight/angles.hpp"

namespace reconnaissance {
namespace {

constexpr double kFoot_m = 0.3048;
constexpr double kPound_kg = 0.45359237;
constexpr double kStep_s = JsbsimFlight::kTick_s / 2;

// Of the description. The tank; how high the centre of gravity is above the ground when it stands;
// the angle of attack at which the lift is greatest; the lift coefficient without one, and for each
// radian.
constexpr double kTank_kg = 5;
constexpr double kStanding_m = 0.332;
constexpr double kStallAngle_rad = 0.419;
constexpr double kLift = 0.28, kLiftOfAngle = 3.45;
// With which the engine burns without soot at the heights that it flies at.
constexpr double kMixture = 0.8;
// It has left the ground when it is so high above it; wheels bounce.
constexpr double kOffGround_m = 0.3;

constexpr int kTries = 3;
// JSBSim is suspended in its first step or after it, whichever was asked for later.
constexpr int kResumes = 20;

enum Value {
  kTime,
  kNorthCoarse,
  kNorthFine,
  kEastCoarse,
  kEastFine,
  kAboveGround,
  kNorth,
  kEast,
  kDown,
  kBank,
  kPitch,
  kNose,
  kRollRate,
  kPitchRate,
  kYawRate,
  kAngleOfAttack,
  kFuel,
  kWheels
};
const std::vector<std::string> kState{
    "simulation/sim-time-sec", "link/north-coarse-deg",     "link/north-fine-deg",
    "link/east-coarse-deg",    "link/east-fine-deg",        "position/h-agl-ft",
    "velocities/v-north-fps",  "velocities/v-east-fps",     "velocities/v-down-fps",
    "attitude/phi-rad",        "attitude/theta-rad",        "attitude/psi-rad",
    "velocities/p-rad_sec",    "velocities/q-rad_sec",      "velocities/r-rad_sec",
    "aero/alpha-rad",          "propulsion/total-fuel-lbs", "link/wheels-on-ground"};

/// As it flies with that speed and bank.
double angle_of_attack_rad(const Airframe& airframe, const Aircraft& aircraft) {
  const double pressure_n = 0.5 * airframe.air_density_kg_m3 * aircraft.airspeed_m_s *
                            aircraft.airspeed_m_s * airframe.wing_area_m2;
  const double lift_n = mass_kg(airframe, aircraft) * kGravity_m_s2 * std::cos(aircraft.climb_rad) /
                        std::cos(aircraft.bank_rad);
  return std::clamp((lift_n / std::max(pressure_n, 1.0) - kLift) / kLiftOfAngle, -0.1, 0.3);
}

}  // namespace

JsbsimFlight::JsbsimFlight(Options options)
    : options_(std::move(options)), frame_(options_.origin), type_(aircraft_type("tactical")) {}

void JsbsimFlight::place(const Aircraft& aircraft) {
  if (aircraft.fuel_kg > kTank_kg)
    throw JsbsimFailure(fmt::format("the tank of its aircraft holds {} kg of fuel, and not {}",
                                    kTank_kg, aircraft.fuel_kg));
  aircraft_ = aircraft;
  if (aircraft.on_ground) ground_m_ = aircraft.position.height_m;
  wind_ = {aircraft.north_m_s, aircraft.east_m_s, aircraft.up_m_s};
  const double level = aircraft.airspeed_m_s * std::cos(aircraft.climb_rad);
  wind_.north_m_s -= level * std::cos(aircraft.heading_rad);
  wind_.east_m_s -= level * std::sin(aircraft.heading_rad);
  wind_.up_m_s -= aircraft.airspeed_m_s * std::sin(aircraft.climb_rad);
  if (aircraft.on_ground) wind_ = {};
  stop();
  start();
}

Aircraft JsbsimFlight::advance(const Demand& demand, const Wind& wind, double ground_m) {
  if (!aircraft_) throw JsbsimFailure("nobody has said where the flight begins");
  wind_ = wind;
  ground_m_ = ground_m;
  std::optional<std::chrono::steady_clock::time_point> lost;
  std::string reason;
  for (int tries = 0; tries < kTries; ++tries) {
    try {
      if (!link_) start();
      aircraft_ = tick(demand);
      if (!lost) return *aircraft_;
      ++replaced_;
      const std::chrono::duration<double> took = std::chrono::steady_clock::now() - *lost;
      if (options_.tell)
        options_.tell(fmt::format("{}; another JSBSim flies on from the last state, {:.2f} s later",
                                  reason, took.count()));
      return *aircraft_;
    } catch (const JsbsimFailure& failure) {
      if (!lost) lost = std::chrono::steady_clock::now();
      reason = failure.what();
      if (process_) reason += " (" + process_->in_words() + ")";
      stop();
    }
  }
  throw JsbsimFailure(
      fmt::format("JSBSim has failed {} times in a row; at last: {}", kTries, reason));
}

void JsbsimFlight::stop() {
  link_.reset();
  process_.reset();
}

void JsbsimFlight::start() {
  const auto program = find_program(options_.program);
  if (!program)
    throw JsbsimFailure(
        fmt::format("there is no program {}; Debian has it in the package flightgear, and ./dev "
                    "test unpacks it",
                    options_.program));
  const std::uint16_t port = free_port();
  std::random_device random;
  const int key = std::uniform_int_distribution(1, 999'999)(random);
  began_ = frame_.to_geodetic(aircraft_->position);
  process_.emplace(*program, files(port, key), "run.xml");
  try {
    link_.emplace(port, options_.patience, [this] { return process_->runs(); });
    // Another program may have taken the port.
    if (link_->get({"link/key"}).front() != key) throw JsbsimFailure("another JSBSim answers");
    const double first_s = link_->get({kState[kTime]}).front();
    for (int i = 0; time_s_ = link_->get({kState[kTime]}).front(), time_s_ <= first_s; ++i) {
      if (i == kResumes) throw JsbsimFailure("JSBSim does not go on");
      link_->resume();
    }
    autopilot_.begin();
    read();
  } catch (const JsbsimFailure& failure) {
    const std::string reason = fmt::format("{} ({})", failure.what(), process_->in_words());
    stop();
    throw JsbsimFailure(reason);
  }
  process_->forget_files();
}

Aircraft JsbsimFlight::tick(const Demand& demand) {
  const Controls controls = autopilot_.fly(type_.airframe, demand, motions_, kTick_s);
  // JSBSim's elevator and rudder are positive where the nose goes down and left.
  link_->set({{"fcs/aileron-cmd-norm", controls.aileron},
              {"fcs/elevator-cmd-norm", -controls.elevator},
              {"fcs/rudder-cmd-norm", -controls.rudder},
              {"fcs/steer-cmd-norm", controls.rudder},
              {"fcs/throttle-cmd-norm", controls.throttle},
              {"fcs/left-brake-cmd-norm", controls.brakes},
              {"fcs/right-brake-cmd-norm", controls.brakes},
              {"atmosphere/wind-north-fps", wind_.north_m_s / kFoot_m},
              {"atmosphere/wind-east-fps", wind_.east_m_s / kFoot_m},
              {"atmosphere/wind-down-fps", -wind_.up_m_s / kFoot_m},
              {"position/terrain-elevation-asl-ft", ground_m_ / kFoot_m}});
  const double before_s = time_s_;
  read();
  // By six digits.
  if (std::abs(time_s_ - before_s - kTick_s) > std::max(kStep_s / 2, 1e-5 * time_s_))
    throw JsbsimFailure(fmt::format("JSBSim was to go on by {} s, and went from {} s to {} s",
                                    kTick_s, before_s, time_s_));
  return *aircraft_;
}

void JsbsimFlight::read() {
  const std::vector<double> values = link_->get(kState);
  time_s_ = values[kTime];
  see(values);
}

void JsbsimFlight::see(const std::vector<double>& values) {
  Aircraft& aircraft = *aircraft_;
  aircraft.north_m_s = values[kNorth] * kFoot_m;
  aircraft.east_m_s = values[kEast] * kFoot_m;
  aircraft.up_m_s = -values[kDown] * kFoot_m;
  const double above_m = values[kAboveGround] * kFoot_m - kStanding_m;
  aircraft.on_ground = values[kWheels] > 0 || (aircraft.on_ground && above_m < kOffGround_m);
  aircraft.position = frame_.to_local(
      {began_.latitude_deg + values[kNorthCoarse] + values[kNorthFine],
       began_.longitude_deg + values[kEastCoarse] + values[kEastFine], ground_m_ + above_m});
  if (aircraft.on_ground) aircraft.position.height_m = ground_m_;
  aircraft.fuel_kg = values[kFuel] * kPound_kg;

  // Through the air.
  const double north = aircraft.north_m_s - wind_.north_m_s;
  const double east = aircraft.east_m_s - wind_.east_m_s;
  const double up = aircraft.up_m_s - wind_.up_m_s;
  const double nose = values[kNose];
  aircraft.bank_rad = values[kBank];
  if (aircraft.on_ground) {
    aircraft.airspeed_m_s = north * std::cos(nose) + east * std::sin(nose);
    aircraft.heading_rad = course(nose);
    aircraft.climb_rad = 0;
  } else {
    aircraft.airspeed_m_s = std::hypot(north, east, up);
    aircraft.heading_rad = course(std::atan2(east, north));
    aircraft.climb_rad = std::atan2(up, std::hypot(north, east));
  }
  aircraft.stalled = !aircraft.on_ground && values[kAngleOfAttack] > kStallAngle_rad;

  motions_ = {aircraft.airspeed_m_s,
              aircraft.climb_rad,
              values[kBank],
              values[kPitch],
              nose,
              values[kRollRate],
              values[kPitchRate],
              values[kYawRate],
              std::atan2(aircraft.east_m_s, aircraft.north_m_s),
              std::hypot(aircraft.north_m_s, aircraft.east_m_s),
              aircraft.on_ground};
}

std::vector<RootFile> JsbsimFlight::files(std::uint16_t port, int key) const {
  std::vector<RootFile> files = jsbsim_aircraft_files();
  files.push_back({fmt::format("aircraft/{}/begin.xml", kJsbsimAircraft), initial_conditions()});
  // With BLOCKING_INPUT it waits in each step until it is told something.
  std::string text = fmt::format(
      "<?xml version=\"1.0\"?>\n<runscript name=\"lock-step\">\n"
      "<use aircraft=\"{}\" initialize=\"begin\"/>\n<input port=\"{}\" "
      "action=\"BLOCKING_INPUT\"/>\n"
      "<run start=\"0\" end=\"1e9\" dt=\"{}\">\n",
      kJsbsimAircraft, port, kStep_s);
  const auto set = [&](const char* name, double value) {
    text += fmt::format("<property value=\"{:.9g}\"> {} </property>\n", value, name);
  };
  set("link/key", key);
  set("propulsion/tank[0]/contents-lbs", aircraft_->fuel_kg / kPound_kg);
  set("fcs/mixture-cmd-norm", kMixture);
  set("fcs/throttle-cmd-norm", aircraft_->on_ground ? 0 : 0.7);
  set("atmosphere/wind-north-fps", wind_.north_m_s / kFoot_m);
  set("atmosphere/wind-east-fps", wind_.east_m_s / kFoot_m);
  set("atmosphere/wind-down-fps", -wind_.up_m_s / kFoot_m);
  text += "</run>\n</runscript>\n";
  files.push_back({"run.xml", text});
  return files;
}

std::string JsbsimFlight::initial_conditions() const {
  const Aircraft& aircraft = *aircraft_;
  const double pitch_rad =
      aircraft.on_ground ? 0 : aircraft.climb_rad + angle_of_attack_rad(type_.airframe, aircraft);
  return fmt::format(
      "<?xml version=\"1.0\"?>\n<initialize name=\"begin\">\n"
      "<latitude type=\"geod\" unit=\"DEG\">{:.10f}</latitude>\n"
      "<longitude unit=\"DEG\">{:.10f}</longitude>\n"
      "<elevation unit=\"M\">{:.4f}</elevation>\n<altitudeMSL unit=\"M\">{:.4f}</altitudeMSL>\n"
      "<phi unit=\"RAD\">{:.6f}</phi>\n<theta unit=\"RAD\">{:.6f}</theta>\n"
      "<psi unit=\"RAD\">{:.6f}</psi>\n<vnorth unit=\"FT/SEC\">{:.6f}</vnorth>\n"
      "<veast unit=\"FT/SEC\">{:.6f}</veast>\n<vdown unit=\"FT/SEC\">{:.6f}</vdown>\n"
      "<running>-1</running>\n</initialize>\n",
      began_.latitude_deg, began_.longitude_deg, ground_m_,
      aircraft.position.height_m + kStanding_m, aircraft.on_ground ? 0 : aircraft.bank_rad,
      pitch_rad, aircraft.heading_rad, aircraft.north_m_s / kFoot_m, aircraft.east_m_s / kFoot_m,
      -aircraft.up_m_s / kFoot_m);
}

}  // namespace reconnaissance
