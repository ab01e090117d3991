#include "verdict.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace reconnaissance {
namespace {

// Nearer to the runway an aircraft may be low.
constexpr double kAirfield_m = 5000;
constexpr double kStood_m_s = 0.5;

std::string xml(const std::string& text) {
  std::string result = "\"";
  for (const char c : text) {
    if (c == '&') {
      result += "&amp;";
    } else if (c == '<') {
      result += "&lt;";
    } else if (c == '"') {
      result += "&quot;";
    } else {
      result += static_cast<unsigned char>(c) < 0x20 ? ' ' : c;
    }
  }
  return result + '"';
}

}  // namespace

Judge::Judge(const PassConditions& conditions, const Local& aim)
    : conditions_(conditions), aim_(aim) {}

void Judge::count(std::size_t collected, std::size_t wanted, const std::string& what) {
  how_collected_ = what;
  collected_ = collected;
  wanted_ = wanted;
}

void Judge::meet(const Local& other) {
  if (last_.on_ground) return;
  const double level = map_distance_m(other, last_.position);
  const double height = other.height_m - last_.position.height_m;
  const double separation = std::max(level / conditions_.well_clear_m,
                                     std::abs(height) / conditions_.well_clear_height_m);
  if (separation >= separation_) return;
  separation_ = separation;
  nearest_ = {level, 0, height};
}

void Judge::suffer(double survival, double tracked_s) {
  survival_ = survival;
  tracked_s_ = tracked_s;
}

void Judge::see(const Sample& sample) {
  if (!took_off_s_ && !sample.on_ground) took_off_s_ = sample.time_s;
  if (took_off_s_ && !touched_) {
    measure_clearance(sample);
    distance_m_ += sample.ground_speed_m_s * std::max(0.0, sample.time_s - last_.time_s);
    stalled_ = stalled_ || sample.stalled;
    if (sample.on_ground) touched_ = sample.position;
  }
  if (touched_ && !stood_s_ && sample.ground_speed_m_s < kStood_m_s) stood_s_ = sample.time_s;
  if (!stood_s_ || *stood_s_ == sample.time_s) last_ = sample;
}

void Judge::measure_clearance(const Sample& sample) {
  if (map_distance_m(sample.position, aim_) > kAirfield_m)
    clearance_m_ = std::min(clearance_m_, sample.height_above_ground_m);
}

Verdict Judge::conclude(const std::string& ended, const std::vector<Check>& more) const {
  Verdict verdict;
  verdict.flown = standing();
  verdict.duration_s = took_off_s_ ? duration_s() : 0;
  verdict.distance_m = distance_m_;
  const auto check = [&](const char* name, bool passed, std::string text) {
    verdict.checks.push_back({name, passed, std::move(text)});
  };
  check("flown to its end", standing(),
        standing() ? "the aircraft has landed, and stands"
                   : (ended.empty() ? "the aircraft has not landed" : ended));
  check("duration", took_off_s_ && !too_long(),
        fmt::format("{:.0f} s in the air and on the runway, at most {:.0f}", verdict.duration_s,
                    conditions_.longest_s));
  check("targets", collected_ >= wanted_,
        fmt::format("{} of {} elements {}", collected_, wanted_, how_collected_) +
            (collected_ >= wanted_ || why_home_.empty() ? "" : "; it flew home: " + why_home_));
  verdict.checks.insert(verdict.checks.end(), more.begin(), more.end());
  check("survival", survival_ >= conditions_.least_survival,
        fmt::format("survived the air defence with a probability of {:.3f}, at least {:.3f}; "
                    "tracked for {:.0f} s",
                    survival_, conditions_.least_survival, tracked_s_));
  check("clearance", clearance_m_ >= conditions_.least_clearance_m,
        std::isinf(clearance_m_)
            ? "it was never more than 5 km from the runway"
            : fmt::format("{:.0f} m above ground at the lowest place of the way, at least {:.0f}",
                          clearance_m_, conditions_.least_clearance_m));
  check("well clear", separation_ >= 1,
        std::isinf(separation_)
            ? "there was no other aircraft"
            : fmt::format("{:.0f} m beside and {:.0f} m above or below at the closest, at least "
                          "{:.0f} or {:.0f}",
                          nearest_.north_m, std::abs(nearest_.height_m), conditions_.well_clear_m,
                          conditions_.well_clear_height_m));
  check("no stall", !stalled_, stalled_ ? "the aircraft has stalled" : "it never stalled");
  if (touched_) {
    const double from_aim = map_distance_m(*touched_, aim_);
    check("landing", from_aim <= conditions_.landed_within_m,
          fmt::format("touched down {:.0f} m from the aiming point, at most {:.0f}", from_aim,
                      conditions_.landed_within_m));
  } else {
    check("landing", false, "did not touch down");
  }
  check("fuel", last_.fuel_kg >= conditions_.least_fuel_kg,
        fmt::format("{:.1f} kg left, at least {:.1f}", last_.fuel_kg, conditions_.least_fuel_kg));
  const auto failed = std::find_if(verdict.checks.begin(), verdict.checks.end(),
                                   [](const Check& each) { return !each.passed; });
  verdict.passed = failed == verdict.checks.end();
  if (!verdict.passed) verdict.reason = failed->name + ": " + failed->text;
  return verdict;
}

Verdict joint_verdict(const std::vector<OfAircraft<Verdict>>& verdicts) {
  Verdict joint{true, true, "", 0, 0, {}};
  for (const auto& [aircraft, verdict] : verdicts) {
    joint.flown = joint.flown && verdict.flown;
    joint.passed = joint.passed && verdict.passed;
    if (joint.reason.empty() && !verdict.reason.empty())
      joint.reason = aircraft + " " + verdict.reason;
    joint.duration_s = std::max(joint.duration_s, verdict.duration_s);
    joint.distance_m += verdict.distance_m;
    for (const Check& each : verdict.checks)
      joint.checks.push_back({aircraft + " " + each.name, each.passed, each.text});
  }
  return joint;
}

int exit_code(const Verdict& verdict) {
  if (!verdict.flown) return kNotFlown;
  return verdict.passed ? kPassed : kFailed;
}

std::string to_junit(const Verdict& verdict, const std::string& mission) {
  const auto failures = std::count_if(verdict.checks.begin(), verdict.checks.end(),
                                      [](const Check& check) { return !check.passed; });
  std::string text = fmt::format(
      "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<testsuite name={} tests=\"{}\" "
      "failures=\"{}\" time=\"{:.2f}\">\n",
      xml(mission), verdict.checks.size(), failures, verdict.duration_s);
  for (const Check& check : verdict.checks) {
    text += fmt::format("  <testcase classname={} name={}", xml(mission), xml(check.name));
    text +=
        check.passed ? "/>\n" : fmt::format("><failure message={}/></testcase>\n", xml(check.text));
  }
  return text + "</testsuite>\n";
}

}  // namespace reconnaissance
