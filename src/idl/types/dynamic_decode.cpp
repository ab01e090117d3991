#include <algorithm>
#include <type_traits>

#include "dynamic_codec.hpp"
#include "primitive_kind.hpp"
#include "skein/detail/codec.hpp"
#include "skein/detail/json_codec.hpp"
#include "skein/detail/service_reference.hpp"
#include "template_kinds.hpp"

namespace skein::idl {
namespace {

using types::DeclarationKind;
using types::Extensibility;
using types::Kind;

/// What a node of the text may take beside the names in it.
constexpr std::size_t kNode = 16;

void write_bits(JsonWriter& json, const types::BitField& field, std::uint64_t bits) {
  with_primitive(field.kind, [&](auto zero) {
    using T = decltype(zero);
    if constexpr (std::is_same_v<T, bool>) {
      json.write(bits != 0);
    } else if constexpr (std::is_integral_v<T> && !std::is_same_v<T, char>) {
      const std::uint64_t sign = std::uint64_t{1} << (field.width - 1);
      json.write(static_cast<T>(std::is_signed_v<T> ? (bits ^ sign) - sign : bits));
    }
  });
}

void write_enumerator(JsonWriter& json, const DynamicType& type, std::int64_t number) {
  const auto& values = type.declaration->values;
  json.write_string(std::ranges::find(values, number, &types::Value::value)->name);
}

/// The JSON of a discriminator.
void write_label(JsonWriter& json, const DynamicType& type, std::int64_t label) {
  if (type.kind == Kind::Declared) return write_enumerator(json, type, label);
  if (type.kind == Kind::WideChar) return write_json(json, static_cast<wchar_t>(label));
  with_primitive(type.kind, [&](auto zero) { json.write(static_cast<decltype(zero)>(label)); });
}

class Decoder {
 public:
  Decoder(CdrReader& reader, JsonWriter& json) : reader_(reader), json_(json) {}

  void value(const DynamicType& type, const std::string& place) {
    reader_.at(place.c_str());
    switch (type.kind) {
      case Kind::WideChar:
        return copy<wchar_t>();
      case Kind::LongDouble:
        return copy<long double>();
      case Kind::String: {
        std::string text;
        reader_.read_string(text);
        if (type.bound > 0) reader_.check_bound(text.size(), type.bound, place.c_str());
        return json_.write_string(text);
      }
      case Kind::WideString: {
        std::wstring text;
        reader_.read_wide_string(text);
        if (type.bound > 0) reader_.check_bound(utf16(text).size(), type.bound, place.c_str());
        return write_json(json_, text);
      }
      case Kind::Sequence:
        return sequence(type, place);
      case Kind::Array:
        return array(type, place);
      case Kind::Map:
        return map(type, place);
      case Kind::OptionalMember:
        return reader_.read<bool>() ? value(*type.elements[0], place) : json_.write_null();
      case Kind::Reference:
        return copy<ServiceReference>();
      case Kind::Declared:
        return declared(type);
      default:
        if (!type.elements.empty()) {
          return object(type, [&](const DynamicType& each) { value(each, place); });
        }
        with_primitive(type.kind, [&](auto zero) { json_.write(reader_.read<decltype(zero)>()); });
    }
  }

  void initial(const DynamicType& type) {
    reader_.take_memory(kNode);
    switch (type.kind) {
      case Kind::WideChar:
        return write_json(json_, L'\0');
      case Kind::LongDouble:
        return write_json(json_, 0.0L);
      case Kind::String:
      case Kind::WideString:
        return json_.write_string("");
      case Kind::Array:
        json_.begin_array();
        for (std::size_t i = 0; i < type.bound; ++i) initial(*type.elements[0]);
        return json_.end_array();
      case Kind::Sequence:
      case Kind::Map:
        json_.begin_array();
        return json_.end_array();
      case Kind::OptionalMember:
        return json_.write_null();
      case Kind::Reference:
        return write_json(json_, ServiceReference{});
      case Kind::Declared:
        return initial_declared(type);
      default:
        if (!type.elements.empty()) {
          return object(type, [&](const DynamicType& each) { initial(each); });
        }
        with_primitive(type.kind, [&](auto zero) { json_.write(zero); });
    }
  }

 private:
  template <class T>
  void copy() {
    T value{};
    decode(reader_, value);
    write_json(json_, value);
  }

