#include "dynamic_support.hpp"

#include "dynamic_codec.hpp"
#include "skein/detail/cdr.hpp"
#include "skein/detail/codec.hpp"
#include "skein/detail/json.hpp"
#include "skein/error.hpp"

namespace skein::idl {
namespace {

/// What may follow a value as padding.
constexpr std::size_t kMostPadding = 7;

DynamicValue& value_at(void* value) { return *static_cast<DynamicValue*>(value); }
const DynamicValue& value_at(const void* value) { return *static_cast<const DynamicValue*>(value); }

/// The message that `write` makes of a value.
template <class Write>
std::shared_ptr<const Bytes> message_of(const DynamicSupport& support, const Write& write) {
  auto message =
      std::make_shared<Bytes>(std::span<const std::byte>(encapsulation(support.representation)));
  append_cdr(*message, write);
  return message;
}

void read_held(const DynamicValue& value, const auto& reading) {
  const std::size_t end =
      read_cdr(value.cdr, kEncapsulation.size(), value.support->representation, reading);
  if (value.cdr.size() - end <= kMostPadding) return;
  throw MalformedSample("malformed sample: " + std::string(value.support->name) +
                        " ends at offset " + std::to_string(end) + " of " +
                        std::to_string(value.cdr.size()) + " bytes");
}

void write_held(CdrWriter& writer, const DynamicValue& value) {
  const DynamicType& type = value.support->type;
  parse_json(value.json.empty() ? initial_json(type) : value.json,
             [&](const JsonReader& json) { encode_dynamic(writer, json, type); });
}

void encode_held(const void* value, Bytes& message) {
  const DynamicValue& from = value_at(value);
  append_cdr(message, [&](CdrWriter& writer) {
    if (from.cdr.empty()) return write_held(writer, from);
    read_held(from, [&](CdrReader& reader) { copy_dynamic(reader, writer, from.support->type); });
  });
}

std::size_t decode_held(void* value, std::span<const std::byte> message, std::size_t offset) {
  DynamicValue& to = value_at(value);
  const DynamicSupport& support = *to.support;
  std::size_t end = 0;
  if (support.form == DynamicForm::Json) {
    JsonWriter json;
    end = read_cdr(message, offset, support.representation,
                   [&](CdrReader& reader) { decode_dynamic(reader, json, support.type); });
    to = {&support, json.take()};
  } else {
    auto owner = message_of(support, [&](CdrWriter& writer) {
      end = read_cdr(message, offset, support.representation,
                     [&](CdrReader& reader) { copy_dynamic(reader, writer, support.type); });
    });
    to = {&support, {}, *owner, owner};
  }
  return end;
}

constexpr TypeSupport kFunctions{
    .name = {},
    .create = [](const TypeSupport& support) -> void* {
      return new DynamicValue{&static_cast<const DynamicSupport&>(support)};
    },
    .destroy = [](void* value) noexcept { delete static_cast<DynamicValue*>(value); },
    .assign =
        [](void* to, const void* from) {
          value_at(to) = value_at(from);
          own(value_at(to));
        },
    .encode = encode_held,
    .decode = decode_held,
    .to_json = [](const void* value) { return json_of(value_at(value)); },
    .from_json =
        [](void* value, std::string_view json) {
          value_at(value) = {value_at(value).support, std::string(json)};
        },
};

}  // namespace

std::string json_of(const DynamicValue& value) {
  const DynamicType& type = value.support->type;
  if (value.cdr.empty()) return value.json.empty() ? initial_json(type) : value.json;
  JsonWriter json;
  read_held(value, [&](CdrReader& reader) { decode_dynamic(reader, json, type); });
  return json.take();
}

void own(DynamicValue& value) {
  if (value.cdr.empty() || value.owner) return;
  value.owner = std::make_shared<const Bytes>(value.cdr);
  value.cdr = *value.owner;
}

DynamicSupport::DynamicSupport(const DynamicType& type_, DynamicForm form_)
    : TypeSupport(kFunctions), type(type_), form(form_) {
  name = type.declaration->name;
  representation = type.representation;
}

const DynamicSupport* DynamicSupport::of(const TypeSupport& support) {
  return support.create == kFunctions.create ? static_cast<const DynamicSupport*>(&support)
                                             : nullptr;
}

}  // namespace skein::idl
