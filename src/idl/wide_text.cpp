#include "skein/detail/wide_text.hpp"

#include <cstdint>

#include "skein/error.hpp"

namespace skein::idl {
namespace {

constexpr std::uint32_t kFirstBeyond = 0x10000;  ///< The least code point of two units.
constexpr std::uint32_t kLast = 0x10FFFF;
constexpr std::uint32_t kReplacement = 0xFFFD;

std::uint32_t code_point(wchar_t character) {
  const std::uint32_t code = static_cast<char32_t>(character);
  if (code > kLast) {
    throw InvalidArgument(std::to_string(code) + " in wide text is no code point of Unicode");
  }
  return code;
}

bool is_high(std::uint32_t unit) { return unit >= 0xD800 && unit < 0xDC00; }
bool is_low(std::uint32_t unit) { return unit >= 0xDC00 && unit < 0xE000; }

char continuation(std::uint32_t bits) { return static_cast<char>(0x80 | (bits & 0x3F)); }

}  // namespace

std::u16string utf16(std::wstring_view text) {
  std::u16string units;
  units.reserve(text.size());
  for (const wchar_t character : text) {
    const std::uint32_t code = code_point(character);
    if (code >= kFirstBeyond) {
      units += static_cast<char16_t>(0xD800 + ((code - kFirstBeyond) >> 10));
      units += static_cast<char16_t>(0xDC00 + ((code - kFirstBeyond) & 0x3FF));
    } else {
      units += static_cast<char16_t>(code);
    }
  }
  return units;
}

std::wstring from_utf16(std::u16string_view units) {
  std::wstring text;
  text.reserve(units.size());
  for (std::size_t i = 0; i < units.size(); ++i) {
    const std::uint32_t unit = units[i];
    if (is_high(unit) && i + 1 < units.size() && is_low(units[i + 1])) {
      const std::uint32_t low = units[++i];
      text += static_cast<wchar_t>(kFirstBeyond + ((unit - 0xD800) << 10) + (low - 0xDC00));
    } else {
      text += static_cast<wchar_t>(unit);
    }
  }
  return text;
}

std::string utf8(std::wstring_view text) {
  std::string bytes;
  for (const wchar_t character : text) {
    std::uint32_t code = static_cast<char32_t>(character);
    if (code > kLast) code = kReplacement;
    if (code < 0x80) {
      bytes += static_cast<char>(code);
    } else if (code < 0x800) {
      bytes += {static_cast<char>(0xC0 | code >> 6), continuation(code)};
    } else if (code < kFirstBeyond) {
      bytes += {static_cast<char>(0xE0 | code >> 12), continuation(code >> 6), continuation(code)};
    } else {
      bytes += {static_cast<char>(0xF0 | code >> 18), continuation(code >> 12),
                continuation(code >> 6), continuation(code)};
    }
  }
  return bytes;
}

std::wstring from_utf8(std::string_view text) {
  std::wstring wide;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const auto first = static_cast<unsigned char>(text[i]);
    const int more = first < 0x80 ? 0 : first < 0xE0 ? 1 : first < 0xF0 ? 2 : 3;
    std::uint32_t code = more == 0 ? first : first & (0x3FU >> more);
    for (int n = 0; n < more && i + 1 < text.size(); ++n) {
      code = code << 6 | (static_cast<unsigned char>(text[++i]) & 0x3F);
    }
    wide += static_cast<wchar_t>(code);
  }
  return wide;
}

}  // namespace skein::idl
