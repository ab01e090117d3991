#include <algorithm>
#include <string>

#include "idl/types/dynamic_codec.hpp"
#include "skein/c/skein.h"
#include "skein/detail/codec.hpp"
#include "skein/detail/service_reference.hpp"
#include "skein/error.hpp"
#include "struct_layout.hpp"
#include "struct_value.hpp"

namespace skein::c {
namespace {

using idl::CdrWriter;
using idl::DynamicType;
using types::DeclarationKind;
using types::Extensibility;
using types::Kind;

void check_enumerator(const DynamicType& type, std::int64_t number) {
  const auto& values = type.declaration->values;
  if (!type.is(DeclarationKind::Enumeration)) return;
  if (std::ranges::find(values, number, &types::Value::value) != values.end()) return;
  throw InvalidArgument(std::to_string(number) + " is no value of " + type.declaration->name);
}

class StructWriter {
 public:
  explicit StructWriter(CdrWriter& writer) : writer_(writer) {}

  void value(const DynamicType& type, const std::byte* from, const std::string& place) {
    switch (type.kind) {
      case Kind::WideChar:
        return writer_.write_wide_character(load<std::uint16_t>(from));
      case Kind::LongDouble:
        return writer_.write_long_double(load<long double>(from));
      case Kind::String:
      case Kind::WideString:
        return text(type, load<const char*>(from), place);
      case Kind::Sequence:
        return sequence(type, load<Sequence>(from), place);
      case Kind::Map:
        return map(type, load<Sequence>(from), place);
      case Kind::Array:
        return array(type, from, place);
      case Kind::OptionalMember: {
        const auto* const there = load<const std::byte*>(from);
        writer_.write(there != nullptr);
        return there ? value(*type.elements[0], there, place) : void();
      }
      case Kind::Reference:
        return reference(load<skein_reference>(from));
      case Kind::Declared:
        return declared(type, from);
      default:
        idl::with_primitive(type.kind,
                            [&](auto zero) { writer_.write(load<decltype(zero)>(from)); });
    }
  }

 private:
  void text(const DynamicType& type, const char* given, const std::string& place) {
    const std::string_view text = given ? given : "";
    if (type.kind == Kind::String) {
      if (type.bound > 0) writer_.check_bound(text.size(), type.bound, place.c_str());
      return writer_.write_string(text);
    }
    const std::wstring wide = idl::from_utf8(text);
    if (type.bound > 0) writer_.check_bound(idl::utf16(wide).size(), type.bound, place.c_str());
    writer_.write_wide_string(wide);
  }

  static void check(const Sequence& given, const std::string& place) {
    if (given.size == 0 || given.data) return;
    throw InvalidArgument(place + " has " + std::to_string(given.size) + " elements at NULL");
  }

  void sequence(const DynamicType& type, const Sequence& given, const std::string& place) {
    check(given, place);
    if (type.bound > 0) writer_.check_bound(given.size, type.bound, place.c_str());
    const DynamicType& element = *type.elements[0];
    const CdrWriter::Delimiter delimiter(writer_,
                                         writer_.is_xcdr2() && element.is_delimited_element());
    writer_.write_length(given.size);
    elements(element, given.size, given.data, place);
  }

  /// Arrays of arrays are one array, here and on the wire.
  void array(const DynamicType& type, const std::byte* from, const std::string& place) {
    const Items items(type);
    const CdrWriter::Delimiter delimiter(writer_,
                                         writer_.is_xcdr2() && items.item->is_delimited_element());
    elements(*items.item, items.count, from, place);
  }

  void elements(const DynamicType& type, std::size_t count, const std::byte* from,
                const std::string& place) {
    if (is_plain(type.kind)) {
      return idl::with_primitive(type.kind, [&](auto zero) {
        writer_.write_array(reinterpret_cast<const decltype(zero)*>(from), count);
      });
    }
    const std::size_t size = layout_of(type).size;
    for (std::size_t i = 0; i < count; ++i) value(type, from + i * size, place);
  }

