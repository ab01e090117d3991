#include "dynamic_support.hpp"

#include "dynamic_codec.hpp"
#include "skein/detail/cdr.hpp"
#include "skein/detail/json.hpp"

namespace skein::idl {
namespace {

DynamicValue& value_at(void* value) { return *static_cast<DynamicValue*>(value); }
const DynamicValue& value_at(const void* value) { return *static_cast<const DynamicValue*>(value); }

constexpr TypeSupport kFunctions{
    .name = {},
    .create = [](const TypeSupport& support) -> void* {
      return new DynamicValue{&static_cast<const DynamicSupport&>(support)};
    },
    .destroy = [](void* value) noexcept { delete static_cast<DynamicValue*>(value); },
    .assign = [](void* to, const void* from) { value_at(to) = value_at(from); },
    .encode =
        [](const void* value, Bytes& message) {
          const DynamicValue& from = value_at(value);
          parse_json(from.json, [&](const JsonReader& json) {
            append_cdr(message, [&](CdrWriter& writer) {
              encode_dynamic(writer, json, from.support->type);
            });
          });
        },
    .decode =
        [](void* value, std::span<const std::byte> message, std::size_t offset) {
          DynamicValue& to = value_at(value);
          JsonWriter json;
          const std::size_t end =
              read_cdr(message, offset, to.support->representation,
                       [&](CdrReader& reader) { decode_dynamic(reader, json, to.support->type); });
          to.json = json.take();
          return end;
        },
    .to_json = [](const void* value) { return value_at(value).json; },
    .from_json = [](void* value, std::string_view json) { value_at(value).json = json; },
};

}  // namespace

DynamicSupport::DynamicSupport(const DynamicType& type_) : TypeSupport(kFunctions), type(type_) {
  name = type.declaration->name;
  representation = type.representation;
}

}  // namespace skein::idl
