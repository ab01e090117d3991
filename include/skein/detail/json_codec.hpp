#pragma once

#include <array>
#include <string>
#include <type_traits>
#include <vector>

#include "skein/detail/argument.hpp"
#include "skein/detail/json.hpp"

/// JSON of all IDL types; of generated types by their own `skein_write_json` and `skein_read_json`.
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

template <class Values>
void write_json_elements(JsonWriter& writer, const Values& values) {
  writer.begin_array();
  for (const typename Values::value_type& value : values) write_json(writer, value);
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

template <class T>
void write_json(JsonWriter& writer, const Argument<T>& value) {
  write_json(writer, value.get());
}
template <class T>
void read_json(const JsonReader& reader, Argument<T>& value) {
  read_json(reader, value.own());
}

}  // namespace skein::idl
