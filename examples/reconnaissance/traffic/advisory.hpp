#pragma once

#include <functional>
#include <optional>
#include <span>

#include "traffic/alerting.hpp"
#include "traffic/bands.hpp"

namespace reconnaissance {

/// What the flight controller shall do instead of its route. Where both are empty it goes on.
struct ResolutionAdvisory {
  std::optional<double> course_rad;
  std::optional<double> climb_m_s;
  bool recovery = false;  ///< No manoeuvre keeps well clear; this one regains it.

  bool is_given() const { return course_rad || climb_m_s; }
};

/// Detect and avoid by bands, after DAIDALUS's directive guidance (Muñoz et al., "DAIDALUS: Detect
/// and Avoid Alerting Logic for Unmanned Systems", DASC 2015):
/// - The course that keeps well clear with the least change; to the right if both sides are alike
///   (ICAO Annex 2, 3.2.2.2: head-on, both turn right). A side once chosen is kept unless the other
///   needs 15° less.
/// - If no course does that may be flown, the climb rate with the least change.
/// - If no climb rate does either, any course that keeps well clear.
/// - If none does either, recovery: of the manoeuvres that keep outside near mid-air collision and
///   of as large a part of the well-clear volume as any allows (made smaller by a tenth at a time),
///   the one that regains well clear soonest.
/// Advisories begin with a corrective alert where the course that the route asks for leads into the
/// volume, or with a warning, and last until that course is free of a volume half as wide again.
class BandsAvoider {
 public:
  explicit BandsAvoider(const ManoeuvreLimits& limits = {}) : limits_(limits) {}

  /// Whether a course may be flown, whatever other aircraft do: it leads out of weapons' reach.
  using MayFly = std::function<bool(double course_rad)>;

  /// Call about once a second with all traffic, and the highest alert about any of it.
  ResolutionAdvisory advise(
      const TrafficState& own, std::span<const TrafficState> others, double route_course_rad,
      AlertLevel alert, const MayFly& may_fly = [](double) { return true; });

 private:
  enum class Side { None, Left, Right };

  ResolutionAdvisory resolve(const TrafficState& own, std::span<const TrafficState> others,
                             const MayFly& may_fly);
  std::optional<double> least_turn(const std::vector<Manoeuvre>& courses, const MayFly& may_fly);

  ManoeuvreLimits limits_;
  Side side_ = Side::None;
  bool avoiding_ = false;
};

/// Detect and avoid by an artificial potential field (Khatib 1986): the course is the direction of
/// the sum of a unit vector along the route and of two for each intruder: away from where it will
/// be seen at the closest approach, and to the right of where it is seen now (a vortex, after De
/// Medio and Oriolo 1991, which decides where the former points against the course). Both grow as
/// the closest approach becomes closer and sooner. What is a warning is avoided by height, too.
/// Simple and smooth, and without any guarantee to keep well clear.
class PotentialFieldAvoider {
 public:
  ResolutionAdvisory advise(const TrafficState& own, std::span<const TrafficState> others,
                            double route_course_rad) const;
};

}  // namespace reconnaissance
