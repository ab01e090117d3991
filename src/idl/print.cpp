#include "skein/detail/print.hpp"

#include <array>
#include <charconv>

#include "skein/detail/wide_text.hpp"

namespace skein::idl {
namespace {

constexpr std::string_view kHexDigits = "0123456789abcdef";

void print_character(std::ostream& stream, char character) {
  switch (character) {
    case '\n':
      stream << "\\n";
      return;
    case '\t':
      stream << "\\t";
      return;
    case '\r':
      stream << "\\r";
      return;
    case '"':
      stream << "\\\"";
      return;
    case '\\':
      stream << "\\\\";
      return;
    default:
      break;
  }
  const auto code = static_cast<unsigned char>(character);
  if (code >= 0x20 && code != 0x7F) {
    stream << character;
  } else {
    stream << "\\x" << kHexDigits[code >> 4] << kHexDigits[code & 0xF];
  }
}

}  // namespace

template <Primitive T>
void print_primitive(std::ostream& stream, T value) {
  if constexpr (std::is_same_v<T, bool>) {
    stream << (value ? "true" : "false");
  } else if constexpr (std::is_same_v<T, char>) {
    stream << '\'';
    print_character(stream, value);
    stream << '\'';
  } else {
    std::array<char, 32> digits;
    const auto end = std::to_chars(digits.data(), digits.data() + digits.size(), value).ptr;
    stream << std::string_view(digits.data(), end);
  }
}

void print_text(std::ostream& stream, std::string_view text) {
  stream << '"';
  for (const char character : text) print_character(stream, character);
  stream << '"';
}

void print(std::ostream& stream, const wchar_t& value) {
  stream << '\'' << utf8({&value, 1}) << '\'';
}

void print(std::ostream& stream, const long double& value) {
  std::array<char, 64> digits;
  const auto end = std::to_chars(digits.data(), digits.data() + digits.size(), value).ptr;
  stream.write(digits.data(), end - digits.data());
}

void print(std::ostream& stream, const std::wstring& value) { print_text(stream, utf8(value)); }

void print_flags(std::ostream& stream, std::uint64_t value, std::span<const Flag> flags) {
  const char* separator = "";
  for (const Flag& flag : flags) {
    if ((value & flag.bit) == 0) continue;
    stream << separator << flag.name;
    separator = "|";
    value &= ~flag.bit;
  }
  if (value != 0 || *separator == '\0') {
    stream << separator;
    print_primitive(stream, value);
  }
}

void print_omission(std::ostream& stream, std::size_t size) {
  stream << "... " << size << " elements";
}

template void print_primitive<bool>(std::ostream&, bool);
template void print_primitive<char>(std::ostream&, char);
template void print_primitive<std::uint8_t>(std::ostream&, std::uint8_t);
template void print_primitive<std::int8_t>(std::ostream&, std::int8_t);
template void print_primitive<std::int16_t>(std::ostream&, std::int16_t);
template void print_primitive<std::uint16_t>(std::ostream&, std::uint16_t);
template void print_primitive<std::int32_t>(std::ostream&, std::int32_t);
template void print_primitive<std::uint32_t>(std::ostream&, std::uint32_t);
template void print_primitive<std::int64_t>(std::ostream&, std::int64_t);
template void print_primitive<std::uint64_t>(std::ostream&, std::uint64_t);
template void print_primitive<float>(std::ostream&, float);
template void print_primitive<double>(std::ostream&, double);

}  // namespace skein::idl
