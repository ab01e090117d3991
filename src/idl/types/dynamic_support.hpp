#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <string>

#include "dynamic_type.hpp"
#include "skein/detail/bytes.hpp"
#include "skein/detail/operation.hpp"

namespace skein::idl {

struct DynamicSupport;

/// In what values of a type are held that is known by its description alone.
enum class DynamicForm { Json, Cdr };

/// A value of a type that is known by its description alone: as JSON text, or as CDR with its
/// encapsulation header. With neither it is the type's initial value.
struct DynamicValue {
  const DynamicSupport* support = nullptr;
  std::string json{};
  std::span<const std::byte> cdr{};
  /// Of `cdr`; null if the caller lends it. An assigned value has its own.
  std::shared_ptr<const Bytes> owner{};
};

/// The value as JSON, whatever its form. Throws MalformedSample for CDR that is no such value.
std::string json_of(const DynamicValue& value);

/// Lets a value own what it lends. Without effect if it owns it already.
void own(DynamicValue& value);

/// The type support of a DynamicType, for which a value is a DynamicValue. The type outlives it,
/// and it outlives its values. Values of either form are encoded; decoded ones have `form`.
struct DynamicSupport : TypeSupport {
  explicit DynamicSupport(const DynamicType& type, DynamicForm form = DynamicForm::Json);
  DynamicSupport(const DynamicSupport&) = delete;
  DynamicSupport& operator=(const DynamicSupport&) = delete;

  /// Null for the support of a type with generated code.
  static const DynamicSupport* of(const TypeSupport& support);

  const DynamicType& type;
  const DynamicForm form;
};

}  // namespace skein::idl
