#pragma once

#include <chrono>
#include <cstddef>
#include <span>
#include <string_view>

#include "mission/xml/xml_element.hpp"

namespace skein::profile {

// The value of an XML attribute; `fallback` where it is missing. A value of another kind or out of
// its range is a finding.

/// `true` or `false`.
bool read_boolean(const XmlElement& element, const char* name, bool fallback);

/// A length of time greater than zero, with its unit.
std::chrono::nanoseconds read_time(const XmlElement& element, const char* name,
                                   std::chrono::nanoseconds fallback);

/// A number from 1 to 1000.
int read_count(const XmlElement& element, const char* name, int fallback);

/// A number from 0 to 1.
double read_share(const XmlElement& element, const char* name, double fallback);

/// The place of one of `words`; `what` is the kind of word that another one is not.
std::size_t read_place(const XmlElement& element, const char* name,
                       std::span<const std::string_view> words, std::size_t fallback,
                       const char* what);

/// For an enumeration; the words stand in the order of its enumerators.
template <class Value, class Words>
Value read_word(const XmlElement& element, const char* name, const Words& words, Value fallback,
                const char* what) {
  return static_cast<Value>(
      read_place(element, name, words, static_cast<std::size_t>(fallback), what));
}

}  // namespace skein::profile
