#pragma once

#include <array>
#include <iosfwd>
#include <map>
#include <optional>
#include <ostream>
#include <sstream>
#include <string>
#include <string_view>
#include <vector>

#include "skein/detail/argument.hpp"
#include "skein/detail/box.hpp"
#include "skein/detail/cdr.hpp"

/// Readable text of all IDL types: `Route{points=[Point{x=1, y=2}], name="north"}`. For people;
/// only JSON reads back.
namespace skein::idl {

/// Of a longer sequence only this many elements are printed.
inline constexpr std::size_t kPrintedElements = 64;

template <Primitive T>
void print_primitive(std::ostream& stream, T value);
void print_text(std::ostream& stream, std::string_view text);
void print_omission(std::ostream& stream, std::size_t size);

template <class T>
void print(std::ostream& stream, const T& value) {
  if constexpr (Primitive<T>) {
    print_primitive(stream, value);
  } else {
    stream << value;
  }
}

inline void print(std::ostream& stream, const std::string& value) { print_text(stream, value); }
void print(std::ostream& stream, const wchar_t& value);
void print(std::ostream& stream, const long double& value);
void print(std::ostream& stream, const std::wstring& value);
/// `a|b`; bits without a name follow as one number.
void print_flags(std::ostream& stream, std::uint64_t value, std::span<const Flag> flags);

template <class T, std::size_t kSize>
void print(std::ostream& stream, const std::array<T, kSize>& values);
template <class T>
void print(std::ostream& stream, const std::vector<T>& values);

template <class Key, class Value>
void print(std::ostream& stream, const std::map<Key, Value>& values);
template <class T>
void print(std::ostream& stream, const Box<T>& value);

template <class T>
void print(std::ostream& stream, const std::optional<T>& value) {
  if (value) {
    print(stream, *value);
  } else {
    stream << "nothing";
  }
}

template <class Values>
void print_elements(std::ostream& stream, const Values& values) {
  std::size_t printed = 0;
  stream << '[';
  for (const typename Values::value_type& value : values) {
    if (printed > 0) stream << ", ";
    if (printed == kPrintedElements) {
      print_omission(stream, values.size());
      break;
    }
    print(stream, value);
    ++printed;
  }
  stream << ']';
}

template <class T, std::size_t kSize>
void print(std::ostream& stream, const std::array<T, kSize>& values) {
  print_elements(stream, values);
}

template <class T>
void print(std::ostream& stream, const std::vector<T>& values) {
  print_elements(stream, values);
}

template <class Key, class Value>
void print(std::ostream& stream, const std::map<Key, Value>& values) {
  std::size_t printed = 0;
  stream << '{';
  for (const auto& [key, value] : values) {
    if (printed > 0) stream << ", ";
    if (printed == kPrintedElements) {
      print_omission(stream, values.size());
      break;
    }
    print(stream, key);
    stream << ": ";
    print(stream, value);
    ++printed;
  }
  stream << '}';
}

template <class T>
void print(std::ostream& stream, const Box<T>& value) {
  print(stream, *value);
}

template <class T>
void print(std::ostream& stream, const Argument<T>& value) {
  print(stream, value.get());
}

/// The printed form of `value`.
template <class T>
std::string text_of(const T& value) {
  std::ostringstream stream;
  stream << value;
  return std::move(stream).str();
}

}  // namespace skein::idl
