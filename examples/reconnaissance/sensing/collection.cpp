#include "sensing/collection.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace reconnaissance {
namespace {

constexpr double kFresh = 0.8;  // Of a frame, what the one before has not shown.
constexpr double kSmear_pixels = 0.5;

/// What one frame shows for certain, at the nearest part of the objective, where that is least.
struct View {
  double slant_m;   ///< Of the middle of the objective, abeam.
  double along_m;   ///< At the frame's near edge.
  double across_m;  ///< Twice from its middle to its near edge.
};

/// The share of both sides of a rectangle that an upright one within it has, however it is turned
/// up to an angle.
double upright_share(double along_m, double across_m, double turn_rad) {
  double share = 1;
  for (int i = 1; i <= 10; ++i) {
    const double sine = std::sin(turn_rad * i / 10);
    const double cosine = std::cos(turn_rad * i / 10);
    share = std::min({share, along_m / (along_m * cosine + across_m * sine),
                      across_m / (along_m * sine + across_m * cosine)});
  }
  return share;
}

/// `ahead_m`: how far what the camera aims at is not abeam, at worst.
std::optional<View> view(const Objective& objective, const Flyby& flyby, const Camera& camera,
                         double ahead_m) {
  const double half = camera.vertical_view_rad / 2;
  const double furthest_m = std::hypot(flyby.offset_m + objective.margin_m, ahead_m);
  if (std::atan2(flyby.height_m, furthest_m) - half <= 0) return std::nullopt;
  const double nearest_m = std::max(0.0, flyby.offset_m - objective.margin_m);
  const double below_near_edge = std::atan2(flyby.height_m, nearest_m) + half;
  const double forward_to_near_edge_m = flyby.height_m / std::sin(below_near_edge) * std::cos(half);
  const double along = 2 * std::tan(camera.horizontal_view_rad / 2) * forward_to_near_edge_m;
  const double across = 2 * (nearest_m - flyby.height_m / std::tan(below_near_edge));
  const double share = upright_share(along, across, std::atan2(ahead_m, flyby.offset_m));
  return View{std::hypot(flyby.height_m, flyby.offset_m), share * along, share * across};
}

/// The coarser of both ground sample distances in the middle of an image of level ground.
double sample_distance_m(double height_m, double distance_m, const Camera& camera) {
  const double slant = std::hypot(height_m, distance_m);
  const double column = 2 * std::tan(camera.horizontal_view_rad / 2) / camera.columns;
  const double row = 2 * std::tan(camera.vertical_view_rad / 2) / camera.rows;
  return std::max(slant * column, slant * row * slant / height_m);
}

double strip_m(const Objective& objective) {
  double length = 0;
  for (std::size_t i = 1; i < objective.line.size(); ++i) {
    length += map_distance_m(objective.line[i], objective.line[i - 1]);
  }
  return length;
}

/// The place so far along the objective (beyond its ends straight on) and so far to its right.
Local place_beside(const Objective& objective, const Flyby& flyby, double along_m, double right_m) {
  Local start = objective.line.front();
  double course = flyby.course_rad;
  double rise = 0;
  double left = along_m;
  for (std::size_t i = 1; i < objective.line.size(); ++i) {
    start = objective.line[i - 1];
    const Local& end = objective.line[i];
    const double length = map_distance_m(end, start);
    course = course_between_rad(start, end);
    rise = length > 0 ? (end.height_m - start.height_m) / length : 0;
    if (left <= length || i + 1 == objective.line.size()) break;
    left -= length;
  }
  return {start.north_m + left * std::cos(course) - right_m * std::sin(course),
          start.east_m + left * std::sin(course) + right_m * std::cos(course),
          start.height_m + left * rise};
}

/// How many frames side by side cover an extent.
int frames(double extent_m, double frame_m) {
  return 1 +
         std::max(0, static_cast<int>(std::ceil((extent_m - frame_m) / (kFresh * frame_m) - 1e-9)));
}

/// The middle of the i-th of n frames that together cover an extent about 0.
double middle_m(int i, int n, double extent_m, double frame_m) {
  return n == 1 ? 0 : std::lerp(-1, 1, static_cast<double>(i) / (n - 1)) * (extent_m - frame_m) / 2;
}

/// A plan whose sample distance is still a multiple of what the geometry gives, and how far what it
/// aims at is not abeam, at worst.
struct Draft {
  CollectionPlan plan;
  double ahead_m;
};

/// A plan whose frames cover what they have to although they turn while it is flown: `draft` makes
/// one from what a frame shows.
template <class MakeDraft>
std::optional<CollectionPlan> settle(const Objective& objective, const Flyby& flyby,
                                     const Camera& camera, const MakeDraft& draft) {
  double ahead_m = 0;
  for (int attempt = 0; attempt < 20; ++attempt) {
    const auto frame = view(objective, flyby, camera, ahead_m);
    if (!frame) return std::nullopt;
    Draft drafted = draft(*frame);
    if (drafted.ahead_m <= ahead_m + 1) {
      CollectionPlan plan = std::move(drafted.plan);
      plan.early_s = plan.seconds / 2;
      plan.sample_distance_m *= sample_distance_m(
          flyby.height_m, std::hypot(flyby.offset_m + objective.margin_m, ahead_m), camera);
      return plan;
    }
    ahead_m = drafted.ahead_m;
  }
  return std::nullopt;
}

}  // namespace

