#pragma once

#include <chrono>

#include "xml_element.hpp"

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

}  // namespace skein::profile
