#pragma once

#include <algorithm>
#include <array>
#include <map>
#include <optional>
#include <string>
#include <type_traits>
#include <vector>

#include "skein/detail/argument.hpp"
#include "skein/detail/box.hpp"
#include "skein/detail/cdr.hpp"
#include "skein/detail/lendable.hpp"
#include "skein/detail/plain_layout.hpp"
#include "skein/detail/wide_text.hpp"

/// CDR of all IDL types: basic types, strings, sequences, arrays, and generated types, by their own
/// `skein_encode` and `skein_decode`.
namespace skein::idl {

template <class T>
void encode(CdrWriter& writer, const T& value) {
  if constexpr (Primitive<T>) {
    writer.write(value);
  } else {
    skein_encode(writer, value);
  }
}

template <class T>
void decode(CdrReader& reader, T& value) {
  if constexpr (Primitive<T>) {
    value = reader.read<T>();
  } else {
    skein_decode(reader, value);
  }
}

inline void encode(CdrWriter& writer, const std::string& value) { writer.write_string(value); }
inline void decode(CdrReader& reader, std::string& value) { reader.read_string(value); }

inline void encode(CdrWriter& writer, const wchar_t& value) { writer.write_wide_character(value); }
inline void decode(CdrReader& reader, wchar_t& value) { value = reader.read_wide_character(); }

inline void encode(CdrWriter& writer, const long double& value) { writer.write_long_double(value); }
inline void decode(CdrReader& reader, long double& value) { value = reader.read_long_double(); }

inline void encode(CdrWriter& writer, const std::wstring& value) {
  writer.write_wide_string(value);
}
inline void decode(CdrReader& reader, std::wstring& value) { reader.read_wide_string(value); }

/// Whether XCDR2 has a length in bytes before a sequence, array or map of such elements.
template <class T>
inline constexpr bool kDelimited = !Primitive<T> && !kBasicOnTheWire<T>;

/// Writes `count` values of a plain layout as their basic elements.
template <PlainlyLaidOut T>
void encode_elements(CdrWriter& writer, const T* values, std::size_t count) {
  using Element = typename PlainLayout<T>::Element;
  writer.write_array(reinterpret_cast<const Element*>(values),
                     count * (sizeof(T) / sizeof(Element)));
}

template <PlainlyLaidOut T>
void decode_elements(CdrReader& reader, T* values, std::size_t count) {
  using Element = typename PlainLayout<T>::Element;
  reader.read_array(reinterpret_cast<Element*>(values), count * (sizeof(T) / sizeof(Element)));
}

template <class T, std::size_t kSize>
void encode(CdrWriter& writer, const std::array<T, kSize>& values);
template <class T, std::size_t kSize>
void decode(CdrReader& reader, std::array<T, kSize>& values);

/// What arrays of arrays are made of: on the wire they are one array.
template <class T>
struct Item {
  using Type = T;
};
template <class T, std::size_t kSize>
struct Item<std::array<T, kSize>> : Item<T> {};
template <class T>
using ItemOf = typename Item<T>::Type;

template <class T>
void encode_item(CdrWriter& writer, const T& value) {
  encode(writer, value);
}
template <class T>
void decode_item(CdrReader& reader, T& value) {
  decode(reader, value);
}
template <class T, std::size_t kSize>
void encode_items(CdrWriter& writer, const std::array<T, kSize>& values);
template <class T, std::size_t kSize>
void decode_items(CdrReader& reader, std::array<T, kSize>& values);
template <class T, std::size_t kSize>
void encode_item(CdrWriter& writer, const std::array<T, kSize>& values) {
  encode_items(writer, values);
}
template <class T, std::size_t kSize>
void decode_item(CdrReader& reader, std::array<T, kSize>& values) {
  decode_items(reader, values);
}

/// The elements of an array without what precedes the outermost one.
template <class T, std::size_t kSize>
void encode_items(CdrWriter& writer, const std::array<T, kSize>& values) {
  if constexpr (PlainlyLaidOut<T>) {
    encode_elements(writer, values.data(), kSize);
  } else {
    for (const T& value : values) encode_item(writer, value);
  }
}

template <class T, std::size_t kSize>
void decode_items(CdrReader& reader, std::array<T, kSize>& values) {
  if constexpr (PlainlyLaidOut<T>) {
    decode_elements(reader, values.data(), kSize);
  } else {
    for (T& value : values) decode_item(reader, value);
  }
}

template <class T, std::size_t kSize>
void encode(CdrWriter& writer, const std::array<T, kSize>& values) {
  const CdrWriter::Delimiter delimiter(writer, writer.is_xcdr2() && kDelimited<ItemOf<T>>);
  encode_items(writer, values);
}

template <class T, std::size_t kSize>
void decode(CdrReader& reader, std::array<T, kSize>& values) {
  const CdrReader::Delimited delimited(reader, reader.is_xcdr2() && kDelimited<ItemOf<T>>);
  decode_items(reader, values);
}

template <class T>
void encode(CdrWriter& writer, const std::vector<T>& values) {
  const CdrWriter::Delimiter delimiter(writer, writer.is_xcdr2() && kDelimited<T>);
  writer.write_length(values.size());
  if constexpr (PlainlyLaidOut<T>) {
    encode_elements(writer, values.data(), values.size());
  } else if constexpr (std::is_same_v<T, bool>) {
    for (const bool value : values) writer.write(value);
  } else {
    for (const T& value : values) encode(writer, value);
  }
}

template <class T>
void decode(CdrReader& reader, std::vector<T>& values) {
  const CdrReader::Delimited delimited(reader, reader.is_xcdr2() && kDelimited<T>);
  if constexpr (PlainlyLaidOut<T>) {
    const std::size_t length = reader.read_length(sizeof(T));
    if constexpr (Primitive<T> && sizeof(T) == 1) {
      const auto* first = reinterpret_cast<const T*>(reader.read_bytes(length).data());
      values.assign(first, first + length);  // Not cleared before it is written.
    } else {
      values.resize(length);
      decode_elements(reader, values.data(), length);
    }
  } else {
    const std::size_t length = reader.read_length(1);
    values.clear();
    // Reserves at most twice the size of the message; more only as elements come.
    values.reserve(std::min(length, 2 * reader.remaining() / sizeof(T) + 1));
    for (std::size_t i = 0; i < length; ++i) {
      if constexpr (std::is_same_v<T, bool>) {
        values.push_back(reader.read<bool>());
      } else {
        reader.take_memory(sizeof(T));
        decode(reader, values.emplace_back());
      }
    }
  }
}

/// A map is the sequence of its pairs, in the order of the keys.
template <class Key, class Value>
void encode(CdrWriter& writer, const std::map<Key, Value>& values) {
  const CdrWriter::Delimiter delimiter(writer, writer.is_xcdr2());
  writer.write_length(values.size());
  for (const auto& [key, value] : values) {
    encode(writer, key);
    encode(writer, value);
  }
}

template <class Key, class Value>
void decode(CdrReader& reader, std::map<Key, Value>& values) {
  const CdrReader::Delimited delimited(reader, reader.is_xcdr2());
  values.clear();
  for (std::size_t left = reader.read_length(1); left > 0; --left) {
    Key key{};
    decode(reader, key);
    const auto [place, is_new] = values.try_emplace(std::move(key));
    if (!is_new) reader.fail("a key is there twice");
    decode(reader, place->second);
  }
}

/// An optional member of a @final or @appendable struct.
template <class T>
void encode(CdrWriter& writer, const std::optional<T>& value) {
  writer.write(value.has_value());
  if (value) encode(writer, *value);
}
template <class T>
void decode(CdrReader& reader, std::optional<T>& value) {
  if (reader.read<bool>()) {
    decode(reader, value.emplace());
  } else {
    value.reset();
  }
}

template <class T>
void encode(CdrWriter& writer, const Box<T>& value) {
  encode(writer, *value);
}
template <class T>
void decode(CdrReader& reader, Box<T>& value) {
  decode(reader, *value);
}

/// Parameters that may be left out of a request, as both sides can read them where they lie.
template <class T>
inline constexpr bool kMayBeLeftOut = Lendable<T> && sizeof(T) >= std::size_t{4096};

template <class T>
void encode(CdrWriter& writer, const Argument<T>& value) {
  if constexpr (kMayBeLeftOut<T>) {
    if (writer.leave_out(&value.get(), sizeof(T))) return;
  }
  encode(writer, value.get());
}
template <class T>
void decode(CdrReader& reader, Argument<T>& value) {
  if constexpr (kMayBeLeftOut<T>) {
    if (const void* const left_out = reader.left_out(sizeof(T), alignof(T))) {
      value = Argument<T>::borrow(*static_cast<const T*>(left_out));
      return;
    }
  }
  decode(reader, value.own());
}

/// A whole message: encapsulation header and value.
template <class T>
Bytes encode_message(const T& value) {
  Bytes message{std::span<const std::byte>(encapsulation(kRepresentation<T>))};
  append_cdr(message, [&](CdrWriter& writer) { encode(writer, value); });
  return message;
}

/// Decodes a whole message; ignores what follows the value. Throws MalformedSample.
template <class T>
T decode_message(std::span<const std::byte> message) {
  T value{};
  read_cdr(message, kEncapsulation.size(), kRepresentation<T>,
           [&](CdrReader& reader) { decode(reader, value); });
  return value;
}

}  // namespace skein::idl
