#pragma once

#include <string>

#include "dynamic_type.hpp"
#include "skein/detail/operation.hpp"

namespace skein::idl {

struct DynamicSupport;

/// A value of a type that is known by its description alone, as JSON text.
struct DynamicValue {
  const DynamicSupport* support = nullptr;
  std::string json{};
};

/// The type support of a DynamicType, for which a value is a DynamicValue. The type outlives it,
/// and it outlives its values.
struct DynamicSupport : TypeSupport {
  explicit DynamicSupport(const DynamicType& type);
  DynamicSupport(const DynamicSupport&) = delete;
  DynamicSupport& operator=(const DynamicSupport&) = delete;

  const DynamicType& type;
};

}  // namespace skein::idl
