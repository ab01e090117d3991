#pragma once

#include <cstddef>
#include <cstdint>
#include <stdexcept>

#include "skein/types.idl.hpp"

namespace skein::idl {

/// Calls `visit` with a zero of the C++ type of a basic type, `long double` and wide characters
/// left out. Throws std::logic_error for other kinds.
template <class Visit>
decltype(auto) with_primitive(types::Kind kind, const Visit& visit) {
  using types::Kind;
  switch (kind) {
    case Kind::Boolean:
      return visit(bool{});
    case Kind::Char:
      return visit(char{});
    case Kind::Int8:
      return visit(std::int8_t{});
    case Kind::Octet:
      return visit(std::uint8_t{});
    case Kind::Short:
      return visit(std::int16_t{});
    case Kind::UnsignedShort:
      return visit(std::uint16_t{});
    case Kind::Long:
      return visit(std::int32_t{});
    case Kind::UnsignedLong:
      return visit(std::uint32_t{});
    case Kind::LongLong:
      return visit(std::int64_t{});
    case Kind::UnsignedLongLong:
      return visit(std::uint64_t{});
    case Kind::Float:
      return visit(float{});
    case Kind::Double:
      return visit(double{});
    default:
      throw std::logic_error("no basic type");
  }
}

/// Calls `visit` with a zero of the signed integer of so many bits: 8, 16, 32 or, for all others,
/// 64.
template <class Visit>
decltype(auto) with_integer(unsigned bits, const Visit& visit) {
  switch (bits) {
    case 8:
      return visit(std::int8_t{});
    case 16:
      return visit(std::int16_t{});
    case 32:
      return visit(std::int32_t{});
    default:
      return visit(std::int64_t{});
  }
}

inline bool is_unsigned(types::Kind kind) {
  using types::Kind;
  return kind == Kind::Octet || kind == Kind::UnsignedShort || kind == Kind::UnsignedLong ||
         kind == Kind::UnsignedLongLong;
}

/// On the wire, of basic types.
inline std::size_t size_of(types::Kind kind) {
  if (kind == types::Kind::WideChar) return 2;
  if (kind == types::Kind::LongDouble) return 16;
  return with_primitive(kind, [](auto zero) { return sizeof(zero); });
}

}  // namespace skein::idl
