#include "navigation/planners/altitude_profile.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "navigation/planners/problem_rules.hpp"
#include "navigation/planners/turn_arc.hpp"
#include "navigation/terrain/ground_clearance.hpp"

namespace skein::navigation {
namespace {

constexpr double kSlack_m = 0.5;      ///< Aimed at beyond the minimum height above ground.
constexpr double kStraighten_m = 15;  ///< A point this close above the edge past it is left out.
constexpr int kRounds = 40;

class Profile {
 public:
  Profile(const PlanningScene& scene, const GroundPath& path)
      : terrain_(scene.terrain()),
        problem_(scene.problem()),
        least_m_(scene.problem().minimum_height_above_ground_m + kSlack_m),
        slope_(0.999 * climb_slope(scene.problem().limits)) {
    const double radius_m = turn_radius_m(problem_.limits);
    add(path.front(), true);
    double turned_m = 0;  // How much of the leg the turn at its begin takes.
    for (std::size_t i = 1; i < path.size(); ++i) {
      const bool last = i + 1 == path.size();
      const double to_turn_m =
          last ? 0 : radius_m * tangent_share(path[i - 1], path[i], path[i + 1]);
      const GroundPath fine = divide({path[i - 1], path[i]}, scene.grid().spacing_m());
      for (std::size_t point = 1; point + 1 < fine.size(); ++point) {
        const bool in_turn = distance_m(path[i - 1], fine[point]) < turned_m ||
                             distance_m(fine[point], path[i]) < to_turn_m;
        if (!in_turn) add(fine[point], false);
      }
      add(path[i], true);
      if (!last) add_turn(path[i - 1], path[i], path[i + 1], radius_m);
      turned_m = to_turn_m;
    }
    needed_.front() = problem_.start.altitude_m;
    needed_.back() = problem_.goal.altitude_m;
  }

  void settle() {
    for (int round = 0; round < kRounds; ++round) {
      climb_gently();
      require_ends();
      if (!lift_low_edges()) return;
    }
    throw Unflyable("the ground beside start or goal is too steep for the minimum height");
  }

  std::vector<Position> straightened() const {
    std::vector<Position> result{points_.front()};
    for (std::size_t from = 0; from + 1 < points_.size();) {
      std::size_t to = from + 1;
      while (to + 1 < points_.size() && !corner_[to] && may_skip(from, to + 1)) ++to;
      result.push_back(points_[to]);
      from = to;
    }
    return result;
  }

 private:
  /// A piece of the path whose turn flies over ground beside it.
  struct Beside {
    double from_m;  ///< Along the path.
    double to_m;
    double ground_m;  ///< The highest under that piece of the turn.
  };

  void add(const GroundPoint& point, bool is_corner) {
    along_m_.push_back(
        points_.empty() ? 0 : along_m_.back() + distance_m(on_map(points_.back()), point));
    corner_.push_back(is_corner);
    points_.push_back({point.north_m, point.east_m, 0});
    needed_.push_back(terrain_.height_m(point.north_m, point.east_m) + least_m_);
  }

  /// The aircraft flies a share of the turn while it passes the same share of the path's two
  /// tangents. The corner was added last.
  void add_turn(const GroundPoint& before, const GroundPoint& corner, const GroundPoint& after,
                double radius_m) {
    const auto level = [](const GroundPoint& point) {
      return Position{point.north_m, point.east_m, 0};
    };
    const double tangent_m = radius_m * tangent_share(before, corner, after);
    const auto arc = turn_arc(level(before), level(corner), level(after), radius_m);
    for (std::size_t i = 1; i < arc.size(); ++i) {
      const auto at_m = [&](std::size_t point) {
        const double share = static_cast<double>(point) / static_cast<double>(arc.size() - 1);
        return along_m_.back() + tangent_m * (2 * share - 1);
      };
      const double ground_m = -ground_clearance(terrain_, arc[i - 1], arc[i]).lowest_m;
      beside_.push_back({at_m(i - 1), at_m(i), ground_m});
    }
  }

  double step_m(std::size_t i) const { return along_m_[i + 1] - along_m_[i]; }

