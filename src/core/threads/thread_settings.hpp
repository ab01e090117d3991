#pragma once

#include <string>

#include "skein/executor.hpp"

namespace skein {

/// Throws InvalidArgument, which names `owner`, for what can never work: a number out of its range,
/// a priority without a real-time policy, a CPU that this machine does not have.
void check(const ThreadSettings& settings, const std::string& owner);

/// Makes the calling thread run so. What the system refuses is logged as a warning with its remedy,
/// and the rest holds. `owner` is for messages.
void apply(const ThreadSettings& settings, const std::string& owner);

/// Keeps all memory of this process, present and future, out of the pager's hands; thread stacks
/// are then resident at their full size. False, with a warning that names the remedy, where the
/// system refuses or would let later allocations fail.
bool lock_memory();

}  // namespace skein
