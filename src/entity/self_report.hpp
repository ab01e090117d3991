#pragma once

#include "skein/detail/channel.hpp"
#include "skein/inspection.idl.hpp"
#include "topics/register.hpp"

namespace skein::introspection {

/// What the system says of this process; vendor, services and `degraded` are left to the entity.
inspection::Peer report_of_this_process();

inspection::TopicEndpoint report_of(const topics::Endpoint& endpoint);
inspection::Connection report_of(const ConnectionInfo& connection);

}  // namespace skein::introspection
