#pragma once

#include <cstdint>

#include "facts.hpp"
#include "symptom.hpp"

/// What facts mean for a purpose. Pure functions; each tells at least one symptom, if only that all
/// is fine.
namespace skein::command::doctor {

Symptoms diagnose(const Purpose& purpose, const Facts& facts);

/// The parts of it: what concerns the network, and what concerns this system beside it.
Symptoms diagnose_network(const Purpose& purpose, const Facts& facts);
Symptoms diagnose_system(const Purpose& purpose, const Facts& facts);

struct PortRange {
  std::uint16_t first;
  std::uint16_t last;
};

/// The UDP ports of a domain.
PortRange ports_of(std::uint32_t domain);

}  // namespace skein::command::doctor
