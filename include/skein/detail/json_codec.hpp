#pragma once

#include <array>
#include <map>
#include <optional>
#include <string>
#include <type_traits>
#include <vector>

#include "skein/detail/argument.hpp"
#include "skein/detail/box.hpp"
#include "skein/detail/json.hpp"

/// JSON of all IDL types, and text for people; of generated types by their own `skein_write_json`
/// and `skein_read_json`.
namespace skein::idl {

template <class T>
void write_json(JsonWriter& writer, const T& value) {
  if constexpr (Primitive<T>) {
    writer.write(value);
  } else {
    skein_write_json(writer, value);
  }
}

template <class T>
void read_json(const JsonReader& reader, T& value) {
  if constexpr (Primitive<T>) {
    value = reader.read<T>();
  } else {
    skein_read_json(reader, value);
  }
}

inline void write_json(JsonWriter& writer, const std::string& value) { writer.write_string(value); }
inline void read_json(const JsonReader& reader, std::string& value) {
  value = reader.read_string();
}

void write_json(JsonWriter& writer, const wchar_t& value);
void read_json(const JsonReader& reader, wchar_t& value);
/// As text, because JSON's numbers are read as double.
void write_json(JsonWriter& writer, const long double& value);
void read_json(const JsonReader& reader, long double& value);
void write_json(JsonWriter& writer, const std::wstring& value);
void read_json(const JsonReader& reader, std::wstring& value);

template <class Values>
void write_json_elements(JsonWriter& writer, const Values& values) {
  std::size_t written = 0;
  writer.begin_array();
  for (const typename Values::value_type& value : values) {
    if (writer.omits(written++, values.size())) break;
    write_json(writer, value);
  }
  writer.end_array();
}

template <class T, std::size_t kSize>
void write_json(JsonWriter& writer, const std::array<T, kSize>& values) {
  write_json_elements(writer, values);
}

template <class T>
void write_json(JsonWriter& writer, const std::vector<T>& values) {
  write_json_elements(writer, values);
}

template <class T, std::size_t kSize>
void read_json(const JsonReader& reader, std::array<T, kSize>& values) {
  reader.expect_size(kSize);
  for (std::size_t i = 0; i < kSize; ++i) read_json(reader.element(i), values[i]);
}

template <class T>
void read_json(const JsonReader& reader, std::vector<T>& values) {
  values.clear();
  const std::size_t size = reader.array_size();
  for (std::size_t i = 0; i < size; ++i) {
    T value{};
    read_json(reader.element(i), value);
    values.push_back(std::move(value));
  }
}

/// An array of `{"key": …, "value": …}`.
template <class Key, class Value>
void write_json(JsonWriter& writer, const std::map<Key, Value>& values) {
  std::size_t written = 0;
  writer.begin_array();
  for (const auto& [key, value] : values) {
    if (writer.omits(written++, values.size())) break;
    writer.begin_object();
    writer.key("key");
    write_json(writer, key);
    writer.key("value");
    write_json(writer, value);
    writer.end_object();
  }
  writer.end_array();
}

template <class Key, class Value>
void read_json(const JsonReader& reader, std::map<Key, Value>& values) {
  static constexpr std::string_view members[] = {"key", "value"};
  values.clear();
  const std::size_t size = reader.array_size();
  for (std::size_t i = 0; i < size; ++i) {
    const JsonReader pair = reader.element(i);
    pair.expect_members("a pair of a map", members);
    Key key{};
    read_json(pair.member("key"), key);
    const auto [place, is_new] = values.try_emplace(std::move(key));
    if (!is_new) pair.fail("has a key that is there already");
    read_json(pair.member("value"), place->second);
  }
}

/// null where there is no value.
template <class T>
void write_json(JsonWriter& writer, const std::optional<T>& value) {
  if (value) {
    write_json(writer, *value);
  } else {
    writer.write_null();
  }
}
template <class T>
void read_json(const JsonReader& reader, std::optional<T>& value) {
  if (reader.is_null()) return value.reset();
  read_json(reader, value.emplace());
}

/// The names of the bits that are set; bits without a name follow as one number.
void write_json_flags(JsonWriter& writer, std::uint64_t value, std::span<const Flag> flags);
std::uint64_t read_json_flags(const JsonReader& reader, std::string_view type,
                              std::span<const Flag> flags);

/// The name of an enumerator; of a value that is none, the type and its number.
std::string enumerator_text(std::string_view type, std::span<const std::string_view> names,
                            std::size_t index, std::int64_t value);

/// The value of a bit field of so many bits.
template <class T>
T read_json_bits(const JsonReader& reader, unsigned bits) {
  const T value = reader.read<T>();
  if constexpr (!std::is_same_v<T, bool>) {
    if (bits < 8 * sizeof(T)) {
      const T limit = static_cast<T>(T{1} << (bits - (std::is_signed_v<T> ? 1 : 0)));
      if (value >= limit || (std::is_signed_v<T> && value < -limit)) {
        reader.fail("does not fit into " + std::to_string(bits) + " bits");
      }
    }
  }
  return value;
}

template <class T>
void write_json(JsonWriter& writer, const Box<T>& value) {
  write_json(writer, *value);
}
template <class T>
void read_json(const JsonReader& reader, Box<T>& value) {
  read_json(reader, *value);
}

/// A value for people.
template <class T>
std::string text_of(const T& value) {
  JsonWriter writer(JsonWriter::Style::Text);
  write_json(writer, value);
  return writer.take();
}

template <class T>
void write_json(JsonWriter& writer, const Argument<T>& value) {
  write_json(writer, value.get());
}
template <class T>
void read_json(const JsonReader& reader, Argument<T>& value) {
  read_json(reader, value.own());
}

}  // namespace skein::idl
