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

using idl::CdrReader;
using idl::DynamicType;
using types::DeclarationKind;
using types::Extensibility;
using types::Kind;

/// Reads this side's version of types; what other versions lack was made before (copy_dynamic).
class StructReader {
 public:
  StructReader(CdrReader& reader, std::pmr::memory_resource& memory)
      : reader_(reader), memory_(memory) {}

  void value(const DynamicType& type, std::byte* to, const std::string& place) {
    reader_.at(place.c_str());
    switch (type.kind) {
      case Kind::WideChar:
        return store(to, static_cast<std::uint16_t>(reader_.read_wide_character()));
      case Kind::LongDouble:
        return store(to, reader_.read_long_double());
      case Kind::String: {
        reader_.read_string(text_);
        return store(to, kept(text_));
      }
      case Kind::WideString: {
        std::wstring wide;
        reader_.read_wide_string(wide);
        return store(to, kept(idl::utf8(wide)));
      }
      case Kind::Sequence:
        return sequence(type, to, place);
      case Kind::Map:
        return map(type, to, place);
      case Kind::Array:
        return array(type, to, place);
      case Kind::OptionalMember:
        return store(to, reader_.read<bool>() ? pointed(*type.elements[0], place) : nullptr);
      case Kind::Reference:
        return reference(to);
      case Kind::Declared:
        return declared(type, to);
      default:
        idl::with_primitive(type.kind,
                            [&](auto zero) { store(to, reader_.read<decltype(zero)>()); });
    }
  }

  /// Zeros. Fails if all together takes far more than the message.
  std::byte* room(std::size_t size, std::size_t alignment) {
    reader_.take_memory(size);
    auto* const room =
        static_cast<std::byte*>(memory_.allocate(std::max<std::size_t>(size, 1), alignment));
    std::memset(room, 0, size);
    return room;
  }

 private:
  std::byte* elements_room(std::size_t count, const Layout& element) {
    if (count > SIZE_MAX / std::max<std::size_t>(element.size, 1)) reader_.fail("it is too large");
    return room(count * element.size, element.alignment);
  }

  const char* kept(std::string_view text) {
    auto* const room = static_cast<char*>(memory_.allocate(text.size() + 1, 1));
    *std::ranges::copy(text, room).out = '\0';
    return room;
  }

  const std::byte* pointed(const DynamicType& type, const std::string& place) {
    const Layout layout = layout_of(type);
    std::byte* const at = room(layout.size, layout.alignment);
    value(type, at, place);
    return at;
  }

  void sequence(const DynamicType& type, std::byte* to, const std::string& place) {
    const DynamicType& element = *type.elements[0];
    const CdrReader::Delimited delimited(reader_,
                                         reader_.is_xcdr2() && element.is_delimited_element());
    const std::size_t length = reader_.read_length(1);
    const Layout layout = layout_of(element);
    std::byte* const first = elements_room(length, layout);
    elements(element, length, first, place);
    store(to, Sequence{first, length});
  }

  void array(const DynamicType& type, std::byte* to, const std::string& place) {
    const Items items(type);
    const CdrReader::Delimited delimited(reader_,
                                         reader_.is_xcdr2() && items.item->is_delimited_element());
    elements(*items.item, items.count, to, place);
  }

  void elements(const DynamicType& type, std::size_t count, std::byte* to,
                const std::string& place) {
    if (is_plain(type.kind)) {
      return idl::with_primitive(type.kind, [&](auto zero) {
        reader_.read_array(reinterpret_cast<decltype(zero)*>(to), count);
      });
    }
    const std::size_t size = layout_of(type).size;
    for (std::size_t i = 0; i < count; ++i) value(type, to + i * size, place);
  }

  void map(const DynamicType& type, std::byte* to, const std::string& place) {
    const CdrReader::Delimited delimited(reader_, reader_.is_xcdr2());
    const std::size_t length = reader_.read_length(1);
    Layout pair;
    const std::size_t second = pair_layout(type, pair);
    std::byte* const first = elements_room(length, pair);
    for (std::size_t i = 0; i < length; ++i) {
      value(*type.elements[0], first + i * pair.size, place);
      value(*type.elements[1], first + i * pair.size + second, place);
    }
    store(to, Sequence{first, length});
  }

