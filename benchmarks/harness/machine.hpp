#pragma once

#include <string>
#include <utility>
#include <vector>

namespace skein::benchmarks {

/// Name and value of what measured times depend on: processor, cores, governor, kernel, limits of
/// socket buffers, load when the run began. What cannot be known says so.
using MachineFacts = std::vector<std::pair<std::string, std::string>>;

/// Ask before enter_private_network(): limits of the host are not visible from inside.
MachineFacts machine_facts();

}  // namespace skein::benchmarks
