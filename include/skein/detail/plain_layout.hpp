#pragma once

#include <array>

#include "skein/detail/cdr.hpp"

namespace skein::idl {

/// Generated code specialises it for types that travel as XCDR2.
template <class T>
inline constexpr Representation kRepresentation = Representation::Xcdr1;

/// Types that are no Primitive and yet one number on the wire, so that elements of them count as
/// basic types. Generated code specialises it for bitmasks, bitsets and enumerations with values.
template <class T>
inline constexpr bool kBasicOnTheWire = std::same_as<T, wchar_t> || std::same_as<T, long double>;

/// Types whose memory is an array of one basic type, exactly as in CDR, so that many values are
/// copied at once. Generated code specialises it for structs such as `struct Position { double x;
/// double y; }`.
template <class T>
struct PlainLayout {};

template <Primitive T>
requires(!std::same_as<T, bool>) struct PlainLayout<T> {
  using Element = T;
};

template <class T>
concept PlainlyLaidOut = requires {
  typename PlainLayout<T>::Element;
};

template <PlainlyLaidOut T, std::size_t kSize>
struct PlainLayout<std::array<T, kSize>> {
  using Element = typename PlainLayout<T>::Element;
};

}  // namespace skein::idl