  /// Of the straight edge between two points, and of the turns at its ends as far as they replace
  /// it.
  double lowest_m(std::size_t from, std::size_t to) const {
    const Position& a = points_[from];
    const Position& b = points_[to];
    const double begin_m = along_m_[from];
    const double length_m = along_m_[to] - begin_m;
    double lowest = ground_clearance(terrain_, a, b).lowest_m;
    const auto ends_before = [](const Beside& piece, double place_m) {
      return piece.to_m <= place_m;
    };
    for (auto piece = std::lower_bound(beside_.begin(), beside_.end(), begin_m, ends_before);
         piece != beside_.end() && piece->from_m < along_m_[to]; ++piece) {
      for (const double place_m : {piece->from_m, piece->to_m}) {
        const double share = std::clamp((place_m - begin_m) / length_m, 0.0, 1.0);
        lowest = std::min(lowest, between(a, b, share).altitude_m - piece->ground_m);
      }
    }
    return lowest;
  }

  /// The lowest altitudes that satisfy every need and the climb limit both ways.
  void climb_gently() {
    const std::size_t last = points_.size() - 1;
    for (std::size_t i = 0; i <= last; ++i) points_[i].altitude_m = needed_[i];
    for (std::size_t i = 0; i < last; ++i) {
      points_[i + 1].altitude_m =
          std::max(points_[i + 1].altitude_m, points_[i].altitude_m - slope_ * step_m(i));
    }
    for (std::size_t i = last; i > 0; --i) {
      points_[i - 1].altitude_m =
          std::max(points_[i - 1].altitude_m, points_[i].altitude_m - slope_ * step_m(i - 1));
    }
  }

  void require_ends() const {
    const double over_start = points_.front().altitude_m - problem_.start.altitude_m;
    const double over_goal = points_.back().altitude_m - problem_.goal.altitude_m;
    if (over_start > 0) {
      throw Unflyable(
          fmt::format("the climb after the start would have to begin {:.0f} m higher", over_start));
    }
    if (over_goal > 0) {
      throw Unflyable(
          fmt::format("the descent to the goal would have to end {:.0f} m higher", over_goal));
    }
    for (const Position& point : points_) {
      if (point.altitude_m > problem_.limits.maximum_altitude_m) {
        throw Unflyable("the ground is too high for the maximum altitude");
      }
    }
  }

  bool lift_low_edges() {
    bool lifted = false;
    const std::size_t last = points_.size() - 1;
    for (std::size_t i = 0; i < last; ++i) {
      const double missing = least_m_ - lowest_m(i, i + 1);
      // Start and goal are where they are; the first and last edge can only be lifted at one end.
      if (missing <= kSlack_m * (i == 0 || i + 1 == last ? 0.99 : 0.5)) continue;
      lifted = true;
      if (i > 0) needed_[i] = points_[i].altitude_m + missing;
      if (i + 1 < last) needed_[i + 1] = points_[i + 1].altitude_m + missing;
    }
    return lifted;
  }

  bool may_skip(std::size_t from, std::size_t to) const {
    const Position& a = points_[from];
    const Position& b = points_[to];
    const double length = distance_m(on_map(a), on_map(b));
    for (std::size_t i = from + 1; i < to; ++i) {
      const double share = distance_m(on_map(a), on_map(points_[i])) / length;
      const double above = between(a, b, share).altitude_m - points_[i].altitude_m;
      if (above > kStraighten_m || above < -kStraighten_m) return false;
    }
    return lowest_m(from, to) >= least_m_ - kSlack_m / 2;
  }

  const Terrain& terrain_;
  const AE_navigator::Problem& problem_;
  double least_m_;
  double slope_;
  std::vector<Position> points_;
  std::vector<double> along_m_;  ///< How far along the path the points are.
  std::vector<Beside> beside_;   ///< In order.
  std::vector<bool> corner_;
  std::vector<double> needed_;
};

}  // namespace

std::vector<Position> fly_over(const PlanningScene& scene, const GroundPath& path) {
  Profile profile(scene, path);
  profile.settle();
  return profile.straightened();
}

}  // namespace skein::navigation
