#include "pursuit.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "convert.hpp"
#include "deciding.hpp"
#include "mission/order_check.hpp"
#include "target_csps.hpp"
#include "threat_conversion.hpp"

namespace reconnaissance {
namespace {

recon::LoiterTask loiter_task(const StandOffTask& task) {
  const Motion &target = task.target, &own = task.aircraft;
  return {target.north_m,
          target.east_m,
          target.north_m_s,
          target.east_m_s,
          task.radius_m,
          task.greatest_distance_m,
          {own.north_m, own.east_m, std::atan2(own.east_m_s, own.north_m_s)},
          task.turn_radius_m,
          weapons_of(task.weapons)};
}

StandOffTask stand_off_task(const recon::LoiterTask& told) {
  return {{told.north_m, told.east_m, told.north_m_s, told.east_m_s},
          {told.aircraft.north_m, told.aircraft.east_m, std::cos(told.aircraft.course_rad),
           std::sin(told.aircraft.course_rad)},
          told.radius_m,
          told.greatest_distance_m,
          told.turn_radius_m,
          discs_of(told.weapons)};
}

Circle ordered_circle(const recon::LoiterCircle& told) {
  return {{told.north_m, told.east_m, 0}, std::abs(told.radius_m), told.radius_m > 0};
}

}  // namespace

recon::LoiterCircle StandOff::circle(const recon::LoiterTask& task) {
  const auto circle = choose_(stand_off_task(task));
  if (!circle) throw recon::NoCircle("no circle keeps clear of weapons and has the target in view");
  return {circle->centre.north_m, circle->centre.east_m,
          circle->clockwise ? circle->radius_m : -circle->radius_m};
}

std::optional<Circle> ask_circle(skein::Entity& entity, const std::string& target,
                                 const StandOffTask& task) {
  skein::Task<recon::IStandOff, recon::LoiterCircle> wanted;
  wanted.request = "circle about " + target;
  wanted.features = {{"weapons", static_cast<double>(task.weapons.size())}};
  const recon::LoiterTask told = loiter_task(task);
  wanted.run = [&](recon::IStandOff::Proxy& csp, skein::Duration) { return csp.circle(told); };
  // Where weapons stand is no CSP's fault.
  wanted.evaluate.admitted("serves", [&](const recon::LoiterCircle& circle) {
    return flaw_of(ordered_circle(circle), task);
  });
  const auto circle = decide(entity, wanted);
  return circle ? std::optional(ordered_circle(*circle)) : std::nullopt;
}

recon::Route drawn(const Circle& circle, const LocalFrame& frame, std::uint32_t number) {
  constexpr int kCorners = 36;
  constexpr double kTurn = 2 * std::numbers::pi;
  recon::Route route{number, kCircle, {}, kTurn * circle.radius_m};
  for (int i = 0; i <= kCorners; ++i) {
    const double angle = kTurn * i / kCorners;
    route.points.push_back(position(
        frame,
        Local{circle.centre.north_m + circle.radius_m * std::cos(angle),
              circle.centre.east_m + circle.radius_m * std::sin(angle), circle.centre.height_m}));
  }
  return route;
}

double greatest_distance_m(const recon::Element& element, double height_m) {
  return greatest_distance_m(element.wanted_ground_sample_m,
                             kCamera.vertical_view_rad / kCamera.rows, height_m);
}

std::optional<std::string> contradiction_in(const recon::Element& element, double distance_m,
                                            const CruiseFigures& cruise, double endurance_s,
                                            double height_m) {
  return contradiction_in({element.name, element.task == recon::ElementTask::FollowTarget,
                           element.task == recon::ElementTask::LocateEmitter, element.wanted_s,
                           element.wanted_deviation_m, element.stand_off_m, element.margin_m,
                           element.wanted_ground_sample_m},
                          {cruise.turn_radius_m, endurance_s,
                           2 * std::max(0.0, distance_m - element.stand_off_m) / cruise.speed_m_s,
                           greatest_distance_m(element, height_m)});
}

}  // namespace reconnaissance
