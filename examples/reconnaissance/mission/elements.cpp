#include "mission/elements.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "flight/angles.hpp"
#include "mission/places.hpp"
#include "skein/error.hpp"

namespace reconnaissance {
namespace {

constexpr const char* kElement =
    "element; write `name priority size resolution margin latitude longitude ...`";
constexpr const char* kObject =
    "object; write `latitude longitude size course speed`, then `seconds course speed` for each "
    "change";

[[noreturn]] void refuse(const std::string& part, const char* what) {
  throw skein::InvalidArgument("'" + part + "' is no " + what);
}

std::vector<double> numbers_of(std::istringstream& words, const std::string& part,
                               const char* what) {
  if (const auto numbers = remaining_numbers(words)) return *numbers;
  refuse(part, what);
}

/// Refuses a latitude or longitude that the Earth does not have.
Geodetic place_of(double latitude, double longitude, const std::string& part, const char* what) {
  if (std::abs(latitude) > 90 || std::abs(longitude) > 180) refuse(part, what);
  return {latitude, longitude, 0};
}

void refuse_second(const std::vector<ElementText>& elements, const std::string& name) {
  if (std::ranges::find(elements, name, &ElementText::name) == elements.end()) return;
  throw skein::InvalidArgument("two elements are called '" + name + "'");
}

// Further aside an element is too coarse in images from the heights that are flown.
constexpr double kAside_m = 2500;

Local between(const Local& a, const Local& b, double share) {
  return {std::lerp(a.north_m, b.north_m, share), std::lerp(a.east_m, b.east_m, share),
          std::lerp(a.height_m, b.height_m, share)};
}

}  // namespace

std::vector<ElementText> parse_elements(const std::string& text) {
  std::vector<ElementText> elements;
  for (const std::string& part : parts_of(text, ';')) {
    ElementText element;
    std::istringstream words(part);
    words >> element.name;
    const auto numbers = numbers_of(words, part, kElement);
    if (numbers.size() < 6 || numbers.size() % 2 != 0 || numbers[0] <= 0 || numbers[1] <= 0 ||
        numbers[2] <= 0 || numbers[3] < 0)
      refuse(part, kElement);
    element.priority = numbers[0];
    element.size_m = numbers[1];
    element.wanted_sample_m = numbers[2];
    element.margin_m = numbers[3];
    for (std::size_t i = 4; i < numbers.size(); i += 2)
      element.line.push_back(place_of(numbers[i], numbers[i + 1], part, kElement));
    refuse_second(elements, element.name);
    elements.push_back(std::move(element));
  }
  return elements;
}

std::vector<ObjectText> parse_objects(const std::string& text) {
  std::vector<ObjectText> objects;
  for (const std::string& part : parts_of(text, ';')) {
    std::istringstream words(part);
    const auto numbers = numbers_of(words, part, kObject);
    if (numbers.size() < 5 || (numbers.size() - 5) % 3 != 0 || numbers[2] <= 0)
      refuse(part, kObject);
    ObjectText object{place_of(numbers[0], numbers[1], part, kObject),
                      numbers[2],
                      {{0, radians(numbers[3]), numbers[4]}}};
    for (std::size_t i = 5; i < numbers.size(); i += 3) {
      if (numbers[i] <= object.legs.back().from_s) refuse(part, kObject);
      object.legs.push_back({numbers[i], radians(numbers[i + 1]), numbers[i + 2]});
    }
    objects.push_back(std::move(object));
  }
  return objects;
}

Local moved(const Local& start, const std::vector<ObjectText::Leg>& legs, double now_s) {
  Local place = start;
  for (std::size_t i = 0; i < legs.size() && legs[i].from_s < now_s; ++i) {
    const double until_s = i + 1 < legs.size() ? std::min(now_s, legs[i + 1].from_s) : now_s;
    const double seconds = until_s - legs[i].from_s;
    place.north_m += seconds * (legs[i].speed_m_s * std::cos(legs[i].course_rad));
    place.east_m += seconds * (legs[i].speed_m_s * std::sin(legs[i].course_rad));
  }
  return place;
}

Passage passage(const Local& aircraft, double course_rad, const Local& place) {
  const double north = place.north_m - aircraft.north_m, east = place.east_m - aircraft.east_m;
  return {north * std::cos(course_rad) + east * std::sin(course_rad),
          east * std::cos(course_rad) - north * std::sin(course_rad)};
}

bool is_ahead(const Passage& passage) {
  return passage.ahead_m > 0 && std::abs(passage.offset_m) <= kAside_m;
}

Local middle_of(const std::vector<Local>& line) {
  double left = 0;
  for (std::size_t i = 1; i < line.size(); ++i) left += map_distance_m(line[i - 1], line[i]) / 2;
  for (std::size_t i = 1; i < line.size(); ++i) {
    const double length = map_distance_m(line[i - 1], line[i]);
    if (left <= length && length > 0) return between(line[i - 1], line[i], left / length);
    left -= length;
  }
  return line.front();
}

std::vector<Local> prolonged(std::vector<Local> line, double by_m) {
  const auto move_away = [&](Local& end, const Local& from) {
    const double course_rad = course_between_rad(from, end);
    end.north_m += by_m * std::cos(course_rad);
    end.east_m += by_m * std::sin(course_rad);
  };
  if (line.size() < 2) return line;
  const Local second = line[1];
  move_away(line.back(), line[line.size() - 2]);
  move_away(line.front(), second);
  return line;
}

std::vector<Local> parts_of_line(const std::vector<Local>& line, double spacing_m) {
  std::vector<Local> parts{line.front()};
  for (std::size_t i = 1; i < line.size(); ++i) {
    const double length = map_distance_m(line[i - 1], line[i]);
    const int steps = std::max(1, static_cast<int>(std::ceil(length / spacing_m)));
    for (int step = 1; step <= steps; ++step)
      parts.push_back(between(line[i - 1], line[i], static_cast<double>(step) / steps));
  }
  return parts;
}

}  // namespace reconnaissance
