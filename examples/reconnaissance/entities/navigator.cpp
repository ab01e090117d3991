#include "navigator.hpp"

#include <fmt/format.h>

#include <cmath>

#include "convert.hpp"
#include "flight/angles.hpp"
#include "skein/error.hpp"
#include "skein/head.hpp"

namespace reconnaissance {
namespace {

/// Why a route does not do what was asked for; nothing if it does.
std::optional<std::string> misses_points(const recon::RouteRequest& request,
                                         const recon::Route& route) {
  std::size_t found = 0;
  for (const recon::Position& point : route.points)
    if (found < request.through.size() && point == request.through[found]) ++found;
  if (found == request.through.size()) return std::nullopt;
  return fmt::format("it does not lead over point {} of {}", found + 1, request.through.size());
}

std::optional<std::string> climbs_too_steeply(const recon::RouteRequest& request,
                                              const recon::Route& route) {
  const LocalFrame frame(geodetic(request.from));
  for (std::size_t i = 1; i < route.points.size(); ++i) {
    const Local from = local(frame, route.points[i - 1]), to = local(frame, route.points[i]);
    const double level = std::hypot(to.north_m - from.north_m, to.east_m - from.east_m);
    const double climb = std::atan2(to.height_m - from.height_m, level);
    if (std::abs(climb) > request.limits.greatest_climb_rad)
      return fmt::format("leg {} climbs {:.1f} degrees, more than the aircraft can", i,
                         degrees(climb));
  }
  return std::nullopt;
}

}  // namespace

Navigator::Navigator(skein::Entity& entity, const skein::ParameterValues& values)
    : entity_(entity), member_(entity, values) {}

recon::Route Navigator::plan(const recon::RouteRequest& request) {
  skein::Task<recon::IRoutePlanner, recon::Route> task;
  task.request = fmt::format("route {}", routes_ + 1);
  task.features = {{"points", static_cast<double>(request.through.size())}};
  task.run = [&](recon::IRoutePlanner::Proxy& planner, skein::Duration) {
    return planner.plan(request);
  };
  task.evaluate.check("leads over all points",
                      [&](const recon::Route& route) { return misses_points(request, route); });
  task.evaluate.check("can be climbed", [&](const recon::Route& route) {
    return climbs_too_steeply(request, route);
  });
  try {
    recon::Route route = entity_.head().perform(task);
    route.number = ++routes_;
    return route;
  } catch (const skein::Error& error) {
    throw recon::NoRoute(error.what());
  }
}

recon::Route FixedLegs::plan(const recon::RouteRequest& request) {
  if (request.through.empty()) throw recon::NoRoute("there is no point to fly over");
  const LocalFrame frame(geodetic(request.from));
  recon::Route route;
  route.planner = "FixedLegs";
  route.points = {request.from};
  route.points.insert(route.points.end(), request.through.begin(), request.through.end());
  const auto points = locals(frame, route.points);
  for (std::size_t i = 1; i < points.size(); ++i) {
    route.length_m += std::hypot(points[i].north_m - points[i - 1].north_m,
                                 points[i].east_m - points[i - 1].east_m);
  }
  return route;
}

}  // namespace reconnaissance
