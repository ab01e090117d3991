#include "view/live_view.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace reconnaissance {
namespace {

constexpr std::size_t kLeastColumns = 60, kLeastLines = 12;
constexpr std::size_t kPanel = 28;  // columns beside the map
constexpr std::size_t kTold = 4;    // lines below it
// A character is about twice as high as wide.
constexpr double kShape = 2;
constexpr double kMargin_m = 2500;
// A site that is further away than that from all else is not on the map.
constexpr double kAround_m = 12'000;

struct Box {
  double south_m = 0, north_m = 0, west_m = 0, east_m = 0;
  bool empty = true;

  void hold(const Local& place, double around_m = kMargin_m) {
    const Box other{place.north_m - around_m, place.north_m + around_m, place.east_m - around_m,
                    place.east_m + around_m, false};
    if (empty) {
      *this = other;
      return;
    }
    south_m = std::min(south_m, other.south_m);
    north_m = std::max(north_m, other.north_m);
    west_m = std::min(west_m, other.west_m);
    east_m = std::max(east_m, other.east_m);
  }
  bool holds(const Local& place, double around_m) const {
    return place.north_m > south_m - around_m && place.north_m < north_m + around_m &&
           place.east_m > west_m - around_m && place.east_m < east_m + around_m;
  }
};

Box box_of(const MissionRecord& record) {
  Box box;
  for (const TrackPoint& each : record.track) box.hold(each.place);
  for (const Target& target : record.targets)
    for (const Local& each : target.line) box.hold(each);
  if (!record.routes.empty())
    for (const Local& each : record.routes.back().points) box.hold(each);
  const Box near = box;
  for (const KnownThreat& each : record.threats)
    if (near.holds(each.place, kAround_m)) box.hold(each.place);
  return box;
}

class Map {
 public:
  Map(const Box& box, std::size_t columns, std::size_t lines)
      : rows_(lines, std::string(columns, ' ')),
        box_(box),
        scale_(std::max((box.east_m - box.west_m) / static_cast<double>(columns),
                        (box.north_m - box.south_m) / static_cast<double>(lines) / kShape)) {}

  void put(const Local& place, char sign) {
    if (char* at = cell(place)) *at = sign;
  }
  /// Over nothing else.
  void hint(const Local& place, char sign) {
    if (char* at = cell(place); at && *at == ' ') *at = sign;
  }
  void draw(const Local& from, const Local& to, char sign) {
    const double length_m = std::hypot(to.north_m - from.north_m, to.east_m - from.east_m);
    const int steps = 1 + static_cast<int>(length_m / scale_);
    for (int i = 0; i <= steps; ++i) {
      const double share = static_cast<double>(i) / steps;
      hint(
          {std::lerp(from.north_m, to.north_m, share), std::lerp(from.east_m, to.east_m, share), 0},
          sign);
    }
  }
  void ring(const Local& about, double radius_m, char sign) {
    const int steps = 8 + static_cast<int>(2 * std::numbers::pi * radius_m / scale_);
    for (int i = 0; i < steps; ++i) {
      const double angle = 2 * std::numbers::pi * i / steps;
      hint({about.north_m + radius_m * std::cos(angle), about.east_m + radius_m * std::sin(angle),
            0},
           sign);
    }
  }
  /// To the right of a place.
  void name(const Local& place, const std::string& text) {
    const char* const at = cell(place);
    if (!at) return;
    std::string& row = *row_of(place);
    const auto first = static_cast<std::size_t>(at - row.data()) + 1;
    for (std::size_t i = 0; i < text.size() && first + i < row.size(); ++i)
      row[first + i] = text[i];
  }
  const std::vector<std::string>& rows() const { return rows_; }
  double metres_a_column() const { return scale_; }

 private:
  std::string* row_of(const Local& place) {
    const double row = (box_.north_m - place.north_m) / (scale_ * kShape);
    if (!(row >= 0) || row >= static_cast<double>(rows_.size())) return nullptr;
    return &rows_[static_cast<std::size_t>(row)];
  }
  char* cell(const Local& place) {
    std::string* const row = row_of(place);
    const double column = (place.east_m - box_.west_m) / scale_;
    if (!row || !(column >= 0) || column >= static_cast<double>(row->size())) return nullptr;
    return &(*row)[static_cast<std::size_t>(column)];
  }

