#pragma once

#include <concepts>
#include <memory>

#include "skein/detail/type_support.hpp"
#include "skein/error.hpp"
#include "skein/guid.hpp"

namespace skein {

namespace types {
struct TypeSystem;
}

/// A generated type with a `@key`: its topics have one instance per key.
template <class T>
concept Keyed = requires(const T& value) {
  { key_hash(value) } -> std::same_as<Guid>;
};

namespace topics {

/// A generated type; no interface, and nothing of C++'s own.
template <class T>
inline constexpr bool kIsType = requires(const T* none) {
  type_support(none);
};

/// A topic's type without its definition.
struct TopicType {
  const TypeSupport* support;
  /// nullptr if the type has no keys.
  Guid (*key_of)(const void* value);
  /// Of a type that is known by its description alone: the description, with all that it names.
  const types::TypeSystem* described = nullptr;
};

template <class T>
TopicType topic_type() {
  TopicType type{&idl::type_support<T>(), nullptr};
  if constexpr (Keyed<T>) {
    type.key_of = [](const void* value) { return key_hash(*static_cast<const T*>(value)); };
  }
  return type;
}

/// The writer or the reader, unless its publisher or subscription was moved from.
template <class Endpoint>
Endpoint& held(const std::unique_ptr<Endpoint>& endpoint) {
  if (endpoint) return *endpoint;
  throw InvalidArgument(
      "this publisher or subscription was moved from; use the object that it was moved to");
}

}  // namespace topics
}  // namespace skein
