#pragma once

#include <cstddef>
#include <initializer_list>
#include <span>

#include "core/system/close_elsewhere.hpp"

/// Packets of a Unix socket, with which descriptors may go. Neither function waits.
namespace skein::same_host {

/// Whether the packet was sent, with these descriptors: kMostPassed at most.
bool pass(int socket, std::span<const std::byte> packet, std::initializer_list<int> descriptors);
inline constexpr std::size_t kMostPassed = 2;

/// Whether a packet of just that size was received. The first descriptors that came with it are put
/// into `descriptors`; further ones are closed.
bool receive_passed(int socket, std::span<std::byte> packet, std::span<HandedOver> descriptors);

}  // namespace skein::same_host
