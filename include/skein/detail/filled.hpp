#pragma once

#include <array>
#include <type_traits>

namespace skein::idl {

/// An array, also of arrays, of which each element is `value`. Used by generated code.
template <class Array, class Value>
constexpr Array filled(Value value) {
  Array values{};
  for (auto& element : values) {
    if constexpr (std::is_same_v<typename Array::value_type, Value>) {
      element = value;
    } else {
      element = filled<typename Array::value_type>(value);
    }
  }
  return values;
}

}  // namespace skein::idl
