#include "report/report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <nlohmann/json.hpp>
#include <numbers>

/// No value is written as null.
template <>
struct nlohmann::adl_serializer<std::optional<double>> {
  static void to_json(ordered_json& json, const std::optional<double>& value) {
    if (value)
      json = *value;
    else
      json = nullptr;
  }
};

namespace reconnaissance {

// A page that page.js draws from a record in JSON; the build makes it (../page/page.cmake).
std::string page_of(const std::string& json);

namespace {

using Json = nlohmann::ordered_json;

/// A page is read by people, and it is small: no more digits than it can show.
double rounded(double value, int digits) {
  const double scale = std::pow(10, digits);
  return std::round(value * scale) / scale + 0.0;
}

void round_all(Json& json, int digits = 2) {
  static const std::map<std::string, int> kDigits{
      {"distance_m", 0},   {"heights_m", 0}, {"line", 1},         {"outline", 1},
      {"points", 1},       {"corners", 1},   {"path", 1},         {"sample_m", 3},
      {"spacing_m", 3},    {"priority", 3},  {"survival", 4},     {"wanted_sample_m", 3},
      {"took_s", 6},       {"seconds", 6},   {"latitude_deg", 7}, {"achieved_sample_m", 3},
      {"longitude_deg", 7}};
  if (json.is_number_float()) json = rounded(json, digits);
  if (!json.is_structured()) return;
  for (const auto& each : json.items()) {
    const auto known = kDigits.find(each.key());
    round_all(each.value(), known == kDigits.end() ? digits : known->second);
  }
}

double degrees(double radians) { return radians * 180 / std::numbers::pi; }

/// In columns, which tables are read from, and which are half as long.
Json columns_of(const std::vector<TrackPoint>& track) {
  const auto column = [&](int digits, auto value) {
    Json result = Json::array();
    for (const TrackPoint& point : track) result.push_back(rounded(value(point), digits));
    return result;
  };
  return {
      {"time_s", column(2, [](const TrackPoint& p) { return p.time_s; })},
      {"north_m", column(1, [](const TrackPoint& p) { return p.place.north_m; })},
      {"east_m", column(1, [](const TrackPoint& p) { return p.place.east_m; })},
      {"height_m", column(1, [](const TrackPoint& p) { return p.place.height_m; })},
      {"above_ground_m", column(1, [](const TrackPoint& p) { return p.height_above_ground_m; })},
      {"airspeed_m_s", column(1, [](const TrackPoint& p) { return p.airspeed_m_s; })},
      {"ground_speed_m_s", column(1, [](const TrackPoint& p) { return p.ground_speed_m_s; })},
      {"heading_deg", column(1, [](const TrackPoint& p) { return degrees(p.heading_rad); })},
      {"climb_deg", column(1, [](const TrackPoint& p) { return degrees(p.climb_rad); })},
      {"bank_deg", column(1, [](const TrackPoint& p) { return degrees(p.bank_rad); })},
      {"fuel_kg", column(2, [](const TrackPoint& p) { return p.fuel_kg; })}};
}

}  // namespace

// Members that are written by their names, for nlohmann::json, which finds this by its argument.
#define WRITES(Type, ...)                                                    \
  static void to_json(Json& nlohmann_json_j, const Type& nlohmann_json_t) {  \
    NLOHMANN_JSON_EXPAND(NLOHMANN_JSON_PASTE(NLOHMANN_JSON_TO, __VA_ARGS__)) \
  }

static void to_json(Json& json, const Local& place) {
  json = {place.north_m, place.east_m, place.height_m};
}
static void to_json(Json& json, const OtherTrack::Point& at) {
  json = {at.time_s, at.place.north_m, at.place.east_m, at.place.height_m};
}
WRITES(Geodetic, latitude_deg, longitude_deg)
WRITES(Check, name, passed, text)
WRITES(GroundGrid, south_m, west_m, spacing_m, columns, heights_m)
WRITES(OtherTrack, number, name, points)
WRITES(PlannedRoute, from_s, planner, points)
WRITES(KnownThreat, number, kind, from_s, place, deviation_m, detection_range_m, lethal_range_m)
WRITES(NoFlyZone, name, outline)
WRITES(Target, name, line, priority, wanted_sample_m, achieved_sample_m, deviation_m, collected_s,
       wanted_s, followed_s, wanted_deviation_m, path)
WRITES(TrueThing, name, points)
WRITES(ImagedGround, time_s, target, corners, sample_m)
WRITES(Stage, from_s, name, reason)
WRITES(Answer, name, outcome, reason, took_s)
WRITES(DecisionTold, time_s, entity, question, chosen, reason, took_s, late, answers)
WRITES(Fault, from_s, until_s, what, noticed_by, noticed_s, answer)
WRITES(Flag, time_s, severe, text)

/// In order; of many, as many evenly spread ones as a histogram can show, the least and the
/// greatest among them.
static void to_json(Json& json, const Latencies& latencies) {
  constexpr std::size_t kShown = 400;
  std::vector<double> sorted = latencies.seconds, shown;
  std::ranges::sort(sorted);
  const std::size_t count = std::min(sorted.size(), kShown);
  for (std::size_t i = 0; i < count; ++i)
    shown.push_back(sorted[count < 2 ? 0 : i * (sorted.size() - 1) / (count - 1)]);
  json = {{"name", latencies.name}, {"count", sorted.size()}, {"seconds", shown}};
}

std::string headline(const MissionRecord& record) {
  const auto collected = std::ranges::count_if(
      record.targets, [](const Target& target) { return target.collected_s.has_value(); });
  const auto late = std::ranges::count_if(record.decisions, &DecisionTold::late);
  const auto misses = static_cast<std::size_t>(late) + record.lost_samples;
  const long seconds = std::lround(record.verdict.duration_s);
  return fmt::format(
      "{} · {} min {:02} s · {:.1f} km · {} of {} targets · tracked {:.0f} s, survival {:.3f} · {} "
      "{}",
      record.verdict.passed ? "Passed" : (record.verdict.flown ? "Failed" : "Not flown to its end"),
      seconds / 60, seconds % 60, record.verdict.distance_m / 1000, collected,
      record.targets.size(), record.tracked_s, record.survival, misses,
      misses == 1 ? "miss" : "misses");
}

std::vector<Flag> flags_of(const MissionRecord& record) {
  std::vector<Flag> flags = record.flags;
  const double end_s = record.track.empty() ? 0 : record.track.back().time_s;
  for (const Check& check : record.verdict.checks)
    if (!check.passed) flags.push_back({end_s, true, check.name + ": " + check.text});
  for (const Fault& fault : record.faults)
    flags.push_back({fault.noticed_s, !fault.until_s,
                     fmt::format("{}: noticed by {} after {:.1f} s{}", fault.what, fault.noticed_by,
                                 std::max(0.0, fault.noticed_s - fault.from_s),
                                 fault.until_s ? "" : ", and not healed")});
  std::map<std::string, int> unanswered;
  for (const DecisionTold& decision : record.decisions) {
    if (decision.chosen.empty()) {
      const std::string text = decision.entity + " found no answer: " + decision.question;
      if (++unanswered[text] == 1) flags.push_back({decision.time_s, false, text});
    } else if (decision.late) {
      flags.push_back(
          {decision.time_s, false,
           decision.entity + " had to do without an answer in time: " + decision.question});
    }
  }
  for (Flag& flag : flags) {
    const auto found = unanswered.find(flag.text);
    if (found != unanswered.end() && found->second > 1)
      flag.text += fmt::format(", {} times", found->second);
  }
  std::ranges::stable_sort(flags, {}, &Flag::time_s);
  return flags;
}

GroundGrid ground_around(const MissionRecord& record, std::size_t columns,
                         const std::function<double(double, double)>& height_m) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  double south = kInfinity, west = kInfinity, north = -kInfinity, east = -kInfinity;
  const auto show = [&](const Local& place, double around_m) {
    south = std::min(south, place.north_m - around_m);
    north = std::max(north, place.north_m + around_m);
    west = std::min(west, place.east_m - around_m);
    east = std::max(east, place.east_m + around_m);
  };
  for (const TrackPoint& point : record.track) show(point.place, 0);
  for (const OtherTrack& other : record.others)
    if (!other.name.empty())
      for (const auto& point : other.points) show(point.place, 0);
  for (const PlannedRoute& route : record.routes)
    for (const Local& point : route.points) show(point, 0);
  for (const Target& target : record.targets)
    for (const Local& point : target.line) show(point, 0);
  for (const KnownThreat& threat : record.threats) show(threat.place, 0);
  for (const NoFlyZone& zone : record.zones)
    for (const Local& corner : zone.outline) show(corner, 0);
  if (south > north || columns < 2) return {};
  constexpr double kMargin_m = 5000;
  GroundGrid grid;
  grid.south_m = south - kMargin_m;
  grid.west_m = west - kMargin_m;
  grid.spacing_m = (east - west + 2 * kMargin_m) / static_cast<double>(columns - 1);
  grid.columns = columns;
  const auto rows =
      static_cast<std::size_t>(std::ceil((north - south + 2 * kMargin_m) / grid.spacing_m)) + 1;
  for (std::size_t row = 0; row < rows; ++row)
    for (std::size_t column = 0; column < columns; ++column)
      grid.heights_m.push_back(
          height_m(grid.south_m + static_cast<double>(row) * grid.spacing_m,
                   grid.west_m + static_cast<double>(column) * grid.spacing_m));
  return grid;
}

