#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "skein/detail/qos.hpp"

namespace skein::dds {

/// What discovery carries of one endpoint stays below 2 KiB.
inline constexpr std::size_t kMostMembers = 128;

/// A version as an endpoint's USER_DATA carries it: "SKT1", then little-endian and without padding
/// the signature and, for each member, type, member, digest and whether it is required. Nothing for
/// a version that is not told. Of its members the first kMostMembers.
std::vector<std::uint8_t> to_user_data(const TypeVersion& version);

/// Not told where the data is another's, or malformed.
TypeVersion from_user_data(std::span<const std::uint8_t> data);

}  // namespace skein::dds
