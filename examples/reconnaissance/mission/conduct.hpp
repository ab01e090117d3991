#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "flight/pilot.hpp"

namespace reconnaissance {

enum class MissionPhase {
  BuiltInTest,
  TakeOff,
  Ingress,
  Collection,
  Egress,
  Landing,
  Complete,
  Aborted
};

/// A point to be flown over; straight: led to in a straight line from the point before.
struct WayPoint {
  Local place{};
  bool straight = false;
};

/// How the last part of a mission is flown: down to the runway along its extended centre line.
struct ApproachRules {
  double slope_rad = 0.0698;  ///< 4 degrees.
  double final_m = 4000;      ///< Where the slope begins, before the threshold.
  double intercept_m = 8000;  ///< Where the centre line is joined, before the threshold.
  double aim_m = 150;         ///< Where the slope ends, beyond the threshold.
};

/// The points that lead down to a strip, the last one the aiming point on it.
std::vector<WayPoint> approach(const Strip& strip, const ApproachRules& rules);

/// Conducts a mission through its phases: test, take-off, to the first point of a tour, over the
/// other ones, back, landing. The tour may be another one at any time. A pure object: it is told
/// what is so, and says what is to be ordered.
class Conduct {
 public:
  /// What it wants done. A route begins where the aircraft is.
  struct TakeOff {};
  struct Follow {
    std::vector<WayPoint> through;
  };
  struct Loiter {
    Circle circle;  ///< At the height of its centre.
  };
  struct Land {
    std::vector<WayPoint> through;
  };
  using Order = std::variant<TakeOff, Follow, Loiter, Land>;

  /// What is so.
  struct Situation {
    bool all_fine = false;  ///< The built-in tests are passed.
    Pilot::Mode mode{};
    double height_m = 0;      ///< Above the geoid.
    std::size_t leg = 0;      ///< Of the route that was ordered last; 0 until it is flown.
    std::size_t legs = 0;     ///< 0 until it is flown.
    std::size_t reached = 0;  ///< Points of the order that the route has led over so far.
  };

  explicit Conduct(const Strip& strip, const ApproachRules& rules = {})
      : strip_(strip), rules_(rules) {}

  /// What is flown from now on, in place of what was: at once, where that is under way, or where it
  /// may try again; an empty one leads home.
  std::optional<Order> fly(std::vector<WayPoint> tour, const std::string& reason);

  /// A circle is flown until something else is, in place of what is left of the tour, or of a way
  /// home that may yet become another tour.
  std::optional<Order> loiter(const Circle& circle, const std::string& reason);

  /// What is left of the tour is given up, if it is under way; before the take-off all is.
  std::optional<Order> give_up(const std::string& reason);

  /// As give_up(), for as long as the executive wants it: then another tour may be given to it.
  std::optional<Order> call_back(const std::string& reason);

  /// A circle is flown until there is another tour, if it flies home for want of one.
  std::optional<Order> wait(const Circle& circle, const std::string& reason);

  /// It flies home, if that is under way, and takes no other tour.
  std::optional<Order> go_home_for_good(const std::string& reason);

  /// The way home is to be planned anew, if it is under way and the aircraft does not yet descend.
  std::optional<Order> go_home_another_way(const std::string& reason);

  /// The order that is to be given now, if any. Its phase begins with it.
  std::optional<Order> decide(const Situation& situation);

  /// The mission ends in flight, whatever is under way.
  void abort(const std::string& reason) { enter(MissionPhase::Aborted, reason); }

  /// What was ordered cannot be done: the mission goes home, where another tour may be given to it,
  /// or, without a way home, is over.
  std::optional<Order> refused(const std::string& reason);

  MissionPhase phase() const { return phase_; }
  /// It flies home because a route was refused, no tour was left or the executive wanted it, and
  /// may be given another tour.
  bool may_try_again() const { return phase_ == MissionPhase::Egress && sent_home_; }
  const std::string& reason() const { return reason_; }
  std::size_t points_reached() const { return reached_; }
  const std::vector<WayPoint>& tour() const { return tour_; }

 private:
  bool is_under_way() const {
    return phase_ == MissionPhase::Ingress || phase_ == MissionPhase::Collection;
  }
  std::optional<Order> go_home(const std::string& reason);
  void enter(MissionPhase phase, std::string reason);

  Strip strip_;
  ApproachRules rules_;
  std::vector<WayPoint> tour_;
  std::string why_this_tour_;
  MissionPhase phase_ = MissionPhase::BuiltInTest;
  std::string reason_ = "waits until everybody is fine";
  std::size_t reached_ = 0;
  bool sent_home_ = false;  // By a refusal, an empty tour or the executive.
};

}  // namespace reconnaissance
