#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "mission/xml/finding.hpp"
#include "skein/parameters.hpp"

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

/// A value names a unit, and the entry has one that nothing is converted into: most likely one that
/// is misspelt in the dictionary.
class UnknownUnit : public InvalidArgument {
 public:
  using InvalidArgument::InvalidArgument;
};

/// Reads `text` as the entry demands. A boolean is `true` or `false`. A duration is a number with
/// one of the units ns, us, ms, s, min, h. An integer or real is a number, in the entry's unit; it
/// may name that unit, and a real also another one of the same quantity (lengths, speeds, angles,
/// masses, frequencies: `26.5 km`), from which it is converted.
/// Throws InvalidArgument with what is wrong: another type, a length of time without a unit, or a
/// value outside of the range.
ParameterValue parse_value(const DictionaryEntry& entry, std::string_view text);

/// The same value as a service's attribute says it to other peers: a duration, integer or real as a
/// plain number in the entry's unit. Throws as parse_value() does.
std::string plain_text(const DictionaryEntry& entry, std::string_view text);

/// A length of time such as `100 ms`. Throws InvalidArgument for anything else: a number without a
/// unit, negative times and more than 50 years included.
std::chrono::nanoseconds parse_duration(std::string_view text);

/// A length of time in seconds, as people write it at a command line: what is longer than 50 years
/// becomes that. Throws InvalidArgument for what is no length of time.
double parse_seconds(std::string_view text);

/// Every attribute and parameter that components and profiles may use. Attributes and parameters
/// are two name spaces. An immutable value after reading; may be read from any number of threads.
class Dictionary {
 public:
  Dictionary() = default;
  /// Of two entries of the same kind and name, the first stays.
  explicit Dictionary(std::vector<DictionaryEntry> entries);

  /// For a file that could not be read, which is told: nothing is known of any name.
  static Dictionary unread();
  bool is_read() const noexcept { return read_; }

  /// The entry, or null; the pointer lives as long as the dictionary.
  const DictionaryEntry* find(EntryKind kind, std::string_view name) const;
  /// Remedy for an unknown name: that it is one of the other kind, the nearest known one, or where
  /// to add it.
  std::string suggestion(EntryKind kind, std::string_view unknown_name) const;

  const std::vector<DictionaryEntry>& entries() const noexcept { return entries_; }
  bool empty() const noexcept { return entries_.empty(); }

 private:
  bool read_ = true;
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
