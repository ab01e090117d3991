#pragma once

#include <array>
#include <compare>
#include <cstdint>
#include <cstring>
#include <functional>
#include <optional>
#include <string>
#include <string_view>

#include "skein/detail/version.hpp"

namespace skein {

/// A 16-byte identity: of a DDS entity (RTPS GUID), an instance (key hash) or a peer.
struct Guid {
  std::array<std::uint8_t, 16> bytes{};

  auto operator<=>(const Guid&) const = default;  // NOLINT(modernize-use-nullptr): it has none
  bool is_nil() const noexcept { return *this == Guid{}; }

  /// The first 12 bytes, which all endpoints of an RTPS participant share; the rest is zero.
  Guid participant() const noexcept;

  /// 32 lower-case hexadecimal digits.
  std::string hex() const;

  /// The inverse of hex(); nullopt for any other text.
  static std::optional<Guid> from_hex(std::string_view text) noexcept;

  /// 16 random bytes from the system.
  static Guid random();
};

}  // namespace skein

template <>
struct std::hash<skein::Guid> {
  std::size_t operator()(const skein::Guid& guid) const noexcept {
    std::uint64_t high;
    std::uint64_t low;
    std::memcpy(&high, guid.bytes.data(), 8);
    std::memcpy(&low, guid.bytes.data() + 8, 8);
    return static_cast<std::size_t>((high ^ (low * 0x9E3779B97F4A7C15ull)) * 0xFF51AFD7ED558CCDull);
  }
};
