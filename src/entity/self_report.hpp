#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "skein/detail/channel.hpp"
#include "skein/inspection.idl.hpp"
#include "skein/introspection.idl.hpp"
#include "topics/register.hpp"

namespace skein::introspection {

/// What the system says of this process; vendor, services and `degraded` are left to the entity.
inspection::Peer report_of_this_process();

inspection::TopicEndpoint report_of(const topics::Endpoint& endpoint);
inspection::Connection report_of(const ConnectionInfo& connection);

/// What this process has logged since it was asked before, as the entity `system/name` tells it.
/// After a call with `anew`, which returns nothing, the next one returns all that is kept.
class LogReport {
 public:
  explicit LogReport(std::string entity) : entity_(std::move(entity)) {}
  std::vector<LogLine> operator()(bool anew);

 private:
  std::string entity_;
  std::uint64_t told_ = 0;
};

}  // namespace skein::introspection
