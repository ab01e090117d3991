#pragma once

#include <cstddef>
#include <variant>

namespace skein::idl {

/// Throws InvalidArgument: `type` does not hold `member` now.
[[noreturn]] void throw_not_held(const char* type, const char* member);

/// Throws InvalidArgument: the discriminator given to set `member` selects another one.
[[noreturn]] void throw_not_selected(const char* type, const char* member);

/// A member of a generated union. Throws InvalidArgument if the union holds another one.
template <std::size_t kIndex, class Variant>
auto& union_member(Variant& value, const char* type, const char* member) {
  auto* held = std::get_if<kIndex>(&value);
  if (!held) throw_not_held(type, member);
  return *held;
}

}  // namespace skein::idl
