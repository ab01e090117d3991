#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace skein {
struct EntityOptions;
}

namespace skein::command {

/// Where a command that only looks at a domain joins it.
struct Onlooker {
  std::string vendor = "cyclonedds";
  std::uint32_t domain = 0;
  std::string interface;
  std::vector<std::string> peers;
  bool multicast = false;
  std::string profile;
  std::string host;

  /// The domain that it looks at: the option's or the profile's.
  std::uint32_t watched_domain() const;

  /// What an entity of the command's `name` joins with. Throws what reading the profile throws, and
  /// InvalidArgument where none of its peers is of this host, or options are missing.
  EntityOptions entity_options(const std::string& name) const;
};

}  // namespace skein::command