  void reference(std::byte* to) {
    ServiceReference read;
    decode(reader_, read);
    skein_reference reference{kept(read.interface_name), {}, kept(read.instance)};
    std::ranges::copy(read.provider.bytes, reference.provider);
    store(to, reference);
  }

  void declared(const DynamicType& type, std::byte* to) {
    if (type.declaration->kind >= DeclarationKind::Enumeration) {
      return idl::with_integer(type.declaration->bits,
                               [&](auto zero) { store(to, reader_.read<decltype(zero)>()); });
    }
    const CdrReader::Nesting nesting(reader_);
    const auto extensibility = type.declaration->extensibility;
    const CdrReader::Delimited delimited(reader_, extensibility != Extensibility::Final);
    by_identifier_ = extensibility == Extensibility::Mutable;
    type.is(DeclarationKind::Union) ? switched(type, to) : members(type, to);
  }

  /// What copy_dynamic() writes has all members, in their order, but for absent optional ones.
  void members(const DynamicType& type, std::byte* to) {
    if (by_identifier_) return identified(type, to);
    if (type.members.empty()) reader_.read<std::uint8_t>();
    Layout layout;
    for (const DynamicType::Member& each : type.members) {
      member(each, to + layout.add(layout_of(each)));
    }
  }

  void member(const DynamicType::Member& member, std::byte* to) {
    if (is_pointed_to(member)) return store(to, pointed(*member.type, member.place));
    value(*member.type, to, member.place);
  }

  void identified(const DynamicType& type, std::byte* to) {
    while (reader_.remaining() > 0) {
      const CdrReader::Member found = reader_.read_member();
      const CdrReader::Delimited content(reader_, found.length);
      Layout layout;
      for (const DynamicType::Member& each : type.members) {
        const std::size_t at = layout.add(layout_of(each));
        if (each.described->id == found.id) present(each, to + at);
      }
    }
  }

  /// The content of a member with an identifier, which an optional one has without its flag.
  void present(const DynamicType::Member& each, std::byte* to) {
    if (each.type->kind != Kind::OptionalMember) return member(each, to);
    store(to, pointed(*each.type->elements[0], each.place));
  }

  void switched(const DynamicType& type, std::byte* to) {
    static const std::string kPlace = "_d";
    const bool by_identifier = by_identifier_;
    label(type, to, by_identifier, kPlace);
    Layout whole;
    const std::size_t at = union_layout(type, whole);
    const DynamicType::Member* const selected = type.selected(number_at(*type.discriminator, to));
    if (!selected) return;
    if (!by_identifier) return member(*selected, to + at);
    const CdrReader::Member found = reader_.read_member();
    const CdrReader::Delimited content(reader_, found.length);
    member(*selected, to + at);
  }

  void label(const DynamicType& type, std::byte* to, bool by_identifier, const std::string& place) {
    if (!by_identifier) return value(*type.discriminator, to, place);
    const CdrReader::Member found = reader_.read_member();
    const CdrReader::Delimited content(reader_, found.length);
    value(*type.discriminator, to, place);
  }

  CdrReader& reader_;
  std::pmr::memory_resource& memory_;
  std::string text_;
  bool by_identifier_ = false;  // of the type that is about to be read
};

}  // namespace

StructValue::StructValue(const DynamicType& type, std::span<const std::byte> cdr)
    : memory_(std::make_unique<std::pmr::monotonic_buffer_resource>(cdr.size() + 64)) {
  const Layout layout = layout_of(type);
  size_ = layout.size;
  idl::read_cdr(cdr, idl::kEncapsulation.size(), type.representation, [&](CdrReader& reader) {
    StructReader read(reader, *memory_);
    std::byte* const whole = read.room(layout.size, layout.alignment);
    read.value(type, whole, type.declaration->name);
    data_ = whole;
  });
}

}  // namespace skein::c