  void declared(const DynamicType& type) {
    const types::Declaration& declaration = *type.declaration;
    reader_.at(declaration.name.c_str());
    switch (declaration.kind) {
      case DeclarationKind::Enumeration:
        return write_enumerator(json_, type, enumerator(type));
      case DeclarationKind::Bitmask:
        return write_json_flags(json_, bits(type), type.flags);
      case DeclarationKind::Bitset:
        return bitset(type, bits(type));
      default:
        break;
    }
    const CdrReader::Nesting nesting(reader_);
    for (const std::string_view name : type.names) reader_.take_memory(name.size());
    const bool grows = declaration.extensibility != Extensibility::Final;
    const CdrReader::Delimited delimited(reader_, grows);
    json_.begin_object();
    if (declaration.extensibility == Extensibility::Mutable) {
      type.is(DeclarationKind::Union) ? switched_by_identifier(type, delimited)
                                      : members_by_identifier(type, delimited);
    } else {
      type.is(DeclarationKind::Union) ? switched(type) : members(type, grows, delimited);
    }
    json_.end_object();
  }

  std::int64_t enumerator(const DynamicType& type) {
    const std::int64_t number = with_integer(type.declaration->bits, [&](auto zero) {
      return static_cast<std::int64_t>(reader_.read<decltype(zero)>());
    });
    const auto& values = type.declaration->values;
    if (std::ranges::find(values, number, &types::Value::value) == values.end()) {
      reader_.fail(std::to_string(number) + " is no value of " + type.declaration->name);
    }
    return number;
  }

  std::uint64_t bits(const DynamicType& type) {
    return with_integer(type.declaration->bits, [&](auto zero) {
      using Bits = std::make_unsigned_t<decltype(zero)>;
      return static_cast<std::uint64_t>(reader_.read<Bits>());
    });
  }

  void bitset(const DynamicType& type, std::uint64_t bits) {
    unsigned offset = 0;
    json_.begin_object();
    for (const types::BitField& field : type.declaration->fields) {
      if (!field.name.empty()) {
        json_.key(field.name);
        write_bits(json_, field, bits >> offset & ~std::uint64_t{0} >> (64 - field.width));
      }
      offset += field.width;
    }
    json_.end_object();
  }

  /// Members that an older writer of an appendable type did not have keep their initial values.
  void members(const DynamicType& type, bool grows, const CdrReader::Delimited& delimited) {
    if (type.members.empty()) reader_.read<std::uint8_t>();
    for (const DynamicType::Member& member : type.members) {
      json_.key(member.described->name);
      if (grows && !delimited.more()) {
        initial(member);
      } else {
        value(*member.type, member.place);
      }
    }
  }

  void initial(const DynamicType::Member& member) {
    if (member.initial.empty()) return initial(*member.type);
    reader_.take_memory(member.initial.size());
    json_.write_raw(member.initial);
  }

  /// Each by its identifier, in any order; those that are absent keep their initial values.
  void members_by_identifier(const DynamicType& type, const CdrReader::Delimited& delimited) {
    std::vector<std::string> texts(type.members.size());
    while (delimited.more()) {
      reader_.at(type.declaration->name.c_str());
      const CdrReader::Member found = reader_.read_member();
      const CdrReader::Delimited content(reader_, found.length);
      const auto member = std::ranges::find_if(type.members, [&](const DynamicType::Member& each) {
        return each.described->id == found.id;
      });
      if (member == type.members.end()) {
        reader_.pass_over(found);
        continue;
      }
      const bool optional = member->type->kind == Kind::OptionalMember;
      texts[static_cast<std::size_t>(member - type.members.begin())] = apart([&](Decoder& decoder) {
        decoder.value(optional ? *member->type->elements[0] : *member->type, member->place);
      });
    }
    for (std::size_t i = 0; i < texts.size(); ++i) {
      json_.key(type.members[i].described->name);
      texts[i].empty() ? initial(type.members[i]) : json_.write_raw(texts[i]);
    }
  }

  std::int64_t label(const DynamicType& type) {
    reader_.at("_d");
    if (type.kind == Kind::Declared) return enumerator(type);
    if (type.kind == Kind::WideChar) return reader_.read_wide_character();
    return with_primitive(type.kind, [&](auto zero) -> std::int64_t {
      const auto value = reader_.read<decltype(zero)>();
      if constexpr (std::is_same_v<decltype(zero), char>)
        return static_cast<unsigned char>(value);
      else
        return static_cast<std::int64_t>(value);
    });
  }

  void switched(const DynamicType& type) {
    const std::int64_t chosen = label(*type.discriminator);
    json_.key("_d");
    write_label(json_, *type.discriminator, chosen);
    const DynamicType::Member* const selected = type.selected(chosen);
    if (!selected) return;
    json_.key(selected->described->name);
    value(*selected->type, selected->place);
  }

