#include "value_readers.hpp"

#include <algorithm>

#include "mission/component/dictionary.hpp"
#include "mission/xml/words.hpp"

namespace skein::profile {
namespace {

using std::chrono::nanoseconds;

/// As a dictionary would have it.
template <class Number>
Number read_number(const XmlElement& element, const char* name, ValueType type, double least,
                   double greatest, Number fallback, const char* remedy) {
  const auto text = element.maybe_attribute(name);
  if (!text) return fallback;
  DictionaryEntry entry;
  entry.name = name;
  entry.type = type;
  entry.minimum = least;
  entry.maximum = greatest;
  try {
    return std::get<Number>(parse_value(entry, text->value));
  } catch (const InvalidArgument& error) {
    element.findings().error(text->where, error.what(), remedy);
    return fallback;
  }
}

}  // namespace

bool read_boolean(const XmlElement& element, const char* name, bool fallback) {
  const auto text = element.maybe_attribute(name);
  if (!text) return fallback;
  if (text->value == "true" || text->value == "false") return text->value == "true";
  element.findings().error(text->where, std::string(name) + " is " + in_quotes(text->value),
                           "write true or false");
  return fallback;
}

nanoseconds read_time(const XmlElement& element, const char* name, nanoseconds fallback) {
  const auto text = element.maybe_attribute(name);
  if (!text) return fallback;
  try {
    const auto time = parse_duration(text->value);
    if (time > nanoseconds(0)) return time;
    element.findings().error(text->where, std::string(name) + " is zero", "write a length of time");
  } catch (const InvalidArgument& error) {
    element.findings().error(text->where, std::string(name) + ": " + error.what());
  }
  return fallback;
}

int read_count(const XmlElement& element, const char* name, int fallback) {
  return static_cast<int>(read_number<std::int64_t>(element, name, ValueType::Integer, 1, 1000,
                                                    fallback, "write a number from 1 to 1000"));
}

std::size_t read_place(const XmlElement& element, const char* name,
                       std::span<const std::string_view> words, std::size_t fallback,
                       const char* what) {
  const auto word = element.maybe_attribute(name);
  if (!word) return fallback;
  const auto found = std::ranges::find(words, word->value);
  if (found != words.end()) return static_cast<std::size_t>(found - words.begin());
  element.findings().error(word->where, in_quotes(word->value) + " is no " + what,
                           remedy_for(word->value, {words.begin(), words.end()}));
  return fallback;
}

double read_share(const XmlElement& element, const char* name, double fallback) {
  return read_number<double>(element, name, ValueType::Real, 0, 1, fallback,
                             "write a number from 0 to 1");
}

}  // namespace skein::profile
