#pragma once

#include <array>
#include <cstddef>

#include "skein/detail/version.hpp"

namespace skein {

/// How values of a type travel, little-endian: the second byte of a message's encapsulation header
/// (DDS-XTypes 1.3, table 60).
enum class Representation : unsigned char {
  Xcdr1 = 1,           ///< Types that do not grow.
  Xcdr2Plain = 7,      ///< A @final type that contains one that may grow, or an @optional member.
  Xcdr2Delimited = 9,  ///< An @appendable type.
  Xcdr2ParameterList = 11,  ///< A @mutable type.
};

/// The encapsulation header: the start of every message.
constexpr std::array<std::byte, 4> encapsulation(Representation representation) {
  return {std::byte{0}, std::byte{static_cast<unsigned char>(representation)}, std::byte{0},
          std::byte{0}};
}

constexpr bool is_xcdr2(Representation representation) {
  return representation != Representation::Xcdr1;
}

}  // namespace skein
