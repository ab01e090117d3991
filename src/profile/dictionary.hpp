#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "profile/finding.hpp"

namespace skein::profile {

enum class ValueType { Integer, Real, Boolean, Text, Duration, Service };

/// `integer`, `real`, `boolean`, `text`, `duration`, `service`: the words of the XML.
std::string_view to_string(ValueType type) noexcept;
/// The type of that word, or nothing.
std::optional<ValueType> maybe_value_type(std::string_view word) noexcept;

enum class EntryKind { Attribute, Parameter };

/// What one attribute or parameter means, wherever it is used.
struct DictionaryEntry {
  EntryKind kind = EntryKind::Attribute;
  std::string name;
  ValueType type = ValueType::Text;
  std::string unit;               ///< Of numbers and durations; empty for none.
  std::optional<double> minimum;  ///< Inclusive, in `unit`.
  std::optional<double> maximum;  ///< Inclusive, in `unit`.
  std::string interface;  ///< Of a service reference: what it must implement; empty for any.
  std::string documentation;
  SourcePosition where;
};

/// A value as its type has it; text and the name of a service are strings.
using Value = std::variant<std::int64_t, double, bool, std::string, std::chrono::nanoseconds>;

/// Reads `text` as the entry demands. An integer or real is a plain number; a boolean is `true` or
/// `false`; a duration is a number in the entry's unit, or a number with one of the units ns, us,
/// ms, s, min, h.
/// Throws InvalidArgument with what is wrong: another type, or a value outside of the range.
Value parse_value(const DictionaryEntry& entry, std::string_view text);

/// A length of time such as `100 ms`; a bare number counts in `default_unit`.
/// Throws InvalidArgument for anything else, negative times and more than 200 years included.
std::chrono::nanoseconds parse_duration(std::string_view text, std::string_view default_unit = "s");

/// A length of time in seconds, as people write it at a command line: what is longer than 200 years
/// becomes that. Throws InvalidArgument for what is no length of time.
double parse_seconds(std::string_view text);

/// Every attribute and parameter that components and profiles may use. Attributes and parameters
/// are two name spaces. An immutable value after reading; may be read from any number of threads.
class Dictionary {
 public:
  Dictionary() = default;
  /// Of two entries of the same kind and name, the first stays.
  explicit Dictionary(std::vector<DictionaryEntry> entries);

  /// The entry, or null; the pointer lives as long as the dictionary.
  const DictionaryEntry* find(EntryKind kind, std::string_view name) const;
  /// Remedy for an unknown name: the nearest known one, or where to add it.
  std::string suggestion(EntryKind kind, std::string_view unknown_name) const;

  const std::vector<DictionaryEntry>& entries() const noexcept { return entries_; }
  bool empty() const noexcept { return entries_.empty(); }

 private:
  std::vector<DictionaryEntry> entries_;
  std::map<std::pair<EntryKind, std::string>, std::size_t, std::less<>> index_;
};

/// Reads a dictionary: `<dictionary>` with entries of the form
/// `<attribute name= type= unit= min= max=>documentation</attribute>`, the same for `<parameter>`,
/// and `interface=` for parameters of type `service`. Throws DescriptionError with every finding.
Dictionary read_dictionary(const std::filesystem::path& file);

/// As read_dictionary(), from text; `file` is what positions name.
Dictionary parse_dictionary(std::string_view xml, const std::string& file);

}  // namespace skein::profile
