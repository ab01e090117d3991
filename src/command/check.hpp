#pragma once

#include <vector>

#include "commands.hpp"
#include "profile/finding.hpp"

namespace skein::command {

/// What `skein check` finds. Throws nothing for what files can contain.
std::vector<profile::Finding> findings_of(const CheckArguments& arguments);

}  // namespace skein::command
