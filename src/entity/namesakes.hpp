#pragma once

#include <cstdint>
#include <set>
#include <string>
#include <utility>

#include "brokerless_discovery/table.hpp"

namespace skein::entity {

/// Notices entities of the same name in other processes: callers are then served by either. Not
/// thread-safe.
class Namesakes {
 public:
  /// `process`: this one's number on `host`, which is ServiceDescription::host.
  Namesakes(std::string system, std::string entity, std::string host, std::uint32_t process)
      : system_(std::move(system)),
        entity_(std::move(entity)),
        host_(std::move(host)),
        process_(process) {}

  /// What is to be told where that is a service of a namesake that lives; once for each process,
  /// otherwise empty.
  std::string look_at(const brokerless_discovery::Change& change);

 private:
  const std::string system_;
  const std::string entity_;
  const std::string host_;
  const std::uint32_t process_;
  std::set<std::pair<std::string, std::uint32_t>> told_;
};

}  // namespace skein::entity
