#pragma once

#include <functional>
#include <string>
#include <vector>

#include "mission/xml/finding.hpp"

namespace skein::launch {

/// Says what begins now: the finding that this becomes, with "ends its process ..." or "takes
/// longer than ..." behind its problem, where it does not come to an end.
using TellStep = std::function<void(const profile::Finding& step)>;
using Look = std::function<std::vector<profile::Finding>(const TellStep& tell_step)>;

/// What `look` finds, in a process of its own that ends with the calling thread: what is loaded to
/// be looked at neither stays here, nor ends this process. Where that one crashes or takes longer
/// than half a minute, the last step that was told is a finding. Other findings of no place are of
/// `file`. Throws Unavailable where there can be no process.
std::vector<profile::Finding> findings_apart(const Look& look, const std::string& file);

}  // namespace skein::launch
