#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string>
#include <type_traits>

#include "idl/types/dynamic_type.hpp"
#include "idl/types/primitive_kind.hpp"

/// Where the parts of C structs lie: see struct_value.hpp.
namespace skein::c {

/// What stands for a sequence.
struct Sequence {
  const std::byte* data;
  std::size_t size;
};

struct Layout {
  std::size_t size = 0;
  std::size_t alignment = 1;

  /// Where a part lies that follows what there is.
  std::size_t add(const Layout& part) {
    const std::size_t at = aligned(size, part.alignment);
    size = at + part.size;
    alignment = std::max(alignment, part.alignment);
    return at;
  }
  /// To whole elements of an array.
  Layout padded() const { return {aligned(size, alignment), alignment}; }

  static std::size_t aligned(std::size_t size, std::size_t alignment) {
    return (size + alignment - 1) / alignment * alignment;
  }
};

template <class T>
constexpr Layout layout_of() {
  return {sizeof(T), alignof(T)};
}

/// Of a value. Throws InvalidArgument for a type that contains itself, or is nested too deeply.
Layout layout_of(const idl::DynamicType& type);
/// Of a member: that of a pointer where one stands for it.
Layout layout_of(const idl::DynamicType::Member& member);
/// Whether a pointer stands for the member, which is not optional.
bool is_pointed_to(const idl::DynamicType::Member& member);
/// Where a union's members lie, and the whole.
std::size_t union_layout(const idl::DynamicType& type, Layout& whole);
/// Where the second half of a map's pair lies, and the pair.
std::size_t pair_layout(const idl::DynamicType& map, Layout& pair);

/// Whether values lie in memory as in CDR, but for the byte order.
bool is_plain(types::Kind kind);
/// Arrays of arrays are one array: of so many items.
struct Items {
  const idl::DynamicType* item;
  std::size_t count = 1;

  explicit Items(const idl::DynamicType& array) : item(&array) {
    for (; item->kind == types::Kind::Array; item = item->elements[0]) count *= item->bound;
  }
};

template <class T>
T load(const std::byte* from) {
  T value;
  std::memcpy(&value, from, sizeof value);
  return value;
}

template <class T>
void store(std::byte* to, const T& value) {
  std::memcpy(to, &value, sizeof value);
}

/// The number of a union's discriminator, an enumeration or bits.
std::int64_t number_at(const idl::DynamicType& type, const std::byte* from);

}  // namespace skein::c
