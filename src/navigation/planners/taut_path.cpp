#include "navigation/planners/taut_path.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "navigation/planners/turn_arc.hpp"

namespace skein::navigation {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// The table of the dynamic programme: the cheapest way to arrive at point `to` by the leg from
/// `from`, and from which leg.
class Arrivals {
 public:
  explicit Arrivals(std::size_t count)
      : count_(count), cost_(count * count, kInfinity), leg_(count * count, -1), before_(leg_) {}

  double& cost(std::size_t from, std::size_t to) { return cost_[from * count_ + to]; }
  float& leg_m(std::size_t from, std::size_t to) { return leg_[from * count_ + to]; }
  float& before(std::size_t from, std::size_t to) { return before_[from * count_ + to]; }

 private:
  std::size_t count_;
  std::vector<double> cost_;
  std::vector<float> leg_;     ///< Length of the leg; negative where it cannot be flown.
  std::vector<float> before_;  ///< Where the leg before began; negative for none.
};

class TautPath {
 public:
  TautPath(const PlanningScene& scene, const GroundPath& path, const LegCost& cost, double radius_m)
      : scene_(scene), path_(path), cost_(cost), radius_m_(radius_m), arrivals_(path.size()) {}

  std::optional<GroundPath> find() {
    const std::size_t last = path_.size() - 1;
    for (std::size_t to = 1; to <= last; ++to) {
      scene_.budget().require_time();
      for (std::size_t from = 0; from < to; ++from) arrive(from, to);
    }
    std::size_t from = 0;
    for (std::size_t candidate = 1; candidate < last; ++candidate) {
      if (arrivals_.cost(candidate, last) < arrivals_.cost(from, last)) from = candidate;
    }
    if (arrivals_.cost(from, last) == kInfinity) return std::nullopt;
    return walk_back(from, last);
  }

 private:
  void arrive(std::size_t from, std::size_t to) {
    // Unless `from` itself can be reached there is no use in asking whether the leg is free.
    double least = from == 0 ? 0 : kInfinity;
    for (std::size_t before = 0; before < from; ++before) {
      least = std::min(least, arrivals_.cost(before, from));
    }
    if (least == kInfinity || !scene_.free(path_[from], path_[to], Berth::Least)) return;
    arrivals_.leg_m(from, to) = static_cast<float>(distance_m(path_[from], path_[to]));
    double best = from == 0 ? 0 : kInfinity;
    for (std::size_t before = 0; before < from; ++before) {
      const double candidate = arrivals_.cost(before, from);
      if (candidate >= best || !turn_fits(before, from, to)) continue;
      best = candidate;
      arrivals_.before(from, to) = static_cast<float>(before);
    }
    if (best < kInfinity) arrivals_.cost(from, to) = best + cost_(path_[from], path_[to]);
  }

  /// Each turn may use half of either leg, so that two turns never meet.
  bool turn_fits(std::size_t a, std::size_t b, std::size_t c) {
    if (radius_m_ == 0) return true;
    const double tangent = radius_m_ * tangent_share(path_[a], path_[b], path_[c]);
    const double before = arrivals_.leg_m(a, b);
    const double after = arrivals_.leg_m(b, c);
    if (tangent > 0.5 * std::min(before, after)) return false;
    if (tangent < 1) return true;
    return scene_.free(between(path_[b], path_[a], tangent / before),
                       between(path_[b], path_[c], tangent / after), Berth::Least);
  }

  GroundPath walk_back(std::size_t from, std::size_t to) {
    GroundPath taut{path_[to]};
    while (true) {
      taut.push_back(path_[from]);
      const float before = arrivals_.before(from, to);
      if (before < 0) break;
      to = std::exchange(from, static_cast<std::size_t>(before));
    }
    std::reverse(taut.begin(), taut.end());
    return taut;
  }

  const PlanningScene& scene_;
  const GroundPath& path_;
  const LegCost& cost_;
  double radius_m_;
  Arrivals arrivals_;
};

}  // namespace

GroundPath divide(const GroundPath& path, double longest_m) {
  GroundPath divided{path.front()};
  for (std::size_t i = 1; i < path.size(); ++i) {
    const int pieces =
        std::max(1, static_cast<int>(std::ceil(distance_m(path[i - 1], path[i]) / longest_m)));
    for (int piece = 1; piece < pieces; ++piece) {
      divided.push_back(between(path[i - 1], path[i], static_cast<double>(piece) / pieces));
    }
    divided.push_back(path[i]);
  }
  return divided;
}

GroundPath thin(const PlanningScene& scene, const GroundPath& path, double step_m) {
  GroundPath thinned{path.front()};
  for (std::size_t next = 1; next < path.size(); ++next) {
    while (next + 1 < path.size() && distance_m(thinned.back(), path[next + 1]) <= step_m &&
           scene.free(thinned.back(), path[next + 1], Berth::Least)) {
      ++next;
    }
    thinned.push_back(path[next]);
  }
  return thinned;
}

std::optional<GroundPath> pull_taut(const PlanningScene& scene, const GroundPath& path,
                                    const LegCost& cost, double turn_radius_m) {
  return TautPath(scene, path, cost, turn_radius_m).find();
}

GroundPath round_corners(const GroundPath& path, double turn_radius_m) {
  constexpr double kStep = 8 * std::numbers::pi / 180;
  if (turn_radius_m == 0) return path;
  GroundPath rounded{path.front()};
  for (std::size_t i = 1; i + 1 < path.size(); ++i) {
    const GroundPoint& corner = path[i];
    const double share = tangent_share(path[i - 1], corner, path[i + 1]);
    const double turn = 2 * std::atan(share);
    const int pieces = static_cast<int>(std::ceil(turn / kStep));
    if (pieces <= 1) {
      rounded.push_back(corner);
      continue;
    }
    // Tangents of the arc at equal angles: they begin where the turn begins, and the first and the
    // last are half as long as those between.
    const double tangent = turn_radius_m * share;
    const double half_side = turn_radius_m * std::tan(turn / pieces / 2);
    const double in = distance_m(path[i - 1], corner);
    const double out = distance_m(corner, path[i + 1]);
    double north = (corner.north_m - path[i - 1].north_m) / in;
    double east = (corner.east_m - path[i - 1].east_m) / in;
    const double north_out = (path[i + 1].north_m - corner.north_m) / out;
    const double east_out = (path[i + 1].east_m - corner.east_m) / out;
    const double angle = std::copysign(turn / pieces, north * east_out - east * north_out);
    GroundPoint at{corner.north_m - tangent * north, corner.east_m - tangent * east};
    for (int piece = 0; piece < pieces; ++piece) {
      const double side = piece == 0 ? half_side : 2 * half_side;
      at = {at.north_m + side * north, at.east_m + side * east};
      rounded.push_back(at);
      const double turned = north * std::cos(angle) - east * std::sin(angle);
      east = north * std::sin(angle) + east * std::cos(angle);
      north = turned;
    }
  }
  rounded.push_back(path.back());
  return rounded;
}

}  // namespace skein::navigation
