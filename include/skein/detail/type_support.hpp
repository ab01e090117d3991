#pragma once

#include "skein/detail/operation.hpp"

namespace skein::idl {

/// The type support of a generated type: `type_support<Route>()`. Short for `type_support(const
/// T*)`, which generated code declares beside each struct, union, enumeration and exception.
template <class T>
const TypeSupport& type_support() {
  return type_support(static_cast<const T*>(nullptr));
}

/// A generated type to JSON text and back. from_json() throws InvalidArgument with the place.
template <class T>
std::string to_json(const T& value) {
  return type_support<T>().to_json(&value);
}
template <class T>
T from_json(std::string_view json) {
  T value{};
  type_support<T>().from_json(&value, json);
  return value;
}

}  // namespace skein::idl