  void map(const DynamicType& type, const Sequence& given, const std::string& place) {
    check(given, place);
    if (type.bound > 0) writer_.check_bound(given.size, type.bound, place.c_str());
    const CdrWriter::Delimiter delimiter(writer_, writer_.is_xcdr2());
    writer_.write_length(given.size);
    Layout pair;
    const std::size_t second = pair_layout(type, pair);
    for (std::size_t i = 0; i < given.size; ++i) {
      value(*type.elements[0], given.data + i * pair.size, place);
      value(*type.elements[1], given.data + i * pair.size + second, place);
    }
  }

  void reference(const skein_reference& given) {
    ServiceReference reference;
    if (given.interface_name) reference.interface_name = given.interface_name;
    if (given.instance) reference.instance = given.instance;
    std::ranges::copy(given.provider, reference.provider.bytes.begin());
    encode(writer_, reference);
  }

  void declared(const DynamicType& type, const std::byte* from) {
    if (type.declaration->kind >= DeclarationKind::Enumeration) return integer(type, from);
    const CdrWriter::Nesting nesting(writer_);
    const auto extensibility = type.declaration->extensibility;
    const CdrWriter::Delimiter delimiter(writer_, extensibility != Extensibility::Final);
    by_identifier_ = extensibility == Extensibility::Mutable;
    type.is(DeclarationKind::Union) ? switched(type, from) : members(type, from);
  }

  void integer(const DynamicType& type, const std::byte* from) {
    check_enumerator(type, number_at(type, from));
    idl::with_integer(type.declaration->bits,
                      [&](auto zero) { writer_.write(load<decltype(zero)>(from)); });
  }

  void members(const DynamicType& type, const std::byte* from) {
    const bool by_identifier = by_identifier_;
    if (type.members.empty() && !by_identifier) writer_.write(std::uint8_t{0});
    Layout layout;
    for (const DynamicType::Member& each : type.members) {
      member(each, from + layout.add(layout_of(each)), by_identifier);
    }
  }

  void member(const DynamicType::Member& member, const std::byte* from, bool by_identifier) {
    const DynamicType* type = member.type;
    if (is_pointed_to(member)) {
      from = load<const std::byte*>(from);
      if (!from) throw InvalidArgument(member.place + " is NULL");
    }
    if (!by_identifier) return value(*type, from, member.place);
    if (type->kind == Kind::OptionalMember) {
      from = load<const std::byte*>(from);
      if (!from) return;
      type = type->elements[0];
    }
    const auto length =
        writer_.member(member.described->id,
                       idl::has(member.described->flags, types::MemberFlags::must_understand));
    value(*type, from, member.place);
  }

  void switched(const DynamicType& type, const std::byte* from) {
    static const std::string kPlace = "_d";
    const bool by_identifier = by_identifier_;
    {
      const CdrWriter::Delimiter length =
          by_identifier ? writer_.member(0, true) : CdrWriter::Delimiter(writer_, false);
      value(*type.discriminator, from, kPlace);
    }
    Layout whole;
    const std::size_t at = union_layout(type, whole);
    const DynamicType::Member* const selected = type.selected(number_at(*type.discriminator, from));
    if (selected) member(*selected, from + at, by_identifier);
  }

  CdrWriter& writer_;
  bool by_identifier_ = false;  // of the type that is about to be written
};

}  // namespace

std::size_t struct_size(const DynamicType& type) { return layout_of(type).size; }

Bytes cdr_of_struct(const DynamicType& type, const void* value, std::size_t size) {
  const std::string& name = type.declaration->name;
  if (const std::size_t expected = struct_size(type); size != expected) {
    throw InvalidArgument("the struct for " + name + " has " + std::to_string(size) +
                          " bytes, and should have " + std::to_string(expected) +
                          ": it was compiled from another IDL, or is another struct");
  }
  Bytes message{std::span<const std::byte>(encapsulation(type.representation))};
  idl::append_cdr(message, [&](CdrWriter& writer) {
    StructWriter(writer).value(type, static_cast<const std::byte*>(value), name);
  });
  return message;
}

}  // namespace skein::c
