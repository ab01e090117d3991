#pragma once

#include "planning/threat_discs.hpp"
#include "tour.idl.hpp"

namespace reconnaissance {

/// Plans tours: a CSP of the mission manager.
class TourPlanner : public recon::ITourPlanner {
 public:
  using Plan = CollectionTour (*)(const CollectionProblem&);

  explicit TourPlanner(Plan plan) : plan_(plan) {}
  recon::Tour plan(const recon::TourProblem& problem) override;

 private:
  Plan plan_;
};

/// As branch_and_bound_plan(), with so many steps at most that it takes a second or so.
CollectionTour bounded_search(const CollectionProblem& problem);

inline recon::RoutePose route_pose(const RoutePose& pose) {
  return {pose.north_m, pose.east_m, pose.course_rad};
}

}  // namespace reconnaissance
