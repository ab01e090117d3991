#pragma once

#include "skein/core/guid.hpp"
#include "skein/idl/type_support.hpp"

namespace skein {

/// A type of the IDL compiler's with a `#pragma keylist`: a topic of it has one instance a key.
template <class T>
concept Keyed = requires(const T& value) {
  { key_hash(value) } -> std::same_as<Guid>;
};

namespace topics {

/// What carries a topic's type without its definition.
struct TopicType {
  const TypeSupport* support;
  /// Nothing where the type has no keys.
  Guid (*key_of)(const void* value);
};

template <class T>
TopicType topic_type() {
  TopicType type{&idl::type_support<T>(), nullptr};
  if constexpr (Keyed<T>) {
    type.key_of = [](const void* value) { return key_hash(*static_cast<const T*>(value)); };
  }
  return type;
}

}  // namespace topics
}  // namespace skein
