#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace skein::command {

/// For who finds nothing on a domain: `missions fly here on domain 42`. Empty where one flies on
/// that domain, or none on this host.
std::string missions_elsewhere(std::uint32_t domain, const std::vector<std::uint32_t>& flying);

/// The same, of the missions that fly on this host now.
std::string missions_elsewhere(std::uint32_t domain);

}  // namespace skein::command
