#include "mission_text.hpp"

#include <fmt/core.h>

#include <algorithm>
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
  const auto& tried = answer.report.tried;
  const auto found = std::find(tried.begin(), tried.end(), planner.planner);
  if (found == tried.end()) return "stood by";
  const bool answered = answer.route && found + 1 == tried.end();
  return answered ? "chosen, gave the route" : "chosen, gave no route";
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
  std::stable_sort(planners.begin(), planners.end(),
                   [](const auto& a, const auto& b) { return a.quality > b.quality; });
  bool first = true;
  for (const auto& planner : planners) {
    print_line(fmt::format("  {:<10}{:<12}{:>6.0f} ms   quality {:<6.2f}  {}",
                           first ? "planners" : "", planner.planner, planner.predicted_latency_ms,
                           planner.quality, role_of(planner, answer)));
    first = false;
  }
}

void print_decision(const Answer& answer) {
  std::istringstream lines(answer.report.reason);
  std::size_t number = 0;
  for (std::string line; std::getline(lines, line); ++number) {
    const auto& tried = answer.report.tried;
    const std::string count = tried.size() > 1 ? fmt::format("{}. ", number + 1) : "";
    print_field(number == 0 ? "why" : "", count + line);
  }
}

void print_route(const AE_navigator::Route& route) {
  print_field("route",
              fmt::format("{:.2f} km by {}, lowest {:.0f} m above ground, radar exposure "
                          "{:.2f} km, {} waypoints",
                          route.length_m / 1000, route.planner, route.lowest_height_above_ground_m,
                          route.radar_exposure / 1000, route.waypoints.size()));
}

void print_time(const Answer& answer, skein::Duration allowed) {
  std::string text = fmt::format("{:.1f} of {:.0f} ms", in_ms(answer.took), in_ms(allowed));
  if (answer.times_asked > 1) text += fmt::format("; asked {} times", answer.times_asked);
  print_field("time", text);
}

}  // namespace route_planning
