#include "planning/turns.hpp"

#include <cmath>
#include <cstdlib>
#include <numbers>

#include "planning/dubins_length.hpp"

namespace reconnaissance {
namespace {

Local ahead(const Local& from, double course_rad, double length_m) {
  return {from.north_m + length_m * std::cos(course_rad),
          from.east_m + length_m * std::sin(course_rad), from.height_m};
}

/// Adds the corners between a way's last point and the next one.
void turn_onto(const Local& to, double from_course_rad, double to_course_rad, double radius_m,
               std::vector<Local>& way) {
  const Local from = way.back();
  const std::size_t first = way.size();
  for (const RoutePose& corner : dubins_corners({from.north_m, from.east_m, from_course_rad},
                                                {to.north_m, to.east_m, to_course_rad}, radius_m))
    way.push_back({corner.north_m, corner.east_m, 0});
  way.push_back(to);
  double length_m = 0, done_m = 0;
  for (std::size_t i = first; i < way.size(); ++i) length_m += map_distance_m(way[i - 1], way[i]);
  for (std::size_t i = first; i + 1 < way.size(); ++i) {
    done_m += map_distance_m(way[i - 1], way[i]);
    way[i].height_m = std::lerp(from.height_m, to.height_m, done_m / length_m);
  }
}

}  // namespace

std::vector<Local> with_turns(const std::vector<Local>& way, double begin_course_rad,
                              double end_course_rad, double radius_m, int first_quarters) {
  std::vector<Local> turned{way.front()};
  for (int i = 0; i < std::abs(first_quarters); ++i) {
    const Local corner = ahead(turned.back(), begin_course_rad, radius_m);
    const double turned_rad =
        begin_course_rad + std::copysign(std::numbers::pi / 2, first_quarters);
    turn_onto(ahead(corner, turned_rad, radius_m), begin_course_rad, turned_rad, radius_m, turned);
    begin_course_rad = turned_rad;
  }
  const double near_m = 4 * radius_m;
  std::vector<Local> kept{turned.back()};
  for (std::size_t i = 1; i + 1 < way.size(); ++i)
    if (map_distance_m(way.front(), way[i]) >= near_m &&
        map_distance_m(way[i], way.back()) >= near_m)
      kept.push_back(way[i]);
  kept.push_back(way.back());

  const std::size_t last = kept.size() - 1;
  const auto course = [&](std::size_t i) {
    if (i == 0) return begin_course_rad;
    return i == last ? end_course_rad : course_between_rad(kept[i - 1], kept[i + 1]);
  };
  for (std::size_t i = 1; i <= last; ++i) {
    if (i == 1 || i == last)
      turn_onto(kept[i], course(i - 1), course(i), radius_m, turned);
    else
      turned.push_back(kept[i]);
  }
  return turned;
}

}  // namespace reconnaissance
