#pragma once

#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <vector>

#include "flight.idl.hpp"
#include "flight/aircraft_type.hpp"
#include "flight/pilot.hpp"
#include "geodesy/local_frame.hpp"
#include "member.hpp"
#include "skein/entity.hpp"
#include "skein/parameters.hpp"
#include "stream.hpp"
#include "traffic.idl.hpp"

namespace reconnaissance {

/// Flies the aircraft: makes one measurement of what three sets of sensors say, and commands bank,
/// climb and speed; a guidance (a CSP) leads along the legs.
class FlightController : public recon::IFlightController {
 public:
  FlightController(skein::Entity& entity, const skein::ParameterValues& values);
  void start();

  recon::FlightLimits limits() override;
  void take_off(const recon::Runway& from, std::int64_t tick) override;
  void follow(const recon::Route& route, std::int64_t tick) override;
  void loiter(const recon::Position& about, double radius_m, std::int64_t tick) override;
  void land(const recon::Route& route, const recon::Runway& to, std::int64_t tick) override;

 private:
  /// An order, and from which tick on it holds: that after the one in which it was given. So it
  /// begins to hold at the same instant of the mission, however quick its call was.
  struct Order {
    Tick from;
    std::function<std::string()> obey;
    std::uint32_t route;
  };

  void accept(std::int64_t tick, std::uint32_t route, std::function<std::string()> obey);
  void fly(Tick tick);
  void obey(Tick tick);
  const LocalFrame& frame() const { return frame_ ? *frame_ : *stand_; }
  std::optional<Pilot::Sight> look(const recon::Sensors& sensors);
  double ask_guidance(const Motion& motion, const Line& leg, double circle_radius_m);
  Demand fly_blind(const recon::Sensors& sensors) const;
  Demand avoid(Tick tick, const Demand& demand);
  void publish(Tick tick, const Demand& demand, const Pilot::Sight& sight,
               const recon::Sensors& sensors);

  skein::Entity& entity_;
  const AircraftType& type_;
  FlightRules rules_;
  std::optional<LocalFrame> frame_;  // about the first runway
  std::optional<LocalFrame> stand_;  // about where it stood before that was known
  Voter voter_;
  Pilot pilot_;
  std::optional<recon::IGuidance::Proxy> guidance_;
  std::optional<Pilot::Sight> last_sight_;
  std::uint32_t route_ = 0;

  std::mutex mutex_;
  std::vector<Order> orders_;

  bool avoiding_ = false;

  Stream<recon::Sensors> sensors_;
  Stream<recon::ResolutionAdvisory> advisories_;
  skein::Publisher<recon::FlightCommand> command_;
  skein::Publisher<recon::FlightState> state_;
  Member member_;
};

}  // namespace reconnaissance
