#pragma once

#include <sys/types.h>

#include <span>
#include <string>

namespace skein::command {

/// Starts a program of PATH as a child that has none of this process's descriptors and blocked
/// signals. `input` and `output` become its own; errors go nowhere. Throws Unavailable with the
/// reason if it does not start; the caller waits for its end.
pid_t start_program(std::span<const std::string> words, int input, int output);

}  // namespace skein::command
