#pragma once

#include <string>

namespace skein::launch {

/// The limit in words; empty where there is none.
std::string address_space_limit();

/// Throws Unavailable, which names the limit, where this process may not have the addresses that an
/// entity needs (`ulimit -v`): its vendor's threads would fail somewhere on the way. Without a
/// limit it does nothing.
void demand_address_space();

}  // namespace skein::launch
