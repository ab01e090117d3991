#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "navigation/route_checker/route_checker.hpp"
#include "navigator_link.hpp"

namespace route_planning {

// What the mission prints: plain text of 100 columns on standard output, flushed piece by piece.

/// A rule across the page with a title in it.
void print_heading(std::string_view title);

/// A label and its text, which is wrapped and indented behind the label.
void print_field(std::string_view label, std::string_view text);

/// Which planners were available, what their descriptions declare beside what they have shown on
/// similar requests, and what came of those that were tried.
void print_planners(const Answer& answer);

/// For each planner that was tried: why it was, and what came of it.
void print_decision(const Answer& answer);

/// That there is no route, and whether that is proved; where no planner was tried, why.
void print_refusal(const Answer& answer);

void print_route(const AE_navigator::Route& route);

/// `took`, beside what the question allowed.
void print_time(const Answer& answer, skein::Duration allowed);

}  // namespace route_planning