std::string to_json(const MissionRecord& record) {
  const Verdict& verdict = record.verdict;
  Json json{{"mission", record.mission},
            {"verdict", verdict.passed ? "passed" : "failed"},
            {"flown", verdict.flown},
            {"reason", verdict.reason},
            {"headline", headline(record)},
            {"duration_s", verdict.duration_s},
            {"distance_m", verdict.distance_m},
            {"checks", verdict.checks},
            {"tracked_s", record.tracked_s},
            {"survival", record.survival},
            {"lost_samples", record.lost_samples},
            {"command", record.command},
            {"origin", record.origin},
            {"phases", record.phases},
            {"modes", record.modes},
            {"targets", record.targets},
            {"truths", record.truths},
            {"threats", record.threats},
            {"zones", record.zones},
            {"decisions", record.decisions},
            {"faults", record.faults},
            {"flags", flags_of(record)},
            {"routes", record.routes},
            {"footprints", record.footprints},
            {"latencies", record.latencies},
            {"others", record.others},
            {"track", columns_of(record.track)},
            {"ground", record.ground}};
  round_all(json);
  return json.dump(-1, ' ', false, Json::error_handler_t::replace) + "\n";
}

std::string to_html(const MissionRecord& record) { return page_of(to_json(record)); }

}  // namespace reconnaissance
