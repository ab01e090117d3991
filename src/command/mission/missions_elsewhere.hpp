#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "command/doctor/facts.hpp"

namespace skein::command {

/// For who finds nothing on a domain: `missions fly here on domain 42`. Empty where one flies on
/// that domain, or none on this host.
std::string missions_elsewhere(std::uint32_t domain, const std::vector<std::uint32_t>& flying);

/// The same, of the missions that fly on this host now.
std::string missions_elsewhere(std::uint32_t domain);

/// Whether one flies on that domain now, by a launcher of this host.
bool mission_flies_on(std::uint32_t domain);

/// For who launches a mission on a domain where others fly, by their launchers. Empty where none
/// does.
std::string missions_beside(std::uint32_t domain, const std::vector<doctor::Launcher>& launchers);

/// The same, of the launchers of this host.
std::string missions_beside(std::uint32_t domain);

}  // namespace skein::command