std::optional<CollectionPlan> plan_step_stare(const Objective& objective, const Flyby& flyby,
                                              const Camera& camera, const CameraMount& mount) {
  const double length = strip_m(objective);
  const double along = length + 2 * objective.margin_m;
  return settle(objective, flyby, camera, [&](const View& frame) {
    const int columns = frames(along, frame.along_m);
    const int rows = frames(2 * objective.margin_m, frame.across_m);
    CollectionPlan plan{{}, 0, 0, 1, 1};
    for (int column = 0; column < columns; ++column) {
      for (int i = 0; i < rows; ++i) {
        // To and fro across, so that each step is to a neighbour.
        const int row = column % 2 == 0 ? i : rows - 1 - i;
        const Local aim = place_beside(objective, flyby,
                                       length / 2 + middle_m(column, columns, along, frame.along_m),
                                       middle_m(row, rows, 2 * objective.margin_m, frame.across_m));
        if (!plan.pointings.empty()) {
          plan.seconds +=
              slant_range_m(plan.pointings.back().to, aim) / frame.slant_m / mount.slew_rad_s;
        }
        plan.seconds += mount.settle_s;
        plan.pointings.push_back({plan.seconds, mount.stare_s, aim, aim});
        plan.seconds += mount.stare_s;
      }
    }
    const double wait = std::max(1.0, along / (flyby.speed_m_s * plan.seconds));
    for (Pointing& pointing : plan.pointings) pointing.begin_s *= wait;
    plan.seconds *= wait;
    const double ahead_m = (flyby.speed_m_s * plan.seconds - along) / 2;
    return Draft{std::move(plan), ahead_m};
  });
}

std::optional<CollectionPlan> plan_line_scan(const Objective& objective, const Flyby& flyby,
                                             const Camera& camera, const CameraMount& mount) {
  const double length = strip_m(objective);
  const double along = length + 2 * objective.margin_m;
  const double abeam_sample_m = sample_distance_m(flyby.height_m, flyby.offset_m, camera);
  // A road bends: a pointing for each leg.
  std::vector<double> stations{-objective.margin_m};
  for (std::size_t i = 1; i + 1 < objective.line.size(); ++i) {
    stations.push_back(strip_m({{objective.line.begin(), objective.line.begin() + i + 1}}));
  }
  stations.push_back(length + objective.margin_m);
  return settle(objective, flyby, camera, [&](const View& frame) {
    const int sweeps = frames(2 * objective.margin_m, frame.across_m);
    const double possible_m_s =
        std::min({kSmear_pixels * abeam_sample_m / mount.integration_s,
                  mount.slew_rad_s * frame.slant_m, kFresh * frame.along_m * mount.frames_per_s});
    const double speed_m_s = sweeps == 1 ? std::min(possible_m_s, flyby.speed_m_s) : possible_m_s;
    const double middle_s = sweeps * (mount.settle_s + along / speed_m_s) / 2;
    CollectionPlan plan{{}, 0, 0, 1, std::hypot(1, kSmear_pixels)};
    double ahead_m = 0;
    const auto aim = [&](double along_m) {
      const double aircraft_m = length / 2 + flyby.speed_m_s * (plan.seconds - middle_s);
      ahead_m = std::max(ahead_m, std::abs(along_m - aircraft_m));
    };
    for (int sweep = 0; sweep < sweeps; ++sweep) {
      const double right_m = middle_m(sweep, sweeps, 2 * objective.margin_m, frame.across_m);
      plan.seconds += mount.settle_s;
      for (std::size_t i = 1; i < stations.size(); ++i) {
        // Back on every second sweep.
        const std::size_t leg = sweep % 2 == 0 ? i : stations.size() - i;
        const double from_m = stations[sweep % 2 == 0 ? leg - 1 : leg];
        const double to_m = stations[sweep % 2 == 0 ? leg : leg - 1];
        const double seconds = std::abs(to_m - from_m) / speed_m_s;
        aim(from_m);
        plan.pointings.push_back({plan.seconds, seconds,
                                  place_beside(objective, flyby, from_m, right_m),
                                  place_beside(objective, flyby, to_m, right_m)});
        plan.seconds += seconds;
        aim(to_m);
      }
    }
    return Draft{std::move(plan), ahead_m};
  });
}

std::optional<CollectionPlan> plan_spot(const Objective& objective, const Flyby& flyby,
                                        const Camera& camera, const CameraMount& mount) {
  const double length = strip_m(objective);
  const auto share = [](double frame_m, double extent_m) {
    return extent_m > frame_m ? frame_m / extent_m : 1;
  };
  return settle(objective, flyby, camera, [&](const View& frame) {
    const Local aim = place_beside(objective, flyby, length / 2, 0);
    const double seconds = mount.settle_s + mount.dwell_s;
    const double coverage = share(frame.along_m, length + 2 * objective.margin_m) *
                            share(frame.across_m, 2 * objective.margin_m);
    return Draft{{{{mount.settle_s, mount.dwell_s, aim, aim}}, seconds, 0, coverage, 1},
                 flyby.speed_m_s * seconds / 2};
  });
}

std::optional<CollectionPlan> plan_watch(const Local& place, double north_m_s, double east_m_s,
                                         const Flyby& flyby, const Camera& camera) {
  constexpr double kTrusted_s = 3;
  if (!view({{place}, 0}, flyby, camera, 0)) return std::nullopt;
  const Local then{place.north_m + kTrusted_s * north_m_s, place.east_m + kTrusted_s * east_m_s,
                   place.height_m};
  return CollectionPlan{{{0, kTrusted_s, place, then}},
                        kTrusted_s,
                        0,
                        1,
                        sample_distance_m(flyby.height_m, flyby.offset_m, camera)};
}

double collection_cost(const CollectionPlan& plan, double required_m) {
  return plan.seconds + 1000 * (1 - plan.coverage) +
         1000 * std::max(0.0, plan.sample_distance_m / required_m - 1);
}

}  // namespace reconnaissance
