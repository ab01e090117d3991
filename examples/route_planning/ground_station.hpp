#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "navigation/route_checker/height_grid.hpp"
#include "navigation/routes/route_picture.hpp"
#include "navigation/terrain/terrain.hpp"
#include "navigator_link.hpp"
#include "skein/entity.hpp"
#include "skein/parameters.hpp"

namespace route_planning {

/// Asks a navigator for routes across a terrain, past radar sites and no-fly zones: with time to
/// think, by what planners declare and by what they have shown; in a hurry; with the planner killed
/// while it plans; with threats that are out of date; and to a goal that cannot be reached.
/// Believes none of the answers before the route checker has seen them.
///
/// Parameters: `Terrain` (as a Problem names it; synthetic:7 without it), `Zones` (a GeoJSON file
/// of further no-fly zones), `Picture` (the page to write; route.html. Over a terrain that lies on
/// the earth, all routes are written as GeoJSON and the last one as a flight plan beside it),
/// `Planners` (names, separated by commas, of the planners that must know the terrain before the
/// first question), `Time limit` (the longest time that it waits for a route; 2 s).
class GroundStation {
 public:
  /// Throws InvalidArgument for a terrain or zones that cannot be read, Unavailable without a
  /// navigator or flight controller.
  GroundStation(skein::Entity& entity, const skein::ParameterValues& values);

  /// The mission; true only if every route was valid and the unreachable goal was refused as such.
  bool fly();

 private:
  void introduce();
  void brief_planners();
  void ask_with_time();
  void ask_for_what_was_shown();
  void ask_in_a_hurry();
  void ask_and_kill_the_planner();
  void ask_with_an_old_picture();
  void ask_for_the_unreachable();
  void draw();
  void write_for_others(const AE_navigator::Problem& problem);
  bool conclude();
  Answer show(const Question& question, Answer answer);
  void accept(const std::string& label, const Question& question, const Answer& answer);
  void fail(const std::string& what);
  AE_flightControllerI::FlightLimits ask_flight_limits();
  AE_navigator::Problem flyable(AE_navigator::Problem problem) const;

  skein::Entity& entity_;
  std::filesystem::path picture_;
  std::vector<std::string> planners_;
  std::chrono::milliseconds time_limit_;
  std::shared_ptr<const skein::navigation::Terrain> terrain_;
  std::string terrain_title_;
  std::vector<AE_navigator::NoFlyZone> zones_;
  skein::navigation::HeightGrid ground_;
  NavigatorLink navigator_;
  AE_flightControllerI::FlightLimits limits_;
  std::chrono::milliseconds hurry_{};
  std::vector<skein::navigation::PicturedRoute> routes_;
  std::vector<AE_navigator::MissileSite> missiles_;  // found on the way
  std::vector<std::filesystem::path> written_;
  std::vector<std::string> not_in_fence_;
  std::vector<std::string> failures_;
};

/// A page that a script inside of it (page.js) draws from a route_picture().
std::string page_of(const std::string& json);

}  // namespace route_planning
