#pragma once

namespace skein::idl {

/// Whether a bitmask has a bit.
template <class Flags>
constexpr bool has(Flags flags, Flags flag) {
  return (flags & flag) == flag;
}

}  // namespace skein::idl
