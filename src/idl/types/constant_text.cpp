#include "constant_text.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>

#include "dynamic_type.hpp"
#include "primitive_kind.hpp"
#include "skein/detail/json_codec.hpp"
#include "skein/detail/wide_text.hpp"
#include "skein/error.hpp"

namespace skein::idl {
namespace {

using types::DeclarationKind;
using types::Kind;

[[noreturn]] void refuse(const std::string& constant) {
  throw InvalidArgument("'" + constant + "' is no constant of the type whose initial value it is");
}

template <class T>
T number(const std::string& constant, std::string_view digits, int base = 10) {
  T value{};
  const auto end = digits.data() + digits.size();
  const auto parsed = [&] {
    if constexpr (std::is_floating_point_v<T>)
      return std::from_chars(digits.data(), end, value);
    else
      return std::from_chars(digits.data(), end, value, base);
  }();
  if (parsed.ec != std::errc() || parsed.ptr != end) refuse(constant);
  return value;
}

/// What stands between the quotes. Escapes are `\ooo`, and in wide text `\uXXXX`.
std::wstring unquoted(const std::string& constant, bool wide, char quote) {
  const std::size_t begin = wide ? 2 : 1;
  if (constant.size() < begin + 1 || (wide && constant[0] != 'L') || constant[begin - 1] != quote ||
      constant.back() != quote) {
    refuse(constant);
  }
  const std::string_view content(constant.data() + begin, constant.size() - begin - 1);
  std::wstring text;
  for (std::size_t at = 0; at < content.size();) {
    if (content[at] != '\\') {
      std::size_t next = at + 1;  // a character of UTF-8 as a whole
      while (next < content.size() && (content[next] & 0xC0) == 0x80) ++next;
      text += from_utf8(content.substr(at, next - at));
      at = next;
      continue;
    }
    const std::size_t length = wide ? 4 : 3;
    const std::size_t first = at + (wide ? 2 : 1);
    if (first + length > content.size()) refuse(constant);
    text += static_cast<wchar_t>(
        number<std::uint32_t>(constant, content.substr(first, length), wide ? 16 : 8));
    at = first + length;
  }
  return text;
}

void write_declared(JsonWriter& writer, const DynamicType& type, const std::string& constant) {
  if (type.is(DeclarationKind::Bitmask)) {
    return write_json_flags(writer, number<std::uint64_t>(constant, constant), type.flags);
  }
  if (!type.is(DeclarationKind::Enumeration) ||
      std::ranges::find(type.names, constant) == type.names.end()) {
    refuse(constant);
  }
  writer.write_string(constant);
}

void write(JsonWriter& writer, const DynamicType& type, const std::string& constant) {
  switch (type.kind) {
    case Kind::OptionalMember:
      return write(writer, *type.elements[0], constant);
    case Kind::Declared:
      return write_declared(writer, type, constant);
    case Kind::Boolean:
      if (constant != "TRUE" && constant != "FALSE") refuse(constant);
      return writer.write(constant == "TRUE");
    case Kind::Char: {
      const std::wstring text = unquoted(constant, false, '\'');
      if (text.size() != 1) refuse(constant);
      return writer.write(static_cast<char>(text[0]));
    }
    case Kind::WideChar:
      return write_json(writer, unquoted(constant, true, '\''));
    case Kind::String: {
      std::string bytes;  // escapes are bytes
      for (const wchar_t each : unquoted(constant, false, '"')) bytes += static_cast<char>(each);
      return writer.write_string(bytes);
    }
    case Kind::WideString:
      return write_json(writer, unquoted(constant, true, '"'));
    case Kind::LongDouble:
      return write_json(writer, number<long double>(constant, constant));
    default:
      if (type.kind > Kind::LongDouble) refuse(constant);
      return with_primitive(type.kind, [&](auto zero) {
        if constexpr (!std::is_same_v<decltype(zero), bool> &&
                      !std::is_same_v<decltype(zero), char>) {
          writer.write(number<decltype(zero)>(constant, constant));
        }
      });
  }
}

}  // namespace

std::string json_of_constant(const DynamicType& type, const std::string& constant) {
  if (constant.empty()) return {};
  JsonWriter writer;
  write(writer, type, constant);
  return writer.take();
}

}  // namespace skein::idl
