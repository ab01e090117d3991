#pragma once

#include <optional>
#include <string>

#include "skein/clock.hpp"
#include "skein/parameters.hpp"

namespace skein::navigation {

// The values of parameters, as profiles and callers write them. All throw InvalidArgument, with the
// parameter's name, for a text that is no such value.

/// A number, or `otherwise` where the parameter has no value.
double number_of(const ParameterValues& values, const std::string& name, double otherwise);

/// A length of time; a bare number counts milliseconds.
std::optional<Duration> duration_of(const ParameterValues& values, const std::string& name);

}  // namespace skein::navigation
