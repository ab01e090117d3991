#pragma once

#include <array>
#include <concepts>
#include <cstddef>

#include "skein/detail/cdr.hpp"

namespace skein {
namespace idl {

/// Structs of numbers, octets, characters, arrays of these and such structs: any bits are a value,
/// and both sides have them in the same places. Generated code specialises it.
template <class T>
inline constexpr bool kAnyBitsAreAValue = false;

template <Primitive T>
inline constexpr bool kAnyBitsAreAValue<T> = !std::same_as<T, bool>;

template <class T, std::size_t kSize>
inline constexpr bool kAnyBitsAreAValue<std::array<T, kSize>> = kAnyBitsAreAValue<T>;

}  // namespace idl

/// What a Loaned may hold.
template <class T>
concept Lendable = idl::kAnyBitsAreAValue<T>;

}  // namespace skein
