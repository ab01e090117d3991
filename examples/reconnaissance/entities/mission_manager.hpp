#pragma once

#include <mutex>
#include <optional>

#include "geodesy/local_frame.hpp"
#include "member.hpp"
#include "mission.idl.hpp"
#include "mission/conduct.hpp"
#include "skein/entity.hpp"
#include "skein/parameters.hpp"
#include "stream.hpp"

namespace reconnaissance {

/// Leads the mission through its phases: asks the navigator for routes, and orders the flight
/// controller to fly them.
class MissionManager : public recon::IMissionManager {
 public:
  MissionManager(skein::Entity& entity, const skein::ParameterValues& values);
  void start();

  void begin(const recon::MissionOrder& order, std::int64_t tick) override;

 private:
  void manage(Tick tick);
  void carry_out(const Conduct::Order& order, Tick tick, const recon::FlightState& state);
  recon::Route ask_route(const std::vector<Local>& through, const recon::FlightState& state);
  void tell(Tick tick);

  skein::Entity& entity_;
  std::optional<recon::INavigator::Proxy> navigator_;
  std::optional<recon::IFlightController::Proxy> controller_;
  recon::FlightLimits limits_;
  std::uint32_t route_ = 0;  // that was ordered last

  std::mutex mutex_;
  std::optional<recon::MissionOrder> order_;
  Tick begins_ = 0;

  // Of the mission that is under way; the time's thread alone uses them.
  std::optional<LocalFrame> frame_;
  std::optional<Conduct> conduct_;
  recon::Runway runway_;
  std::size_t points_ = 0;
  std::optional<recon::MissionStatus> told_;

  Stream<recon::FlightState> flight_;
  Stream<recon::MissionMode> mode_;
  skein::Publisher<recon::MissionStatus> status_;
  Member member_;
};

}  // namespace reconnaissance
