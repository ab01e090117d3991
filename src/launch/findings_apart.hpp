#pragma once

#include <functional>
#include <string>
#include <vector>

#include "profile/finding.hpp"

namespace skein::launch {

/// What `look` finds, in a process of its own that ends with the calling thread: what is loaded to
/// be looked at neither stays here, nor ends this process. Where that one crashes or takes longer
/// than half a minute, a finding says so, of `file`. Throws Unavailable where there can be no
/// process.
std::vector<profile::Finding> findings_apart(
    const std::function<std::vector<profile::Finding>()>& look, const std::string& file);

}  // namespace skein::launch