  /// The discriminator has the identifier 0.
  void switched_by_identifier(const DynamicType& type, const CdrReader::Delimited& delimited) {
    std::int64_t chosen = type.label_of(type.initial_member());
    const DynamicType::Member* selected = &type.initial_member();
    std::string text;
    while (delimited.more()) {
      reader_.at(type.declaration->name.c_str());
      const CdrReader::Member found = reader_.read_member();
      const CdrReader::Delimited content(reader_, found.length);
      const auto is_found = [&](const DynamicType::Member& each) {
        return each.described->id == found.id;
      };
      if (found.id == 0) {
        chosen = label(*type.discriminator);
        if (selected != type.selected(chosen)) text.clear();
        selected = type.selected(chosen);
      } else if (selected && is_found(*selected)) {
        text = apart([&](Decoder& decoder) { decoder.value(*selected->type, selected->place); });
      } else if (std::ranges::none_of(type.members, is_found)) {
        reader_.pass_over(found);
      }
    }
    json_.key("_d");
    write_label(json_, *type.discriminator, chosen);
    if (!selected) return;
    json_.key(selected->described->name);
    text.empty() ? initial(*selected->type) : json_.write_raw(text);
  }

  /// What `decode` writes, on its own.
  std::string apart(const auto& decode) {
    JsonWriter json;
    Decoder decoder(reader_, json);
    decode(decoder);
    return json.take();
  }

  void initial_declared(const DynamicType& type) {
    const types::Declaration& declaration = *type.declaration;
    switch (declaration.kind) {
      case DeclarationKind::Enumeration:
        return json_.write_string(declaration.initial.empty() ? declaration.values.front().name
                                                              : declaration.initial);
      case DeclarationKind::Bitmask:
        json_.begin_array();
        return json_.end_array();
      case DeclarationKind::Bitset:
        return bitset(type, 0);
      default:
        break;
    }
    const CdrReader::Nesting nesting(reader_);
    json_.begin_object();
    if (type.is(DeclarationKind::Union)) {
      const DynamicType::Member& member = type.initial_member();
      json_.key("_d");
      write_label(json_, *type.discriminator, type.label_of(member));
      json_.key(member.described->name);
      initial(*member.type);
    } else {
      for (const DynamicType::Member& member : type.members) {
        reader_.take_memory(member.described->name.size());
        json_.key(member.described->name);
        initial(member);
      }
    }
    json_.end_object();
  }

  void sequence(const DynamicType& type, const std::string& place) {
    const DynamicType& element = *type.elements[0];
    const CdrReader::Delimited delimited(reader_,
                                         reader_.is_xcdr2() && element.is_delimited_element());
    const std::size_t length = reader_.read_length(1);
    if (type.bound > 0) reader_.check_bound(length, type.bound, place.c_str());
    json_.begin_array();
    for (std::size_t i = 0; i < length; ++i) {
      reader_.take_memory(kNode);
      value(element, place);
    }
    json_.end_array();
  }

  /// Arrays of arrays are one array on the wire.
  void array(const DynamicType& type, const std::string& place) {
    const DynamicType* item = &type;
    while (item->kind == Kind::Array) item = item->elements[0];
    const CdrReader::Delimited delimited(reader_,
                                         reader_.is_xcdr2() && item->is_delimited_element());
    items(type, place);
  }

  void items(const DynamicType& type, const std::string& place) {
    if (type.kind != Kind::Array) return value(type, place);
    json_.begin_array();
    for (std::size_t i = 0; i < type.bound; ++i) {
      reader_.take_memory(kNode);
      items(*type.elements[0], place);
    }
    json_.end_array();
  }

  void map(const DynamicType& type, const std::string& place) {
    const CdrReader::Delimited delimited(reader_, reader_.is_xcdr2());
    const std::size_t length = reader_.read_length(1);
    if (type.bound > 0) reader_.check_bound(length, type.bound, place.c_str());
    json_.begin_array();
    for (std::size_t i = 0; i < length; ++i) {
      reader_.take_memory(kNode);
      object(type, [&](const DynamicType& each) { value(each, place); });
    }
    json_.end_array();
  }

  /// Of the types that a template takes, each written by `write`.
  void object(const DynamicType& type, const auto& write) {
    json_.begin_object();
    for (std::size_t i = 0; i < type.elements.size(); ++i) {
      json_.key(template_of(type.kind).names[i]);
      write(*type.elements[i]);
    }
    json_.end_object();
  }

  CdrReader& reader_;
  JsonWriter& json_;
};

}  // namespace

void decode_dynamic(CdrReader& reader, JsonWriter& json, const DynamicType& type) {
  Decoder(reader, json).value(type, type.declaration ? type.declaration->name : "value");
}

std::string initial_json(const DynamicType& type) {
  JsonWriter json;
  read_cdr(encapsulation(type.representation), kEncapsulation.size(), type.representation,
           [&](CdrReader& reader) { Decoder(reader, json).initial(type); });
  return json.take();
}

}  // namespace skein::idl
