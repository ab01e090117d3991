#include "mission_text.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <sstream>

namespace route_planning {
namespace {

constexpr std::size_t kWidth = 100;
constexpr std::size_t kTextColumn = 12;

double in_ms(skein::Duration duration) {
  return std::chrono::duration<double, std::milli>(duration).count();
}

void print_line(const std::string& line) {
  fmt::print("{}\n", line);
  std::fflush(stdout);
}

std::string role_of(const AE_navigatorI::PlannerCandidate& planner, const Answer& answer) {
  if (!planner.available) return "not there";
  std::string role;
  for (const auto& attempt : answer.report.attempts) {
    if (attempt.planner == planner.planner) role = attempt.outcome;
  }
  if (!role.empty()) return role;
  return planner.quarantined ? "in quarantine" : "available";
}

/// As wide as the columns under "measured".
std::string measured(const AE_navigatorI::PlannerCandidate& planner) {
  if (planner.runs == 0) return fmt::format("   {:<36}", "no figures");
  if (planner.p95_ms == 0) return fmt::format("   no answer in {:<3} {:<20}", planner.runs, "runs");
  return fmt::format("{:>5.0f}{:>7.0f} ms{:>8.2f}{:>6}{:>8.0f} %", planner.median_ms,
                     planner.p95_ms, planner.measured_quality, planner.runs,
                     100 * planner.accepted);
}

}  // namespace

void print_heading(std::string_view title) {
  std::string line = fmt::format("\n── {} ", title);
  // The dashes have three bytes each; the rest of a title is ASCII.
  for (std::size_t column = title.size() + 4; column < kWidth; ++column) line += "─";
  print_line(line);
}

void print_field(std::string_view label, std::string_view text) {
  std::istringstream words{std::string(text)};
  std::string line = fmt::format("  {:<{}}", label, kTextColumn - 2);
  bool first = true;
  for (std::string word; words >> word; first = false) {
    if (!first && line.size() + 1 + word.size() > kWidth) {
      print_line(line);
      line.assign(kTextColumn, ' ');
      first = true;
    }
    line += (first ? "" : " ") + word;
  }
  print_line(line);
}

void print_planners(const Answer& answer) {
  auto planners = answer.report.candidates;
  std::stable_sort(planners.begin(), planners.end(), [](const auto& a, const auto& b) {
    return a.declared_quality > b.declared_quality;
  });
  print_line(fmt::format("  {:<22}{:>17}   {:>31}", "planners", "declared",
                         "measured on similar requests"));
  print_line(fmt::format("{:24}{:>9}{:>8}   {:>5}{:>7}{:>11}{:>6}{:>10}   {}", "", "latency",
                         "quality", "p50", "p95", "quality", "runs", "reliable", "here"));
  for (const auto& planner : planners) {
    print_line(fmt::format("{:12}{:<12}{:>6.0f} ms{:>8.2f}   {}   {}", "", planner.planner,
                           planner.declared_ms, planner.declared_quality, measured(planner),
                           role_of(planner, answer)));
  }
}

void print_decision(const Answer& answer) {
  const auto& attempts = answer.report.attempts;
  if (attempts.empty()) return print_field("why", answer.report.failure);
  std::uint32_t epoch = attempts.front().threat_epoch;
  for (std::size_t i = 0; i < attempts.size(); ++i) {
    const auto& attempt = attempts[i];
    if (attempt.threat_epoch != epoch) {
      epoch = attempt.threat_epoch;
      print_field("anew", fmt::format("with threat picture {}, from the AD manager", epoch));
    }
    print_field(i == 0 ? "why" : "", fmt::format("{}. {}", i + 1, attempt.reason));
    std::string outcome = fmt::format("{} after {:.0f} ms", attempt.outcome, attempt.took_ms);
    if (!attempt.check.empty()) outcome += fmt::format(" by the check '{}'", attempt.check);
    if (!attempt.text.empty()) outcome += ": " + attempt.text;
    print_field("", "   => " + outcome);
  }
}

void print_refusal(const Answer& answer) {
  std::string text = answer.proven ? "there is no route, with a proof" : "no route was found";
  if (answer.report.attempts.empty()) text += ": " + answer.refusal;
  print_field("refused", text);
}

void print_route(const AE_navigator::Route& route) {
  std::string text = fmt::format(
      "{:.2f} km by {}, lowest {:.0f} m above ground, radar exposure {:.2f} km, {} waypoints",
      route.length_m / 1000, route.planner, route.lowest_height_above_ground_m,
      route.radar_exposure / 1000, route.waypoints.size());
  if (route.expected_kills > 0)
    text += fmt::format(", survived with {:.1f} %", 100 * std::exp(-route.expected_kills));
  print_field("route", text);
}

void print_time(const Answer& answer, skein::Duration allowed) {
  std::string text = fmt::format("{:.1f} of {:.0f} ms", in_ms(answer.took), in_ms(allowed));
  if (answer.times_asked > 1) text += fmt::format("; asked {} times", answer.times_asked);
  print_field("time", text);
}

}  // namespace route_planning
