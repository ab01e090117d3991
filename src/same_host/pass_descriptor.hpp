#pragma once

#include <cstddef>
#include <span>

#include "core/system/close_elsewhere.hpp"

/// Packets of a Unix socket, with which a descriptor may go. Neither function waits.
namespace skein::same_host {

/// With no descriptor where it is negative. Whether the packet was sent.
bool pass(int socket, std::span<const std::byte> packet, int descriptor);

/// Whether a packet of just that size was received. Of several descriptors the last one is kept.
bool receive_passed(int socket, std::span<std::byte> packet, HandedOver& descriptor);

}  // namespace skein::same_host
