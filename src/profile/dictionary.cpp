#include "profile/dictionary.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <utility>

#include "words.hpp"

namespace skein::profile {
namespace {

constexpr std::array<std::pair<ValueType, std::string_view>, 6> kTypes{{
    {ValueType::Integer, "integer"},
    {ValueType::Real, "real"},
    {ValueType::Boolean, "boolean"},
    {ValueType::Text, "text"},
    {ValueType::Duration, "duration"},
    {ValueType::Service, "service"},
}};

struct TimeUnit {
  std::string_view name;
  double nanoseconds;
};
constexpr std::array<TimeUnit, 6> kTimeUnits{
    {{"ns", 1}, {"us", 1e3}, {"ms", 1e6}, {"s", 1e9}, {"min", 60e9}, {"h", 3600e9}}};
constexpr double kLongestNanoseconds = 200.0 * 365.25 * 24 * 3600e9;

template <typename Number>
std::optional<Number> maybe_number(std::string_view text) {
  Number number{};
  const auto [stop, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (text.empty() || error != std::errc() || stop != text.data() + text.size())
    return std::nullopt;
  return number;
}

std::optional<double> maybe_finite(std::string_view text) {
  const auto number = maybe_number<double>(text);
  return number && std::isfinite(*number) ? number : std::nullopt;
}

const TimeUnit* find_time_unit(std::string_view name) {
  for (const auto& unit : kTimeUnits) {
    if (unit.name == name) return &unit;
  }
  return nullptr;
}

/// Nothing for what is no length of time; may be longer than any clock counts.
std::optional<double> maybe_nanoseconds(std::string_view text, std::string_view default_unit) {
  const std::string_view whole = trimmed(text);
  const auto number_end = whole.find_last_of("0123456789.") + 1;
  const auto number = maybe_finite(whole.substr(0, number_end));
  const auto unit_name = trimmed(whole.substr(number_end));
  const auto* unit = find_time_unit(unit_name.empty() ? default_unit : unit_name);
  if (!number || unit == nullptr || std::signbit(*number)) return std::nullopt;
  return *number * unit->nanoseconds;
}

[[noreturn]] void refuse_duration(std::string_view text) {
  throw InvalidArgument(in_quotes(text) +
                        " is no length of time; write one like \"100 ms\" (ns, us, ms, s, min, h)");
}

std::string number_text(double number) {
  std::array<char, 32> buffer{};
  const auto end = std::to_chars(buffer.data(), buffer.data() + buffer.size(), number).ptr;
  return std::string(buffer.data(), end);
}

std::string with_unit(double number, const std::string& unit) {
  return number_text(number) + (unit.empty() ? "" : " " + unit);
}

[[noreturn]] void refuse_type(const DictionaryEntry& entry, std::string_view text) {
  std::string problem = in_quotes(entry.name) + " is " + in_quotes(text) + ", which is no " +
                        std::string(to_string(entry.type));
  if (!entry.unit.empty()) problem += " in " + entry.unit;
  throw InvalidArgument(problem);
}

void demand_range(const DictionaryEntry& entry, double number) {
  const bool low = entry.minimum && number < *entry.minimum;
  const bool high = entry.maximum && number > *entry.maximum;
  if (!low && !high) return;
  throw InvalidArgument(in_quotes(entry.name) + " is " + with_unit(number, entry.unit) + ", " +
                        (low ? "less than " + with_unit(*entry.minimum, entry.unit)
                             : "more than " + with_unit(*entry.maximum, entry.unit)));
}

Value parse_time(const DictionaryEntry& entry, std::string_view text) {
  std::chrono::nanoseconds time{};
  try {
    time = parse_duration(text, entry.unit);
  } catch (const InvalidArgument&) {
    refuse_type(entry, text);
  }
  demand_range(entry, static_cast<double>(time.count()) / find_time_unit(entry.unit)->nanoseconds);
  return time;
}

}  // namespace

std::string_view to_string(ValueType type) noexcept {
  for (const auto& [value, word] : kTypes) {
    if (value == type) return word;
  }
  return "unknown";
}

std::optional<ValueType> maybe_value_type(std::string_view word) noexcept {
  for (const auto& [value, known] : kTypes) {
    if (known == word) return value;
  }
  return std::nullopt;
}

std::chrono::nanoseconds parse_duration(std::string_view text, std::string_view default_unit) {
  const auto time = maybe_nanoseconds(text, default_unit);
  if (!time || *time > kLongestNanoseconds) refuse_duration(text);
  return std::chrono::nanoseconds(std::llround(*time));
}

double parse_seconds(std::string_view text) {
  const auto time = maybe_nanoseconds(text, "s");
  if (!time) refuse_duration(text);
  return std::min(*time, kLongestNanoseconds) / 1e9;
}

Value parse_value(const DictionaryEntry& entry, std::string_view text) {
  text = trimmed(text);
  switch (entry.type) {
    case ValueType::Integer: {
      const auto number = maybe_number<std::int64_t>(text);
      if (!number) refuse_type(entry, text);
      demand_range(entry, static_cast<double>(*number));
      return *number;
    }
    case ValueType::Real: {
      const auto number = maybe_finite(text);
      if (!number) refuse_type(entry, text);
      demand_range(entry, *number);
      return *number;
    }
    case ValueType::Boolean:
      if (text != "true" && text != "false") refuse_type(entry, text);
      return text == "true";
    case ValueType::Duration:
      return parse_time(entry, text);
    case ValueType::Text:
    case ValueType::Service:
      break;
  }
  return std::string(text);
}

Dictionary::Dictionary(std::vector<DictionaryEntry> entries) : entries_(std::move(entries)) {
  for (std::size_t i = 0; i < entries_.size(); ++i) {
    index_.emplace(std::pair(entries_[i].kind, entries_[i].name), i);
  }
}

const DictionaryEntry* Dictionary::find(EntryKind kind, std::string_view name) const {
  const auto found = index_.find(std::pair(kind, std::string(name)));
  return found == index_.end() ? nullptr : &entries_[found->second];
}

std::string Dictionary::suggestion(EntryKind kind, std::string_view unknown_name) const {
  std::vector<std::string_view> names;
  for (const auto& entry : entries_) {
    if (entry.kind == kind) names.push_back(entry.name);
  }
  return remedy_for(unknown_name, names) + " (or add it to the dictionary)";
}

}  // namespace skein::profile
