#include "skein/detail/json_codec.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <locale>
#include <sstream>

#include "skein/detail/wide_text.hpp"

namespace skein::idl {

void write_json(JsonWriter& writer, const wchar_t& value) {
  writer.write_string(utf8({&value, 1}));
}

void read_json(const JsonReader& reader, wchar_t& value) {
  const std::wstring text = from_utf8(reader.read_string());
  if (text.size() != 1) reader.fail("is no single character");
  value = text[0];
}

void write_json(JsonWriter& writer, const long double& value) {
  if (!std::isfinite(value)) return writer.write(static_cast<double>(value));
  std::array<char, 64> digits;
  const auto end = std::to_chars(digits.data(), digits.data() + digits.size(), value).ptr;
  writer.write_name({digits.data(), end});
}

void read_json(const JsonReader& reader, long double& value) {
  if (reader.is_number()) {
    value = reader.read<double>();
    return;
  }
  const std::string text = reader.read_string();
  if (text == "NaN" || text == "Infinity" || text == "-Infinity") {
    value = reader.read<double>();
    return;
  }
  // std::from_chars() refuses what is less than the least normal number.
  std::istringstream stream(text);
  stream.imbue(std::locale::classic());
  if (!(stream >> std::noskipws >> value) || stream.peek() != EOF) reader.fail("is no number");
}

void write_json(JsonWriter& writer, const std::wstring& value) { writer.write_string(utf8(value)); }

void read_json(const JsonReader& reader, std::wstring& value) {
  value = from_utf8(reader.read_string());
}

void write_json_flags(JsonWriter& writer, std::uint64_t value, std::span<const Flag> flags) {
  writer.begin_array();
  for (const Flag& flag : flags) {
    if ((value & flag.bit) == 0) continue;
    writer.write_name(flag.name);
    value &= ~flag.bit;
  }
  if (value != 0) writer.write(value);
  writer.end_array();
}

std::string enumerator_text(std::string_view type, std::span<const std::string_view> names,
                            std::size_t index, std::int64_t value) {
  if (index < names.size()) return std::string(names[index]);
  return std::string(type) + "(" + std::to_string(value) + ")";
}

std::uint64_t read_json_flags(const JsonReader& reader, std::string_view type,
                              std::span<const Flag> flags) {
  std::vector<std::string_view> names;
  for (const Flag& flag : flags) names.push_back(flag.name);
  std::uint64_t value = 0;
  const std::size_t size = reader.array_size();
  for (std::size_t i = 0; i < size; ++i) {
    const JsonReader element = reader.element(i);
    value |= element.is_number() ? element.read<std::uint64_t>()
                                 : flags[element.read_enum(type, names)].bit;
  }
  return value;
}

}  // namespace skein::idl
