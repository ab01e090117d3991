#include "track_check.hpp"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <map>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

namespace skein::test {
namespace {

constexpr double kDegree = 3.14159265358979323846 / 180;
constexpr double kNear_m = 0.66 * 1852;
constexpr double kNearHeight_m = 450 * 0.3048;
constexpr double kAirfield_m = 5000;
constexpr double kFlying_m_s = 30;

struct Point {
  double time_s, latitude_deg, longitude_deg, height_m, above_ground_m;
};

struct Way {
  double north_m, east_m;
  double length_m() const { return std::hypot(north_m, east_m); }
  double course_rad() const { return std::atan2(east_m, north_m); }
};

/// By the radii of curvature of the ellipsoid half-way.
Way way(const Point& from, const Point& to) {
  constexpr double kRadius_m = 6378137, kSquaredEccentricity = 0.00669437999014;
  const double latitude = (from.latitude_deg + to.latitude_deg) / 2 * kDegree;
  const double w = 1 - kSquaredEccentricity * std::sin(latitude) * std::sin(latitude);
  const double meridian = kRadius_m * (1 - kSquaredEccentricity) / (w * std::sqrt(w));
  const double normal = kRadius_m / std::sqrt(w);
  return {(to.latitude_deg - from.latitude_deg) * kDegree * meridian,
          (to.longitude_deg - from.longitude_deg) * kDegree * normal * std::cos(latitude)};
}

std::map<int, std::vector<Point>> read(const std::filesystem::path& file) {
  std::ifstream stream(file);
  std::string line;
  if (!std::getline(stream, line)) throw std::runtime_error(file.string() + " has no tracks");
  std::map<int, std::vector<Point>> tracks;
  while (std::getline(stream, line)) {
    std::replace(line.begin(), line.end(), ',', ' ');
    std::istringstream words(line);
    int aircraft = 0;
    Point point{};
    if (!(words >> point.time_s >> aircraft >> point.latitude_deg >> point.longitude_deg >>
          point.height_m >> point.above_ground_m))
      throw std::runtime_error(file.string() + ": '" + line + "' is no sample of a track");
    tracks[aircraft].push_back(point);
  }
  return tracks;
}

/// The sample that is that long after another; the last if the track ends before.
const Point& later(const std::vector<Point>& track, std::size_t from, double seconds) {
  const auto found =
      std::lower_bound(track.begin() + static_cast<std::ptrdiff_t>(from), track.end(),
                       track[from].time_s + seconds - 1e-6,
                       [](const Point& point, double time_s) { return point.time_s < time_s; });
  return found == track.end() ? track.back() : *found;
}

void see_turns_and_climbs(const std::vector<Point>& own, TrackExtremes& extremes) {
  constexpr double kStep_s = 2;
  for (std::size_t i = 0; i < own.size(); ++i) {
    const Point& middle = later(own, i, kStep_s);
    const Point& end = later(own, i, 2 * kStep_s);
    const double first_s = middle.time_s - own[i].time_s, second_s = end.time_s - middle.time_s;
    if (first_s < kStep_s / 2 || second_s < kStep_s / 2) break;
    const Way before = way(own[i], middle), after = way(middle, end);
    const double speed = (before.length_m() + after.length_m()) / (first_s + second_s);
    if (speed < kFlying_m_s || own[i].above_ground_m < 10) continue;
    const double turned = std::remainder(after.course_rad() - before.course_rad(), 360 * kDegree);
    const double rate = std::abs(turned) / ((first_s + second_s) / 2);
    extremes.greatest_bank_deg =
        std::max(extremes.greatest_bank_deg, std::atan(speed * rate / 9.80665) / kDegree);
    const double level = before.length_m() + after.length_m();
    extremes.greatest_climb_deg =
        std::max(extremes.greatest_climb_deg,
                 std::atan2(std::abs(end.height_m - own[i].height_m), level) / kDegree);
  }
}

void see_other(const std::vector<Point>& own, const std::vector<Point>& other,
               TrackExtremes& extremes) {
  double since_s = -1;
  std::size_t next = 0;
  for (const Point& there : other) {
    while (next + 1 < own.size() && own[next].time_s < there.time_s - 1e-6) ++next;
    const Point& here = own[next];
    const bool flies = here.above_ground_m > 10;
    const bool near = flies && way(here, there).length_m() < kNear_m &&
                      std::abs(here.height_m - there.height_m) < kNearHeight_m;
    if (!near) {
      since_s = -1;
      continue;
    }
    if (since_s < 0) since_s = there.time_s;
    extremes.longest_not_well_clear_s =
        std::max(extremes.longest_not_well_clear_s, there.time_s - since_s + 0.1);
  }
}

const std::vector<Point>& own_track(const std::map<int, std::vector<Point>>& all,
                                    const std::filesystem::path& file) {
  const auto found = all.find(0);
  if (found == all.end() || found->second.size() < 2)
    throw std::runtime_error(file.string() + " has no track of aircraft 0");
  return found->second;
}

}  // namespace

TrackExtremes extremes_of(const std::filesystem::path& tracks) {
  const auto all = read(tracks);
  TrackExtremes extremes;
  const std::vector<Point>& own = own_track(all, tracks);
  extremes.flown_s = own.back().time_s - own.front().time_s;
  for (std::size_t i = 1; i < own.size(); ++i) {
    extremes.flown_m += way(own[i - 1], own[i]).length_m();
    if (way(own.front(), own[i]).length_m() > kAirfield_m)
      extremes.least_clearance_m = std::min(extremes.least_clearance_m, own[i].above_ground_m);
  }
  see_turns_and_climbs(own, extremes);
  for (const auto& [number, track] : all) {
    if (number == 0) continue;
    ++extremes.others;
    see_other(own, track, extremes);
  }
  return extremes;
}

double Pass::sample_m(double pixel_rad) const {
  return (beside_m * beside_m + above_ground_m * above_ground_m) / above_ground_m * pixel_rad;
}

Pass pass_by(const std::filesystem::path& tracks, double latitude_deg, double longitude_deg) {
  const auto all = read(tracks);
  Pass pass;
  for (const Point& each : own_track(all, tracks)) {
    const double beside_m = way({0, latitude_deg, longitude_deg, 0, 0}, each).length_m();
    if (beside_m < pass.beside_m) pass = {beside_m, each.above_ground_m};
  }
  return pass;
}

double seconds_within(const std::filesystem::path& tracks, double latitude_deg,
                      double longitude_deg, double distance_m) {
  const auto all = read(tracks);
  const std::vector<Point>& own = own_track(all, tracks);
  double seconds = 0;
  for (std::size_t i = 1; i < own.size(); ++i)
    if (way({0, latitude_deg, longitude_deg, 0, 0}, own[i]).length_m() < distance_m)
      seconds += own[i].time_s - own[i - 1].time_s;
  return seconds;
}

}  // namespace skein::test
