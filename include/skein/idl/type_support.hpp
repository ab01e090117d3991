#pragma once

#include "skein/core/call_memory.hpp"
#include "skein/core/operation.hpp"
#include "skein/idl/codec.hpp"
#include "skein/idl/json_codec.hpp"

namespace skein::idl {

/// The type support of a generated type. Generated code declares `type_support(const T*)` beside
/// each struct, union, enumeration and exception; this is its short form: `type_support<Route>()`.
template <class T>
const TypeSupport& type_support() {
  return type_support(static_cast<const T*>(nullptr));
}

/// Used by generated code.
template <class T>
constexpr TypeSupport make_type_support(std::string_view name) {
  return {
      .name = name,
      .make = []() -> void* {
        return std::pmr::polymorphic_allocator<>(&call_memory()).new_object<T>();
      },
      .destroy =
          [](void* value) noexcept {
            if (!value) return;
            std::pmr::polymorphic_allocator<>(&call_memory()).delete_object(static_cast<T*>(value));
          },
      .assign = [](void* to,
                   const void* from) { *static_cast<T*>(to) = *static_cast<const T*>(from); },
      .encode =
          [](const void* value, Bytes& message) {
            append_cdr(message, [value](CdrWriter& writer) {
              encode(writer, *static_cast<const T*>(value));
            });
          },
      .decode =
          [](void* value, std::span<const std::byte> message, std::size_t offset) {
            return read_cdr(message, offset, [value](CdrReader& reader) {
              decode(reader, *static_cast<T*>(value));
            });
          },
      .to_json =
          [](const void* value) {
            JsonWriter writer;
            write_json(writer, *static_cast<const T*>(value));
            return writer.take();
          },
      .from_json =
          [](void* value, std::string_view json) {
            parse_json(json, [value](const JsonReader& reader) {
              read_json(reader, *static_cast<T*>(value));
            });
          },
  };
}

/// JSON text of a generated type, and back. from_json() throws InvalidArgument with the place.
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
