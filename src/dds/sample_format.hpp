#pragma once

#include <cstddef>
#include <span>
#include <string>

#include "skein/core/error.hpp"

namespace skein::dds {

/// Bytes of the encapsulation header.
inline constexpr std::size_t kHeaderSize = 4;

/// RTPS carries payloads in multiples of 4 bytes.
constexpr std::size_t padded(std::size_t size) { return (size + 3) & ~std::size_t{3}; }

/// Whether a payload is PLAIN_CDR of either byte order (XCDR1 without parameter lists).
inline bool is_plain_cdr(std::span<const std::byte> cdr) {
  return cdr.size() >= kHeaderSize && cdr[0] == std::byte{0} && cdr[1] <= std::byte{1};
}

/// Refuses what has no room for a header; a header of another kind is the reader's affair.
inline void require_header(std::span<const std::byte> cdr, const std::string& topic) {
  if (cdr.size() < kHeaderSize) {
    throw InvalidArgument("a sample for topic '" + topic + "' has " + std::to_string(cdr.size()) +
                          " bytes; it must begin with the 4-byte encapsulation header");
  }
}

}  // namespace skein::dds
