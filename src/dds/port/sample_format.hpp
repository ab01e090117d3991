#pragma once

#include <cstddef>
#include <cstring>
#include <span>
#include <string>

#include "largest_sample.hpp"
#include "skein/detail/qos.hpp"
#include "skein/error.hpp"

namespace skein::dds {

/// Bytes of the encapsulation header.
inline constexpr std::size_t kHeaderSize = 4;

/// RTPS carries payloads in multiples of 4 bytes.
constexpr std::size_t padded(std::size_t size) { return (size + 3) & ~std::size_t{3}; }

/// Whether a payload is XCDR2, or PLAIN_CDR (XCDR1 without parameter lists), of either byte order.
inline bool has_representation(std::span<const std::byte> cdr, DataRepresentation representation) {
  if (cdr.size() < kHeaderSize || cdr[0] != std::byte{0}) return false;
  if (representation == DataRepresentation::Xcdr1) return cdr[1] <= std::byte{1};
  return cdr[1] >= std::byte{6} && cdr[1] <= std::byte{11};
}

/// The header's last two bits say how many bytes of padding follow the body (DDS-XTypes 7.6.3.1.2):
/// so a sample's true length survives the trip. Foreign writers may leave them zero.
inline void mark_padding(std::byte* message, std::size_t size) {
  message[3] = (message[3] & std::byte{0xFC}) | static_cast<std::byte>(padded(size) - size);
  for (std::size_t i = size; i < padded(size); ++i) message[i] = std::byte{0};
}

/// Copies a sample to a buffer of padded(size) bytes, ready for the wire.
inline void copy_padded(std::span<const std::byte> cdr, std::byte* to) {
  std::memcpy(to, cdr.data(), cdr.size());
  mark_padding(to, cdr.size());
}

/// The sample without padding and without the mark, as it was before copy_padded().
inline std::span<const std::byte> without_padding(std::byte* message, std::size_t size) {
  if (size % 4 != 0 || size < kHeaderSize) return {message, size};
  const auto padding = std::to_integer<std::size_t>(message[3] & std::byte{0x03});
  if (size < kHeaderSize + padding) return {message, size};
  message[3] &= std::byte{0xFC};
  return {message, size - padding};
}

/// `what` begins the text.
inline void check_size(std::size_t size, const std::string& what) {
  if (size <= kLargestSample) return;
  throw InvalidArgument(what + " takes " + std::to_string(size) + " bytes; readers take " +
                        std::to_string(kLargestSample) +
                        " (256 MiB) at most: send it in parts, as a stream for example");
}

/// Refuses what has no room for a header, and what no reader takes; a header of another kind is the
/// reader's affair.
inline void check_sample(std::span<const std::byte> cdr, const std::string& topic) {
  if (cdr.size() > kLargestSample) check_size(cdr.size(), "a sample for topic '" + topic + "'");
  if (cdr.size() < kHeaderSize) {
    throw InvalidArgument("a sample for topic '" + topic + "' has " + std::to_string(cdr.size()) +
                          " bytes; it must begin with the 4-byte encapsulation header");
  }
}

}  // namespace skein::dds