  std::vector<std::string> rows_;
  Box box_;
  double scale_;
};

char arrow(double heading_rad) {
  const double quarter = std::round(heading_rad / (std::numbers::pi / 2));
  return "^>v<"[static_cast<std::size_t>(std::lround(quarter) & 3)];
}

Map map_of(const MissionRecord& record, std::size_t columns, std::size_t lines) {
  Map map(box_of(record), columns, lines);
  for (const KnownThreat& each : record.threats) map.put(each.place, 'X');
  for (const Target& target : record.targets) {
    const char sign = target.collected_s ? '#' : 'o';
    for (const Local& each : target.line) map.put(each, sign);
    if (!target.line.empty()) map.name(target.line.back(), target.name);
  }
  for (const TrackPoint& each : record.track) map.hint(each.place, '.');
  if (!record.routes.empty()) {
    const std::vector<Local>& points = record.routes.back().points;
    for (std::size_t i = 1; i < points.size(); ++i) map.draw(points[i - 1], points[i], '-');
  }
  for (const KnownThreat& each : record.threats) map.ring(each.place, each.lethal_range_m, ':');
  const double now_s = record.track.empty() ? 0 : record.track.back().time_s;
  for (const OtherTrack& other : record.others)
    if (!other.points.empty() && other.points.back().time_s >= now_s - 5)
      map.put(other.points.back().place, '@');
  if (!record.track.empty())
    map.put(record.track.back().place, arrow(record.track.back().heading_rad));
  return map;
}

/// What was noticed and decided, each with when.
std::vector<std::string> told(const MissionRecord& record) {
  std::vector<std::pair<double, std::string>> all;
  for (const Stage& each : record.phases)
    all.emplace_back(each.from_s, each.name + ": " + each.reason);
  for (const Fault& each : record.faults)
    all.emplace_back(each.noticed_s,
                     fmt::format("{} notices: {}. {}", each.noticed_by, each.what, each.answer));
  for (const DecisionTold& each : record.decisions)
    all.emplace_back(each.time_s, fmt::format("{}, {}: {}", each.entity, each.question,
                                              each.chosen.empty() ? "no result" : each.chosen));
  std::ranges::stable_sort(all, {}, &std::pair<double, std::string>::first);
  std::vector<std::string> lines;
  for (std::size_t i = all.size() - std::min(all.size(), kTold); i < all.size(); ++i)
    lines.push_back(clock_text(all[i].first) + "  " + all[i].second);
  return lines;
}

std::string head(const MissionRecord& record) {
  if (record.track.empty()) return "the mission has not begun";
  const TrackPoint& now = record.track.back();
  const double heading = std::fmod(now.heading_rad * 180 / std::numbers::pi + 720, 360);
  return fmt::format(
      "{}  {:4.0f} m, {:4.0f} above ground  {:3.0f} m/s  heading {:03.0f}  fuel {:4.1f} kg",
      clock_text(now.time_s), now.place.height_m, now.height_above_ground_m, now.ground_speed_m_s,
      heading, now.fuel_kg);
}

/// What others have said may hold anything.
std::string fitted(const std::string& text, std::size_t columns) {
  std::string line = text.substr(0, columns);
  std::ranges::replace_if(
      line, [](unsigned char c) { return c < 0x20 || c > 0x7e; }, '?');
  return line;
}

}  // namespace

std::string clock_text(double seconds) {
  const long whole = static_cast<long>(std::floor(seconds));
  return fmt::format("{:02}:{:02}", whole / 60, whole % 60);
}

std::vector<std::string> live_view(const MissionRecord& record,
                                   const std::vector<MemberState>& members, std::size_t columns,
                                   std::size_t lines) {
  columns = std::max(columns, kLeastColumns);
  lines = std::max(lines, kLeastLines);
  const std::size_t width = columns - kPanel, height = lines - kTold - 3;
  std::vector<std::string> view{head(record)};
  view.push_back(
      record.phases.empty() ? "" : record.phases.back().name + ": " + record.phases.back().reason);
  const Map map = map_of(record, width, height);
  for (std::size_t row = 0; row < height; ++row) {
    std::string line = map.rows()[row] + "  ";
    if (row < members.size())
      line += fmt::format("{:18.18} {}", members[row].name, members[row].condition);
    view.push_back(line);
  }
  view.push_back(
      fmt::format("-- {:.1f} km a column   . flown  - route  o element  # collected  X site  "
                  ": reach  @ other",
                  map.metres_a_column() / 1000));
  for (const std::string& line : told(record)) view.push_back(line);
  for (std::string& line : view) line = fitted(line, columns);
  return view;
}

}  // namespace reconnaissance
