#pragma once

#include <string>
#include <vector>

#include "skein/inspector.hpp"

namespace skein::command {

/// Publishers and subscriptions of a topic that share a system and do not hear each other, since
/// their types differ, in name or in version: a sentence for each two entities. `endpoints` are
/// those of any number of topics.
std::vector<std::string> type_conflicts(const std::vector<KnownTopic::Endpoint>& endpoints);

}  // namespace skein::command
