#pragma once

#include <string>
#include <vector>

#include "command/look/domain_picture.hpp"
#include "command/look/topic_findings.hpp"

namespace skein::command::doctor {

/// Providers of one service in one system that no one client can call, since they were built from
/// two versions of its interface: a sentence for each two. `tell_types` is asked about these
/// services as it is about topics.
std::vector<std::string> service_conflicts(const DomainPicture& picture,
                                           const TellTypes& tell_types);

}  // namespace skein::command::doctor
