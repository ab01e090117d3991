#include <algorithm>
#include <numeric>
#include <set>
#include <span>

#include "dynamic_codec.hpp"
#include "primitive_kind.hpp"
#include "skein/detail/codec.hpp"
#include "skein/detail/json_codec.hpp"
#include "skein/detail/key_hash.hpp"
#include "skein/detail/service_reference.hpp"
#include "template_kinds.hpp"

namespace skein::idl {
namespace {

using types::DeclarationKind;
using types::Extensibility;
using types::Kind;

std::uint64_t bits_of(const types::BitField& field, const JsonReader& json) {
  return with_primitive(field.kind, [&](auto zero) -> std::uint64_t {
    if constexpr (std::is_floating_point_v<decltype(zero)> ||
                  std::is_same_v<decltype(zero), char>) {
      return 0;  // no bit field is of that kind
    } else {
      return static_cast<std::uint64_t>(read_json_bits<decltype(zero)>(json, field.width));
    }
  });
}

class Encoder {
 public:
  explicit Encoder(CdrWriter& writer) : writer_(writer) {}

  void value(const DynamicType& type, const JsonReader& json, const std::string& place) {
    switch (type.kind) {
      case Kind::WideChar:
        return copy<wchar_t>(json);
      case Kind::LongDouble:
        return copy<long double>(json);
      case Kind::String: {
        const std::string text = json.read_string();
        if (type.bound > 0) json.check_bound(text.size(), type.bound, place.c_str());
        return writer_.write_string(text);
      }
      case Kind::WideString: {
        const std::wstring text = from_utf8(json.read_string());
        if (type.bound > 0) json.check_bound(utf16(text).size(), type.bound, place.c_str());
        return writer_.write_wide_string(text);
      }
      case Kind::Sequence:
        return sequence(type, json, place);
      case Kind::Array:
        return array(type, json, place);
      case Kind::Map:
        return map(type, json, place);
      case Kind::OptionalMember:
        writer_.write(!json.is_null());
        if (!json.is_null()) value(*type.elements[0], json, place);
        return;
      case Kind::Reference:
        return copy<ServiceReference>(json);
      case Kind::Declared:
        return declared(type, json);
      default:
        if (!type.elements.empty()) return object(type, json, place);
        with_primitive(type.kind, [&](auto zero) { writer_.write(json.read<decltype(zero)>()); });
    }
  }

  /// The members of its key alone; a struct without any as a whole.
  void key(const DynamicType& type, const JsonReader& json) {
    for (const DynamicType::Member& member : type.members) {
      if (!has(member.described->flags, types::MemberFlags::key)) continue;
      const JsonReader content = json.member(member.described->name);
      if (is_keyed(*member.type)) {
        key(*member.type, content);
      } else {
        value(*member.type, content, member.place);
      }
    }
  }

 private:
  template <class T>
  void copy(const JsonReader& json) {
    T value{};
    read_json(json, value);
    encode(writer_, value);
  }

  void declared(const DynamicType& type, const JsonReader& json) {
    const auto& name = type.declaration->name;
    switch (type.declaration->kind) {
      case DeclarationKind::Enumeration:
        return integer(type, type.declaration->values[json.read_enum(name, type.names)].value);
      case DeclarationKind::Bitmask:
        return integer(type, static_cast<std::int64_t>(read_json_flags(json, name, type.flags)));
      case DeclarationKind::Bitset:
        return bitset(type, json);
      default:
        break;
    }
    const CdrWriter::Nesting nesting(writer_);
    const bool grows = type.declaration->extensibility != Extensibility::Final;
    const CdrWriter::Delimiter delimiter(writer_, grows);
    if (type.is(DeclarationKind::Union)) {
      switched(type, json);
    } else {
      json.expect_members(name, type.names);
      members(type, json);
    }
  }

  void integer(const DynamicType& type, std::int64_t number) {
    with_integer(type.declaration->bits,
                 [&](auto zero) { writer_.write(static_cast<decltype(zero)>(number)); });
  }

  void bitset(const DynamicType& type, const JsonReader& json) {
    json.expect_members(type.declaration->name, type.names);
    std::uint64_t bits = 0;
    unsigned offset = 0;
    for (const types::BitField& field : type.declaration->fields) {
      const std::uint64_t mask = ~std::uint64_t{0} >> (64 - field.width);
      if (!field.name.empty()) bits |= (bits_of(field, json.member(field.name)) & mask) << offset;
      offset += field.width;
    }
    integer(type, static_cast<std::int64_t>(bits));
  }

