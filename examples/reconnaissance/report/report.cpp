#include "report/report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <nlohmann/json.hpp>
#include <numbers>

#include "report/page.hpp"

namespace reconnaissance {
namespace {

using Json = nlohmann::ordered_json;

/// A page is read by people, and it is small: no more digits than it can show.
Json rounded(double value, int digits) {
  if (!std::isfinite(value)) return nullptr;
  const double scale = std::pow(10, digits);
  const double result = std::round(value * scale) / scale;
  return result == 0 ? 0.0 : result;
}

double degrees(double radians) { return radians * 180 / std::numbers::pi; }

Json json(const Local& place) {
  return {rounded(place.north_m, 1), rounded(place.east_m, 1), rounded(place.height_m, 1)};
}

template <class Item, class Make>
Json list(const std::vector<Item>& items, Make make) {
  Json result = Json::array();
  for (const Item& item : items) result.push_back(make(item));
  return result;
}

Json json(const std::vector<Local>& places) {
  return list(places, [](const Local& place) { return json(place); });
}

Json seconds(const std::optional<double>& time_s) {
  return time_s ? rounded(*time_s, 2) : Json(nullptr);
}

Json json(const Check& check) {
  return {{"name", check.name}, {"passed", check.passed}, {"text", check.text}};
}

Json json(const GroundGrid& ground) {
  return {{"south_m", rounded(ground.south_m, 1)},
          {"west_m", rounded(ground.west_m, 1)},
          {"spacing_m", rounded(ground.spacing_m, 3)},
          {"columns", ground.columns},
          {"heights_m", list(ground.heights_m, [](double height) { return rounded(height, 0); })}};
}

/// In columns, which tables are read from, and which are half as long.
Json columns_of(const std::vector<TrackPoint>& track) {
  const auto column = [&](int digits, auto value) {
    return list(track, [&](const TrackPoint& point) { return rounded(value(point), digits); });
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

Json json(const std::vector<OtherTrack::Point>& points) {
  return list(points, [](const OtherTrack::Point& at) {
    return Json{rounded(at.time_s, 2), rounded(at.place.north_m, 1), rounded(at.place.east_m, 1),
                rounded(at.place.height_m, 1)};
  });
}

Json json(const OtherTrack& other) {
  return {{"number", other.number}, {"name", other.name}, {"points", json(other.points)}};
}

Json json(const PlannedRoute& route) {
  return {{"from_s", rounded(route.from_s, 2)},
          {"planner", route.planner},
          {"points", json(route.points)}};
}

Json json(const KnownThreat& threat) {
  return {{"number", threat.number},
          {"kind", threat.kind},
          {"from_s", rounded(threat.from_s, 2)},
          {"place", json(threat.place)},
          {"deviation_m", rounded(threat.deviation_m, 0)},
          {"detection_range_m", rounded(threat.detection_range_m, 0)},
          {"lethal_range_m", rounded(threat.lethal_range_m, 0)}};
}

Json json(const NoFlyZone& zone) { return {{"name", zone.name}, {"outline", json(zone.outline)}}; }

Json json(const Target& target) {
  return {{"name", target.name},
          {"line", json(target.line)},
          {"priority", rounded(target.priority, 3)},
          {"wanted_sample_m", rounded(target.wanted_sample_m, 3)},
          {"achieved_sample_m", rounded(target.achieved_sample_m, 3)},
          {"deviation_m", rounded(target.deviation_m, 1)},
          {"collected_s", seconds(target.collected_s)},
          {"wanted_s", rounded(target.wanted_s, 1)},
          {"followed_s", rounded(target.followed_s, 1)},
          {"wanted_deviation_m", rounded(target.wanted_deviation_m, 1)},
          {"path", json(target.path)}};
}

Json json(const TrueThing& thing) { return {{"name", thing.name}, {"points", json(thing.points)}}; }

Json json(const ImagedGround& footprint) {
  return {{"time_s", rounded(footprint.time_s, 2)},
          {"target", footprint.target},
          {"corners", json(footprint.corners)},
          {"sample_m", rounded(footprint.sample_m, 3)}};
}

Json json(const Stage& stage) {
  return {{"from_s", rounded(stage.from_s, 2)}, {"name", stage.name}, {"reason", stage.reason}};
}

Json json(const Answer& answer) {
  return {{"name", answer.name},
          {"outcome", answer.outcome},
          {"reason", answer.reason},
          {"took_s", rounded(answer.took_s, 6)}};
}

Json json(const DecisionTold& decision) {
  return {{"time_s", rounded(decision.time_s, 2)},
          {"entity", decision.entity},
          {"question", decision.question},
          {"chosen", decision.chosen},
          {"reason", decision.reason},
          {"took_s", rounded(decision.took_s, 6)},
          {"late", decision.late},
          {"answers", list(decision.answers, [](const Answer& each) { return json(each); })}};
}

Json json(const Fault& fault) {
  return {{"from_s", rounded(fault.from_s, 2)},
          {"until_s", seconds(fault.until_s)},
          {"what", fault.what},
          {"noticed_by", fault.noticed_by},
          {"noticed_s", rounded(fault.noticed_s, 2)},
          {"answer", fault.answer}};
}

Json json(const Flag& flag) {
  return {{"time_s", rounded(flag.time_s, 2)}, {"severe", flag.severe}, {"text", flag.text}};
}

/// In order; of many, as many evenly spread ones as a histogram can show, the least and the
/// greatest among them.
Json json(const Latencies& latencies) {
  constexpr std::size_t kShown = 400;
  std::vector<double> sorted = latencies.seconds;
  std::ranges::sort(sorted);
  const std::size_t count = std::min(sorted.size(), kShown);
  Json seconds = Json::array();
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t place = count < 2 ? 0 : i * (sorted.size() - 1) / (count - 1);
    seconds.push_back(rounded(sorted[place], 6));
  }
  return {{"name", latencies.name}, {"count", sorted.size()}, {"seconds", seconds}};
}

template <class Item>
Json list(const std::vector<Item>& items) {
  return list(items, [](const Item& item) { return json(item); });
}

Json json(const MissionRecord& record) {
  const Verdict& verdict = record.verdict;
  return {{"mission", record.mission},
          {"verdict", verdict.passed ? "passed" : "failed"},
          {"flown", verdict.flown},
          {"reason", verdict.reason},
          {"headline", headline(record)},
          {"duration_s", rounded(verdict.duration_s, 2)},
          {"distance_m", rounded(verdict.distance_m, 0)},
          {"checks", list(verdict.checks)},
          {"tracked_s", rounded(record.tracked_s, 1)},
          {"survival", rounded(record.survival, 4)},
          {"lost_samples", record.lost_samples},
          {"command", record.command},
          {"origin",
           {{"latitude_deg", rounded(record.origin.latitude_deg, 7)},
            {"longitude_deg", rounded(record.origin.longitude_deg, 7)}}},
          {"phases", list(record.phases)},
          {"modes", list(record.modes)},
          {"targets", list(record.targets)},
          {"truths", list(record.truths)},
          {"threats", list(record.threats)},
          {"zones", list(record.zones)},
          {"decisions", list(record.decisions)},
          {"faults", list(record.faults)},
          {"flags", list(flags_of(record))},
          {"routes", list(record.routes)},
          {"footprints", list(record.footprints)},
          {"latencies", list(record.latencies)},
          {"others", list(record.others)},
          {"track", columns_of(record.track)},
          {"ground", json(record.ground)}};
}

std::string text_of(const Json& value, int indent) {
  return value.dump(indent, ' ', false, Json::error_handler_t::replace);
}

std::string html_escaped(const std::string& text) {
  std::string result;
  for (const char c : text) {
    switch (c) {
      case '&':
        result += "&amp;";
        break;
      case '<':
        result += "&lt;";
        break;
      case '>':
        result += "&gt;";
        break;
      case '"':
        result += "&quot;";
        break;
      default:
        result += c;
    }
  }
  return result;
}

/// Inside of a script element no text may end it, or begin a comment.
std::string script_escaped(const std::string& json) {
  std::string result;
  for (const char c : json) {
    if (c == '<' || c == '>' || c == '&') {
      result += fmt::format("\\u{:04x}", static_cast<unsigned>(c));
    } else {
      result += c;
    }
  }
  return result;
}

std::string duration(double seconds) {
  const long whole = std::lround(seconds);
  return fmt::format("{} min {:02} s", whole / 60, whole % 60);
}

const char* verdict_word(const Verdict& verdict) {
  if (verdict.passed) return "Passed";
  return verdict.flown ? "Failed" : "Not flown to its end";
}

/// What the first line says, point by point; the first is the verdict.
std::vector<std::string> points_of(const MissionRecord& record) {
  const auto collected = std::ranges::count_if(
      record.targets, [](const Target& target) { return target.collected_s.has_value(); });
  const auto late = std::ranges::count_if(record.decisions, &DecisionTold::late);
  const auto misses = static_cast<std::size_t>(late) + record.lost_samples;
  return {verdict_word(record.verdict),
          duration(record.verdict.duration_s),
          fmt::format("{:.1f} km", record.verdict.distance_m / 1000),
          fmt::format("{} of {} targets", collected, record.targets.size()),
          fmt::format("tracked {:.0f} s, survival {:.3f}", record.tracked_s, record.survival),
          fmt::format("{} {}", misses, misses == 1 ? "miss" : "misses")};
}

/// With the points apart, so that a narrow page breaks the line between them.
std::string first_line(const MissionRecord& record) {
  std::string line;
  for (const std::string& point : points_of(record))
    line +=
        fmt::format("{}<span{}>{}</span>", line.empty() ? "" : "<span class=\"point\"> · </span>",
                    line.empty() ? " class=\"verdict\"" : "", html_escaped(point));
  return line;
}

/// What is not UTF-8 is shown as such, as in JSON.
std::string valid(const std::string& text) {
  return Json::parse(text_of(Json(text), -1)).get<std::string>();
}

}  // namespace

std::string headline(const MissionRecord& record) {
  return fmt::format("{}", fmt::join(points_of(record), " · "));
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

std::string to_json(const MissionRecord& record) { return text_of(json(record), -1) + "\n"; }

std::string to_html(const MissionRecord& record) {
  const char* state = record.verdict.passed ? "passed" : "failed";
  return fmt::format(
      "<!doctype html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
      "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n"
      "<title>{0}: {1}</title>\n<style>\n{2}</style>\n</head>\n<body>\n"
      "<header class=\"{3}\"><p class=\"mission\">{0}</p><h1>{7}</h1></header>\n{4}"
      "<script id=\"record\" type=\"application/json\">{5}</script>\n<script>\n{6}</script>\n"
      "</body>\n</html>\n",
      html_escaped(valid(record.mission)), html_escaped(headline(record)), page::kStyle, state,
      page::kBody, script_escaped(text_of(json(record), -1)), page::kScript, first_line(record));
}

}  // namespace reconnaissance
