#include <algorithm>
#include <array>
#include <type_traits>

#include "dynamic_codec.hpp"
#include "primitive_kind.hpp"
#include "skein/detail/codec.hpp"
#include "skein/detail/service_reference.hpp"

namespace skein::idl {
namespace {

using types::DeclarationKind;
using types::Extensibility;
using types::Kind;

/// Elements of basic types are copied so many at a time.
constexpr std::size_t kChunk = 512;

bool is_plain(Kind kind) { return kind < Kind::LongDouble && kind != Kind::WideChar; }

/// What is left free in a bitset is zero.
std::uint64_t named_bits(const types::Declaration& declaration) {
  if (declaration.kind != DeclarationKind::Bitset) return ~std::uint64_t{0};
  std::uint64_t bits = 0;
  unsigned offset = 0;
  for (const types::BitField& field : declaration.fields) {
    if (!field.name.empty()) bits |= ~std::uint64_t{0} >> (64 - field.width) << offset;
    offset += field.width;
  }
  return bits;
}

class Copier {
 public:
  Copier(CdrReader& reader, CdrWriter& writer) : reader_(reader), writer_(writer) {}

  void value(const DynamicType& type, const std::string& place) {
    reader_.at(place.c_str());
    switch (type.kind) {
      case Kind::WideChar:
        return writer_.write_wide_character(reader_.read_wide_character());
      case Kind::LongDouble:
        return writer_.write_long_double(reader_.read_long_double());
      case Kind::String:
        return text(type, place);
      case Kind::WideString:
        return wide_text(type, place);
      case Kind::Sequence:
        return sequence(type, place);
      case Kind::Array:
        return array(type, place);
      case Kind::Map:
        return map(type, place);
      case Kind::OptionalMember: {
        const bool there = reader_.read<bool>();
        writer_.write(there);
        return there ? value(*type.elements[0], place) : void();
      }
      case Kind::Reference: {
        ServiceReference reference;
        decode(reader_, reference);
        return encode(writer_, reference);
      }
      case Kind::Declared:
        return declared(type);
      default:
        if (!type.elements.empty()) return each_element(type, place);
        with_primitive(type.kind,
                       [&](auto zero) { writer_.write(reader_.read<decltype(zero)>()); });
    }
  }

 private:
  void text(const DynamicType& type, const std::string& place) {
    std::string text;
    reader_.read_string(text);
    if (type.bound > 0) reader_.check_bound(text.size(), type.bound, place.c_str());
    writer_.write_string(text);
  }

  void wide_text(const DynamicType& type, const std::string& place) {
    std::wstring text;
    reader_.read_wide_string(text);
    if (type.bound > 0) reader_.check_bound(utf16(text).size(), type.bound, place.c_str());
    writer_.write_wide_string(text);
  }

  void sequence(const DynamicType& type, const std::string& place) {
    const DynamicType& element = *type.elements[0];
    const bool delimits = reader_.is_xcdr2() && element.is_delimited_element();
    const CdrReader::Delimited delimited(reader_, delimits);
    const CdrWriter::Delimiter delimiter(writer_, delimits_written(element));
    const std::size_t length = reader_.read_length(1);
    if (type.bound > 0) reader_.check_bound(length, type.bound, place.c_str());
    writer_.write_length(length);
    elements(element, length, place);
  }

  bool delimits_written(const DynamicType& element) const {
    return writer_.is_xcdr2() && element.is_delimited_element();
  }

  /// Arrays of arrays are one array on the wire.
  void array(const DynamicType& type, const std::string& place) {
    const DynamicType* item = &type;
    std::size_t count = 1;
    for (; item->kind == Kind::Array; item = item->elements[0]) count *= item->bound;
    const CdrReader::Delimited delimited(reader_,
                                         reader_.is_xcdr2() && item->is_delimited_element());
    const CdrWriter::Delimiter delimiter(writer_, delimits_written(*item));
    elements(*item, count, place);
  }

  void elements(const DynamicType& type, std::size_t count, const std::string& place) {
    if (is_plain(type.kind)) {
      return with_primitive(type.kind, [&](auto zero) { chunks<decltype(zero)>(count); });
    }
    for (std::size_t i = 0; i < count; ++i) value(type, place);
  }

