#pragma once

#include "skein/detail/call_memory.hpp"
#include "skein/detail/codec.hpp"
#include "skein/detail/json_codec.hpp"
#include "skein/detail/type_support.hpp"

namespace skein::idl {

/// Used by generated code.
template <class T>
constexpr TypeSupport make_type_support(std::string_view name, TypeDescription description) {
  return {
      .name = name,
      .representation = kRepresentation<T>,
      .create = [](const TypeSupport&) -> void* {
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
            return read_cdr(message, offset, kRepresentation<T>, [value](CdrReader& reader) {
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
      .description = description,
  };
}

}  // namespace skein::idl
