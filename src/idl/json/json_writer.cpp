#include <array>
#include <charconv>
#include <cmath>
#include <nlohmann/json.hpp>

#include "skein/detail/json.hpp"

namespace skein::idl {

namespace {

constexpr std::size_t kMostElements = 64;  // for people

}  // namespace

void JsonWriter::separate() {
  if (!first_) text_ += style_ == Style::Json ? "," : ", ";
  first_ = false;
}

void JsonWriter::begin_object(std::string_view type) {
  separate();
  if (style_ == Style::Text) text_ += type;
  text_ += '{';
  first_ = true;
}

void JsonWriter::begin_array() {
  separate();
  text_ += '[';
  first_ = true;
}

bool JsonWriter::omits(std::size_t written, std::size_t size) {
  if (style_ == Style::Json || written < kMostElements) return false;
  separate();
  text_ += "... " + std::to_string(size) + " elements";
  return true;
}

void JsonWriter::close(char bracket) {
  text_ += bracket;
  first_ = false;
}

void JsonWriter::key(std::string_view name) {
  if (style_ == Style::Json) {
    write_string(name);
    text_ += ':';
  } else {
    separate();
    if (name != "_d") (text_ += name) += '=';
  }
  first_ = true;
}

void JsonWriter::write_string(std::string_view text) {
  separate();
  text_ += nlohmann::json(text).dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

void JsonWriter::write_name(std::string_view name) {
  style_ == Style::Json ? write_string(name) : write_raw(name);
}

void JsonWriter::write_null() { write_raw(style_ == Style::Json ? "null" : "nothing"); }

void JsonWriter::write_raw(std::string_view json) {
  separate();
  text_ += json;
}

template <Primitive T>
void JsonWriter::write(T value) {
  if constexpr (std::is_same_v<T, bool>) {
    separate();
    text_ += value ? "true" : "false";
  } else if constexpr (std::is_same_v<T, char>) {
    const auto code = static_cast<unsigned char>(value);
    std::string utf8(1, value);
    if (code >= 0x80)
      utf8 = {static_cast<char>(0xC0 | code >> 6), static_cast<char>(0x80 | (code & 0x3F))};
    write_string(utf8);
  } else {
    if constexpr (std::is_floating_point_v<T>) {
      if (std::isnan(value)) return write_name("NaN");
      if (std::isinf(value)) return write_name(value > 0 ? "Infinity" : "-Infinity");
      // "-0" is an integer to most readers, which has no sign.
      if (value == 0 && std::signbit(value)) return write_raw("-0.0");
    }
    separate();
    std::array<char, 32> digits;
    const auto end = std::to_chars(digits.data(), digits.data() + digits.size(), value).ptr;
    text_.append(digits.data(), end);
  }
}

template void JsonWriter::write<bool>(bool);
template void JsonWriter::write<char>(char);
template void JsonWriter::write<std::uint8_t>(std::uint8_t);
template void JsonWriter::write<std::int8_t>(std::int8_t);
template void JsonWriter::write<std::int16_t>(std::int16_t);
template void JsonWriter::write<std::uint16_t>(std::uint16_t);
template void JsonWriter::write<std::int32_t>(std::int32_t);
template void JsonWriter::write<std::uint32_t>(std::uint32_t);
template void JsonWriter::write<std::int64_t>(std::int64_t);
template void JsonWriter::write<std::uint64_t>(std::uint64_t);
template void JsonWriter::write<float>(float);
template void JsonWriter::write<double>(double);

}  // namespace skein::idl
