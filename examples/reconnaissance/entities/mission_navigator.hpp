#pragma once

#include <atomic>
#include <optional>
#include <string>
#include <vector>

#include "geodesy/hills.hpp"
#include "geodesy/local_frame.hpp"
#include "geodesy/tile.hpp"
#include "member.hpp"
#include "mission.idl.hpp"
#include "mission/places.hpp"
#include "navigator.idl.hpp"
#include "skein/entity.hpp"
#include "skein/parameters.hpp"
#include "stream.hpp"
#include "threats.idl.hpp"

namespace reconnaissance {

/// Plans routes around what the threat picture shows. Holds no planner itself: its CSPs plan, and
/// its Head chooses among them and checks what they make.
class Navigator : public recon::INavigator {
 public:
  Navigator(skein::Entity& entity, const skein::ParameterValues& values);
  ~Navigator();
  void start() { member_.start(); }

  recon::Route plan(const recon::RouteRequest& request) override;

 private:
  recon::Route make_route(const recon::RouteRequest& request);
  AE_navigator::Problem problem_of(const recon::RouteRequest& request);
  void pose(AE_navigator::Problem& problem, const recon::Position& from,
            const recon::Position& to) const;
  void signal_planner(int signal) const;
  AE_navigator::Route ask_planner(const AE_navigator::Problem& problem, double least_survival);
  std::vector<Local> way_in_tile(const std::vector<Local>& way) const;
  void lift(recon::Position& point) const;
  std::optional<std::string> lack_of_height(const std::vector<Local>& way) const;
  std::vector<Local> onto_course(const AE_navigator::Problem& problem,
                                 const std::vector<Local>& way, double begin_course_rad,
                                 double end_course_rad, double radius_m) const;

  skein::Entity& entity_;
  LocalFrame frame_;
  Hills ground_;
  Tile tile_;
  std::string terrain_;
  std::vector<PlannerFailureText> failures_;
  std::uint32_t asked_ = 0;  // requests for ways so far
  std::string instead_;      // who is asked for the rest of a route, after one whose planner failed
  std::atomic<std::uint32_t> routes_{0};
  double least_clearance_m_ = 0;  // of the route that is made

  Stream<recon::ThreatPicture> threats_;
  Member member_;
};

/// Straight ahead, whatever is there: the navigator's CSP for want of a better one.
class StraightAhead : public AE_navigator::IPlanner {
 public:
  AE_navigator::Route plan(const AE_navigator::Problem& problem) override;
};

}  // namespace reconnaissance
