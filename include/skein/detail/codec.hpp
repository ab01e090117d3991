#pragma once

#include <algorithm>
#include <array>
#include <string>
#include <type_traits>
#include <vector>

#include "skein/detail/argument.hpp"
#include "skein/detail/cdr.hpp"
#include "skein/detail/plain_layout.hpp"

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
void encode(CdrWriter& writer, const std::array<T, kSize>& values) {
  if constexpr (PlainlyLaidOut<T>) {
    encode_elements(writer, values.data(), kSize);
  } else {
    for (const T& value : values) encode(writer, value);
  }
}

template <class T, std::size_t kSize>
void decode(CdrReader& reader, std::array<T, kSize>& values) {
  if constexpr (PlainlyLaidOut<T>) {
    decode_elements(reader, values.data(), kSize);
  } else {
    for (T& value : values) decode(reader, value);
  }
}

template <class T>
void encode(CdrWriter& writer, const std::vector<T>& values) {
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
        decode(reader, values.emplace_back());
      }
    }
  }
}

template <class T>
void encode(CdrWriter& writer, const Argument<T>& value) {
  encode(writer, value.get());
}
template <class T>
void decode(CdrReader& reader, Argument<T>& value) {
  decode(reader, value.own());
}

/// A whole message: encapsulation header and value.
template <class T>
Bytes encode_message(const T& value) {
  Bytes message{std::span<const std::byte>(kEncapsulation)};
  append_cdr(message, [&](CdrWriter& writer) { encode(writer, value); });
  return message;
}

/// Decodes a whole message; ignores what follows the value. Throws MalformedSample.
template <class T>
T decode_message(std::span<const std::byte> message) {
  T value{};
  read_cdr(message, kEncapsulation.size(), [&](CdrReader& reader) { decode(reader, value); });
  return value;
}

}  // namespace skein::idl
