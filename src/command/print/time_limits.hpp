#pragma once

#include <string>

#include "skein/clock.hpp"

namespace skein::command {

/// Of seconds, as options have them.
Duration duration_of(double seconds);

/// What a TimedOut says, with the option --within as the remedy; in C++ that is a function.
std::string at_command_line(std::string text);

}  // namespace skein::command
