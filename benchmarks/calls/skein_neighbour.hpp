#pragma once

#include <memory>
#include <string>

#include "calls/skein_peer.hpp"
#include "dds/port.hpp"

namespace skein::benchmarks {

/// Throws Skipped where it is not installed.
std::shared_ptr<dds::Vendor> load_or_skip(const std::string& vendor);

/// Provides a service and obeys, once it knows the services of all `peer.peers`.
void be_neighbour(const SkeinPeer& peer);

/// A participant of the port with no endpoint: obeys, once it knows all `peer.peers` participants.
void be_bystander(const SkeinPeer& peer);

}  // namespace skein::benchmarks