  template <class T>
  void chunks(std::size_t count) {
    std::array<T, kChunk> chunk;
    for (std::size_t size = 0; count > 0; count -= size) {
      size = std::min(count, chunk.size());
      reader_.read_array(chunk.data(), size);
      writer_.write_array(chunk.data(), size);
    }
  }

  void map(const DynamicType& type, const std::string& place) {
    const CdrReader::Delimited delimited(reader_, reader_.is_xcdr2());
    const CdrWriter::Delimiter delimiter(writer_, writer_.is_xcdr2());
    const std::size_t length = reader_.read_length(1);
    if (type.bound > 0) reader_.check_bound(length, type.bound, place.c_str());
    writer_.write_length(length);
    for (std::size_t i = 0; i < length; ++i) each_element(type, place);
  }

  void each_element(const DynamicType& type, const std::string& place) {
    for (const DynamicType* element : type.elements) value(*element, place);
  }

  void declared(const DynamicType& type) {
    const types::Declaration& declaration = *type.declaration;
    reader_.at(declaration.name.c_str());
    if (declaration.kind >= DeclarationKind::Enumeration) {
      integer(type);
    } else if (declaration.extensibility == Extensibility::Mutable) {
      by_text(type);
    } else {
      composed(type, declaration.extensibility == Extensibility::Appendable);
    }
  }

  /// An enumerator, or bits.
  std::int64_t integer(const DynamicType& type) {
    const std::uint64_t mask = named_bits(*type.declaration);
    const std::int64_t number = with_integer(type.declaration->bits, [&](auto zero) {
      const auto read = static_cast<decltype(zero)>(
          static_cast<std::uint64_t>(reader_.read<decltype(zero)>()) & mask);
      writer_.write(read);
      return static_cast<std::int64_t>(read);
    });
    const auto& values = type.declaration->values;
    if (type.is(DeclarationKind::Enumeration) &&
        std::ranges::find(values, number, &types::Value::value) == values.end()) {
      reader_.fail(std::to_string(number) + " is no value of " + type.declaration->name);
    }
    return number;
  }

  /// Members by their identifiers stand in any order, and may be absent: they take the long way.
  void by_text(const DynamicType& type) {
    JsonWriter json;
    decode_dynamic(reader_, json, type);
    write_text(json.take(), type);
  }

  void write_text(const std::string& text, const DynamicType& type) {
    parse_json(text, [&](const JsonReader& json) { encode_dynamic(writer_, json, type); });
  }

  void composed(const DynamicType& type, bool grows) {
    const CdrReader::Nesting nesting(reader_);
    const CdrWriter::Nesting written(writer_);
    const CdrReader::Delimited delimited(reader_, grows);
    const CdrWriter::Delimiter delimiter(writer_, grows);
    if (type.is(DeclarationKind::Union)) return switched(type);
    if (type.members.empty()) unused_octet();
    for (const DynamicType::Member& member : type.members) {
      if (!grows || delimited.more()) {
        value(*member.type, member.place);
      } else {
        initial(member);
      }
    }
  }

  /// Of a struct without members, in which anything may stand.
  void unused_octet() {
    reader_.read<std::uint8_t>();
    writer_.write(std::uint8_t{0});
  }

  void initial(const DynamicType::Member& member) {
    const std::string text = member.initial.empty() ? initial_json(*member.type) : member.initial;
    reader_.take_memory(text.size());
    write_text(text, *member.type);
  }

  void switched(const DynamicType& type) {
    reader_.at("_d");
    const DynamicType::Member* const selected = type.selected(label(*type.discriminator));
    if (selected) value(*selected->type, selected->place);
  }

  std::int64_t label(const DynamicType& type) {
    if (type.kind == Kind::Declared) return integer(type);
    if (type.kind == Kind::WideChar) {
      const wchar_t read = reader_.read_wide_character();
      writer_.write_wide_character(read);
      return read;
    }
    return with_primitive(type.kind, [&](auto zero) -> std::int64_t {
      const auto read = reader_.read<decltype(zero)>();
      writer_.write(read);
      if constexpr (std::is_same_v<decltype(zero), char>) return static_cast<unsigned char>(read);
      return static_cast<std::int64_t>(read);
    });
  }

  CdrReader& reader_;
  CdrWriter& writer_;
};

}  // namespace

void copy_dynamic(CdrReader& reader, CdrWriter& writer, const DynamicType& type) {
  Copier(reader, writer).value(type, type.declaration ? type.declaration->name : "value");
}

}  // namespace skein::idl