  void members(const DynamicType& type, const JsonReader& json) {
    const bool by_identifier = type.declaration->extensibility == Extensibility::Mutable;
    if (type.members.empty() && !by_identifier) writer_.write(std::uint8_t{0});
    for (const DynamicType::Member& member : type.members) {
      const JsonReader content = json.member(member.described->name);
      if (!by_identifier) {
        value(*member.type, content, member.place);
      } else if (member.type->kind != Kind::OptionalMember) {
        identified(member, *member.type, content);
      } else if (!content.is_null()) {
        identified(member, *member.type->elements[0], content);
      }
    }
  }

  void identified(const DynamicType::Member& member, const DynamicType& type,
                  const JsonReader& json) {
    const auto length = writer_.member(
        member.described->id, has(member.described->flags, types::MemberFlags::must_understand));
    value(type, json, member.place);
  }

  void switched(const DynamicType& type, const JsonReader& json) {
    static const std::string kPlace = "_d";
    const JsonReader discriminator = json.member(kPlace);
    const bool by_identifier = type.declaration->extensibility == Extensibility::Mutable;
    const DynamicType::Member* const selected =
        type.selected(label(*type.discriminator, discriminator));
    std::vector<std::string_view> expected{kPlace};
    if (selected) expected.push_back(selected->described->name);
    json.expect_members(type.declaration->name, expected);
    {
      const CdrWriter::Delimiter length =
          by_identifier ? writer_.member(0, true) : CdrWriter::Delimiter(writer_, false);
      value(*type.discriminator, discriminator, kPlace);
    }
    if (!selected) return;
    const JsonReader content = json.member(selected->described->name);
    if (by_identifier) {
      identified(*selected, *selected->type, content);
    } else {
      value(*selected->type, content, selected->place);
    }
  }

  static std::int64_t label(const DynamicType& type, const JsonReader& json) {
    if (type.kind == Kind::Declared) {
      return type.declaration->values[json.read_enum(type.declaration->name, type.names)].value;
    }
    if (type.kind == Kind::WideChar) {
      wchar_t character{};
      read_json(json, character);
      return character;
    }
    return with_primitive(type.kind, [&](auto zero) -> std::int64_t {
      const auto value = json.read<decltype(zero)>();
      if constexpr (std::is_same_v<decltype(zero), char>)
        return static_cast<unsigned char>(value);
      else
        return static_cast<std::int64_t>(value);
    });
  }

  void sequence(const DynamicType& type, const JsonReader& json, const std::string& place) {
    const DynamicType& element = *type.elements[0];
    const std::size_t size = json.array_size();
    if (type.bound > 0) json.check_bound(size, type.bound, place.c_str());
    const CdrWriter::Delimiter delimiter(writer_,
                                         writer_.is_xcdr2() && element.is_delimited_element());
    writer_.write_length(size);
    for (std::size_t i = 0; i < size; ++i) value(element, json.element(i), place);
  }

  /// Arrays of arrays are one array on the wire.
  void array(const DynamicType& type, const JsonReader& json, const std::string& place) {
    const DynamicType* item = &type;
    while (item->kind == Kind::Array) item = item->elements[0];
    const CdrWriter::Delimiter delimiter(writer_,
                                         writer_.is_xcdr2() && item->is_delimited_element());
    items(type, json, place);
  }

  void items(const DynamicType& type, const JsonReader& json, const std::string& place) {
    if (type.kind != Kind::Array) return value(type, json, place);
    json.expect_size(type.bound);
    for (std::size_t i = 0; i < type.bound; ++i) items(*type.elements[0], json.element(i), place);
  }

  void map(const DynamicType& type, const JsonReader& json, const std::string& place) {
    const std::size_t size = json.array_size();
    if (type.bound > 0) json.check_bound(size, type.bound, place.c_str());
    for (std::size_t i = 0; i < size; ++i) expect_object(type, json.element(i));
    const CdrWriter::Delimiter delimiter(writer_, writer_.is_xcdr2());
    writer_.write_length(size);
    for (const std::size_t i : in_order_of_keys(*type.elements[0], json, size)) {
      members_of_object(type, json.element(i), place);
    }
  }

