#pragma once

#include <string>
#include <string_view>

/// Wide text between C++, where a `wchar_t` holds a code point, UTF-16 on the wire, and UTF-8 in
/// JSON. A surrogate without its other half is kept as it is, so that nothing is lost.
namespace skein::idl {

/// Throws InvalidArgument for what is no code point.
std::u16string utf16(std::wstring_view text);
std::wstring from_utf16(std::u16string_view units);

/// With a replacement character for what is no code point.
std::string utf8(std::wstring_view text);
/// `text` is valid UTF-8.
std::wstring from_utf8(std::string_view text);

}  // namespace skein::idl
