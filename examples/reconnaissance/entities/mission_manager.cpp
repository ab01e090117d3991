#include "mission_manager.hpp"

#include "convert.hpp"
#include "skein/error.hpp"
#include "topics.hpp"

namespace reconnaissance {
namespace {

using namespace std::chrono_literals;

// Its providers have reported that they are ready.
constexpr auto kPatience = 20s;

recon::Phase phase_of(MissionPhase phase) {
  switch (phase) {
    case MissionPhase::BuiltInTest:
      return recon::Phase::BuiltInTest;
    case MissionPhase::TakeOff:
      return recon::Phase::TakeOff;
    case MissionPhase::Ingress:
      return recon::Phase::Ingress;
    case MissionPhase::Legs:
      return recon::Phase::Legs;
    case MissionPhase::Egress:
      return recon::Phase::Egress;
    case MissionPhase::Landing:
      return recon::Phase::Landing;
    case MissionPhase::Complete:
      return recon::Phase::Complete;
    case MissionPhase::Aborted:
      break;
  }
  return recon::Phase::Aborted;
}

Pilot::Mode mode_of(recon::FlightMode mode) {
  switch (mode) {
    case recon::FlightMode::Parked:
      return Pilot::Mode::Parked;
    case recon::FlightMode::TakingOff:
      return Pilot::Mode::TakingOff;
    case recon::FlightMode::Following:
      return Pilot::Mode::Following;
    case recon::FlightMode::Waiting:
      return Pilot::Mode::Waiting;
    case recon::FlightMode::Approaching:
      return Pilot::Mode::Approaching;
    case recon::FlightMode::Rolling:
      return Pilot::Mode::Rolling;
    case recon::FlightMode::Landed:
      break;
  }
  return Pilot::Mode::Landed;
}

}  // namespace

MissionManager::MissionManager(skein::Entity& entity, const skein::ParameterValues& values)
    : entity_(entity),
      flight_(entity, topic::kFlightState),
      mode_(entity, topic::kMode, skein::TopicQos::state()),
      status_(entity.publisher<recon::MissionStatus>(topic::kStatus, skein::TopicQos::state())),
      member_(entity, values, [this](Tick tick) { manage(tick); }) {}

void MissionManager::start() {
  navigator_ = entity_.connect<recon::INavigator>({.timeout = kPatience});
  controller_ = entity_.connect<recon::IFlightController>({.timeout = kPatience});
  limits_ = controller_->limits();
  member_.start();
}

void MissionManager::begin(const recon::MissionOrder& order, std::int64_t tick) {
  std::lock_guard lock(mutex_);
  if (order_) throw recon::Refused("a mission is under way already");
  order_ = order;
  begins_ = tick + 1;
}

void MissionManager::manage(Tick tick) {
  if (!conduct_) {
    std::lock_guard lock(mutex_);
    if (!order_ || tick < begins_) return;
    runway_ = order_->runway;
    points_ = order_->points.size();
    frame_.emplace(geodetic(runway_.threshold));
    conduct_.emplace(strip(*frame_, runway_), locals(*frame_, order_->points));
  }
  const auto state = flight_.at(tick);
  if (!state) return;
  const auto mode = mode_.at(tick);
  Conduct::Situation now;
  now.all_fine = mode && mode->mode == recon::Mode::Normal;
  now.mode = mode_of(state->mode);
  now.height_m = state->position.height_m;
  if (state->route == route_) {
    now.leg = state->leg;
    now.legs = state->legs;
  }
  if (const auto order = conduct_->decide(now)) carry_out(*order, tick, *state);
  tell(tick);
}

void MissionManager::carry_out(const Conduct::Order& order, Tick tick,
                               const recon::FlightState& state) {
  std::string refusal;
  try {
    if (std::holds_alternative<Conduct::TakeOff>(order)) {
      controller_->take_off(runway_, tick);
    } else if (const auto* follow = std::get_if<Conduct::Follow>(&order)) {
      controller_->follow(ask_route(follow->through, state), tick);
    } else {
      controller_->land(ask_route(std::get<Conduct::Land>(order).through, state), runway_, tick);
    }
    return;
  } catch (const recon::NoRoute& error) {
    refusal = error.reason;
  } catch (const recon::Refused& error) {
    refusal = error.reason;
  } catch (const skein::Error& error) {
    refusal = error.what();
  }
  if (const auto instead = conduct_->refused(refusal)) carry_out(*instead, tick, state);
}

recon::Route MissionManager::ask_route(const std::vector<Local>& through,
                                       const recon::FlightState& state) {
  const auto route = navigator_->plan({state.position, positions(*frame_, through), limits_});
  route_ = route.number;
  return route;
}

void MissionManager::tell(Tick tick) {
  recon::MissionStatus status{tick, phase_of(conduct_->phase()), conduct_->reason(),
                              static_cast<std::uint32_t>(conduct_->points_reached()),
                              static_cast<std::uint32_t>(points_)};
  if (told_ && told_->phase == status.phase && told_->points_reached == status.points_reached)
    return;
  told_ = status;
  status_.publish(status);
}

}  // namespace reconnaissance