  static void expect_object(const DynamicType& type, const JsonReader& json) {
    const TemplateKind& kind = template_of(type.kind);
    json.expect_members(kind.object, std::span(kind.names).first(kind.types));
  }

  void members_of_object(const DynamicType& type, const JsonReader& json,
                         const std::string& place) {
    for (std::size_t i = 0; i < type.elements.size(); ++i) {
      value(*type.elements[i], json.member(template_of(type.kind).names[i]), place);
    }
  }

  void object(const DynamicType& type, const JsonReader& json, const std::string& place) {
    expect_object(type, json);
    members_of_object(type, json, place);
  }

  template <class Key>
  static std::vector<std::size_t> sorted(const JsonReader& json, std::size_t size,
                                         const auto& key_of) {
    std::vector<Key> keys;
    for (std::size_t i = 0; i < size; ++i) keys.push_back(key_of(json.element(i).member("key")));
    std::vector<std::size_t> order(size);
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::ranges::stable_sort(order,
                             [&](std::size_t a, std::size_t b) { return keys[a] < keys[b]; });
    for (std::size_t i = 1; i < size; ++i) {
      if (!(keys[order[i - 1]] < keys[order[i]])) {
        json.element(order[i]).fail("has a key that is there already");
      }
    }
    return order;
  }

  static std::vector<std::size_t> in_order_of_keys(const DynamicType& key, const JsonReader& json,
                                                   std::size_t size) {
    switch (key.kind) {
      case Kind::String:
        return sorted<std::string>(json, size,
                                   [](const JsonReader& each) { return each.read_string(); });
      case Kind::WideString:
        return sorted<std::wstring>(
            json, size, [](const JsonReader& each) { return from_utf8(each.read_string()); });
      case Kind::UnsignedLongLong:
        return sorted<std::uint64_t>(
            json, size, [](const JsonReader& each) { return each.read<std::uint64_t>(); });
      case Kind::Char:  // which is signed where generated code compares it, or not
        return sorted<char>(json, size, [](const JsonReader& each) { return each.read<char>(); });
      default:
        return sorted<std::int64_t>(json, size,
                                    [&](const JsonReader& each) { return label(key, each); });
    }
  }

  CdrWriter& writer_;
};

constexpr std::size_t kUnbounded = std::size_t{1} << 40;
constexpr std::size_t kLongestKey = 16;

/// The largest offset at which a key that begins at `start` may end in CDR.
std::size_t key_end(const DynamicType& type, std::size_t start) {
  const auto aligned = [&](std::size_t size) {
    const std::size_t alignment = std::min<std::size_t>(size, 8);
    return (start + alignment - 1) / alignment * alignment + size;
  };
  if (start > kLongestKey) return kUnbounded;
  switch (type.kind) {
    case Kind::String:
      return type.bound > 0 ? aligned(4) + type.bound + 1 : kUnbounded;
    case Kind::Array: {
      for (std::size_t i = 0; i < type.bound && start <= kLongestKey; ++i) {
        start = key_end(*type.elements[0], start);
      }
      return start;
    }
    case Kind::Declared:
      break;
    default:
      return type.kind <= Kind::LongDouble ? aligned(size_of(type.kind)) : kUnbounded;
  }
  if (!type.is_struct())
    return type.is(DeclarationKind::Union) ? kUnbounded : aligned(type.declaration->bits / 8);
  const bool keyed = is_keyed(type);
  for (const DynamicType::Member& member : type.members) {
    if (keyed && !has(member.described->flags, types::MemberFlags::key)) continue;
    start = key_end(*member.type, start);
  }
  return start;
}

}  // namespace

void encode_dynamic(CdrWriter& writer, const JsonReader& json, const DynamicType& type) {
  Encoder(writer).value(type, json, type.declaration ? type.declaration->name : "value");
}

bool is_keyed(const DynamicType& type) {
  return std::ranges::any_of(type.members, [](const DynamicType::Member& member) {
    return has(member.described->flags, types::MemberFlags::key);
  });
}

Guid key_hash_of(const JsonReader& json, const DynamicType& type) {
  return make_key_hash(
      key_end(type, 0) <= kLongestKey, [&](CdrWriter& writer) { Encoder(writer).key(type, json); },
      is_xcdr2(type.representation) ? Representation::Xcdr2Plain : Representation::Xcdr1);
}

}  // namespace skein::idl
