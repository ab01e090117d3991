#include "mission/component/dictionary.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "core/suggestion.hpp"
#include "dds/port/vendor_names.hpp"
#include "mission/xml/words.hpp"

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
// A clock counts 292 years: there is room for multiples, and for the time that it has.
constexpr double kLongestNanoseconds = 50.0 * 365.25 * 24 * 3600e9;

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

struct NumberWithUnit {
  std::optional<double> number;
  std::string_view unit;
};

NumberWithUnit split(std::string_view text) {
  const std::string_view whole = trimmed(text);
  const auto number_end = whole.find_last_of("0123456789.") + 1;
  return {maybe_finite(whole.substr(0, number_end)), trimmed(whole.substr(number_end))};
}

/// Nothing for a text that is no length of time; may be longer than any clock counts.
std::optional<double> maybe_nanoseconds(std::string_view text, std::string_view default_unit) {
  const auto [number, unit_name] = split(text);
  const auto* unit = find_time_unit(unit_name.empty() ? default_unit : unit_name);
  if (!number || unit == nullptr || std::signbit(*number)) return std::nullopt;
  return *number * unit->nanoseconds;
}

/// Units of numbers that are converted, if the dictionary has another one of the same quantity.
struct Unit {
  std::string_view name;
  enum class Quantity { Length, Speed, Angle, Mass, Frequency } quantity;
  double factor;
};
constexpr std::array<Unit, 17> kUnits{{
    {"mm", Unit::Quantity::Length, 1e-3},
    {"cm", Unit::Quantity::Length, 1e-2},
    {"m", Unit::Quantity::Length, 1},
    {"km", Unit::Quantity::Length, 1e3},
    {"ft", Unit::Quantity::Length, 0.3048},
    {"m/s", Unit::Quantity::Speed, 1},
    {"km/h", Unit::Quantity::Speed, 1 / 3.6},
    {"kn", Unit::Quantity::Speed, 1852.0 / 3600},
    {"deg", Unit::Quantity::Angle, std::numbers::pi / 180},
    {"rad", Unit::Quantity::Angle, 1},
    {"g", Unit::Quantity::Mass, 1e-3},
    {"kg", Unit::Quantity::Mass, 1},
    {"t", Unit::Quantity::Mass, 1e3},
    {"Hz", Unit::Quantity::Frequency, 1},
    {"kHz", Unit::Quantity::Frequency, 1e3},
    {"MHz", Unit::Quantity::Frequency, 1e6},
    {"GHz", Unit::Quantity::Frequency, 1e9},
}};

/// The factor from a number in unit `from` to one in unit `to`.
std::optional<double> conversion(std::string_view from, std::string_view to) {
  const auto* of = std::ranges::find(kUnits, from, &Unit::name);
  const auto* wanted = std::ranges::find(kUnits, to, &Unit::name);
  if (of == kUnits.end() || wanted == kUnits.end() || of->quantity != wanted->quantity)
    return std::nullopt;
  return of->factor / wanted->factor;
}

/// What to write in place of a number without a unit; empty for any other text.
std::string missing_unit(std::string_view text) {
  const std::string number(trimmed(text));
  const auto value = maybe_finite(number);
  if (!value || std::signbit(*value)) return "";
  return "has no unit of time; write " + in_quotes(number + " ms") + " or " +
         in_quotes(number + " s") + ", whichever it is (ns, us, ms, s, min, h)";
}

[[noreturn]] void refuse_duration(std::string_view text) {
  if (const auto missing = missing_unit(text); !missing.empty())
    throw InvalidArgument(in_quotes(text) + " " + missing);
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

/// The names of a quantity's units.
std::string unit_list(Unit::Quantity quantity) {
  std::vector<std::string> names;
  for (const Unit& unit : kUnits)
    if (unit.quantity == quantity) names.emplace_back(unit.name);
  return dds::alternatives(names);
}

/// What to write instead of a number with a unit that does not fit.
std::string remedy_for_unit(const DictionaryEntry& entry) {
  if (entry.unit.empty()) return ": the dictionary gives it no unit; write the number alone";
  if (entry.type == ValueType::Integer) return ": write the number alone, or in " + entry.unit;
  const auto* unit = std::ranges::find(kUnits, std::string_view(entry.unit), &Unit::name);
  if (unit != kUnits.end()) return ": write a number in " + unit_list(unit->quantity);
  return {};
}

/// What to write instead; empty where that is not to be seen.
std::string remedy_for_number(const DictionaryEntry& entry, std::string_view text) {
  if (entry.type != ValueType::Real && entry.type != ValueType::Integer) return {};
  std::string with_point(text);
  const auto comma = with_point.find(',');
  if (entry.type == ValueType::Real && comma != std::string::npos) {
    with_point[comma] = '.';
    if (split(with_point).number) return ": write " + in_quotes(with_point) + ", with a point";
  }
  const auto [number, unit] = split(text);
  return number && !unit.empty() ? remedy_for_unit(entry) : "";
}

/// A value in a unit that is known, if the dictionary has one that nothing is converted into.
bool is_of_unknown_unit(const DictionaryEntry& entry, std::string_view text) {
  const auto known = [](std::string_view name) {
    return std::ranges::any_of(kUnits, [&](const Unit& unit) { return unit.name == name; });
  };
  const auto [number, unit] = split(text);
  return entry.type == ValueType::Real && number && known(unit) && !entry.unit.empty() &&
         !known(entry.unit);
}

[[noreturn]] void refuse_unit(const DictionaryEntry& entry, std::string_view text) {
  std::vector<std::string> names;
  for (const Unit& unit : kUnits) names.emplace_back(unit.name);
  throw UnknownUnit(in_quotes(entry.name) + " has the unit " + in_quotes(entry.unit) +
                    ", into which " + in_quotes(text) + " is not converted" +
                    skein::suggestion(entry.unit, names));
}

[[noreturn]] void refuse_type(const DictionaryEntry& entry, std::string_view text) {
  if (is_of_unknown_unit(entry, text)) refuse_unit(entry, text);
  std::string problem = in_quotes(entry.name) + " is " + in_quotes(text) + ", which is no " +
                        std::string(to_string(entry.type));
  if (!entry.unit.empty()) problem += " in " + entry.unit;
  throw InvalidArgument(problem + remedy_for_number(entry, text));
}

/// An integer that no number of this program can hold.
[[noreturn]] void refuse_size(const DictionaryEntry& entry, std::string_view text) {
  using Limits = std::numeric_limits<std::int64_t>;
  const bool low = text.starts_with('-');
  const auto& limit = low ? entry.minimum : entry.maximum;
  throw InvalidArgument(in_quotes(entry.name) + " is " + shortened(text) +
                        (low ? ", less than " : ", more than ") +
                        (limit ? with_unit(*limit, entry.unit)
                               : std::to_string(low ? Limits::min() : Limits::max())));
}

void demand_range(const DictionaryEntry& entry, double number) {
  const bool low = entry.minimum && number < *entry.minimum;
  const bool high = entry.maximum && number > *entry.maximum;
  if (!low && !high) return;
  throw InvalidArgument(in_quotes(entry.name) + " is " + with_unit(number, entry.unit) + ", " +
                        (low ? "less than " + with_unit(*entry.minimum, entry.unit)
                             : "more than " + with_unit(*entry.maximum, entry.unit)));
}

/// Without the entry's own unit, which may hold digits.
std::string_view without_unit(const DictionaryEntry& entry, std::string_view text) {
  return text.ends_with(entry.unit) ? trimmed(text.substr(0, text.size() - entry.unit.size()))
                                    : text;
}

double parse_real(const DictionaryEntry& entry, std::string_view text) {
  auto number = maybe_finite(without_unit(entry, text));
  if (!number) {
    const auto [of_other_unit, unit] = split(text);
    const auto factor = conversion(unit, entry.unit);
    if (!of_other_unit || !factor) refuse_type(entry, text);
    number = *of_other_unit * *factor;
  }
  demand_range(entry, *number);
  return *number;
}

std::int64_t parse_integer(const DictionaryEntry& entry, std::string_view text) {
  const std::string_view digits = without_unit(entry, text);
  std::int64_t number = 0;
  const char* const end = digits.data() + digits.size();
  const auto [stop, error] = std::from_chars(digits.data(), end, number);
  if (digits.empty() || stop != end || error == std::errc::invalid_argument)
    refuse_type(entry, text);
  if (error != std::errc()) refuse_size(entry, text);
  demand_range(entry, static_cast<double>(number));
  return number;
}

std::chrono::nanoseconds parse_time(const DictionaryEntry& entry, std::string_view text) {
  const auto nanoseconds = maybe_nanoseconds(text, "");
  if (const auto missing = missing_unit(text); !missing.empty()) {
    throw InvalidArgument(in_quotes(entry.name) + " is " + in_quotes(text) + ", which " + missing);
  }
  if (!nanoseconds || *nanoseconds > kLongestNanoseconds) refuse_type(entry, text);
  const std::chrono::nanoseconds time(std::llround(*nanoseconds));
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

std::chrono::nanoseconds parse_duration(std::string_view text) {
  const auto time = maybe_nanoseconds(text, "");
  if (!time || *time > kLongestNanoseconds) refuse_duration(text);
  return std::chrono::nanoseconds(std::llround(*time));
}

double parse_seconds(std::string_view text) {
  const auto time = maybe_nanoseconds(text, "s");
  if (!time) refuse_duration(text);
  return std::min(*time, kLongestNanoseconds) / 1e9;
}

ParameterValue parse_value(const DictionaryEntry& entry, std::string_view text) {
  text = trimmed(text);
  switch (entry.type) {
    case ValueType::Integer:
      return parse_integer(entry, text);
    case ValueType::Real:
      return parse_real(entry, text);
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

std::string plain_text(const DictionaryEntry& entry, std::string_view text) {
  const ParameterValue value = parse_value(entry, text);
  if (const auto* number = std::get_if<double>(&value)) return number_text(*number);
  if (const auto* number = std::get_if<std::int64_t>(&value)) return std::to_string(*number);
  const auto* time = std::get_if<std::chrono::nanoseconds>(&value);
  if (time) {
    return number_text(static_cast<double>(time->count()) /
                       find_time_unit(entry.unit)->nanoseconds);
  }
  return std::string(trimmed(text));
}

Dictionary::Dictionary(std::vector<DictionaryEntry> entries) : entries_(std::move(entries)) {
  for (std::size_t i = 0; i < entries_.size(); ++i) {
    index_.emplace(std::pair(entries_[i].kind, entries_[i].name), i);
  }
}

Dictionary Dictionary::unread() {
  Dictionary dictionary;
  dictionary.read_ = false;
  return dictionary;
}

const DictionaryEntry* Dictionary::find(EntryKind kind, std::string_view name) const {
  const auto found = index_.find(std::pair(kind, std::string(name)));
  return found == index_.end() ? nullptr : &entries_[found->second];
}

std::string Dictionary::suggestion(EntryKind kind, std::string_view unknown_name) const {
  const bool attribute = kind == EntryKind::Attribute;
  const auto* other = find(attribute ? EntryKind::Parameter : EntryKind::Attribute, unknown_name);
  if (other != nullptr) {
    return "the dictionary has it as " + std::string(attribute ? "a parameter" : "an attribute") +
           " (" + to_text(other->where) + "); define it as <" +
           (attribute ? "attribute" : "parameter") + "> there";
  }
  if (entries_.empty())
    return "define it in the dictionary, which is dictionary.xml beside the profile, or the file "
           "that its attribute dictionary names";
  std::vector<std::string_view> names;
  for (const auto& entry : entries_) {
    if (entry.kind == kind) names.push_back(entry.name);
  }
  return remedy_for(unknown_name, names) + " (or add it to the dictionary)";
}

}  // namespace skein::profile
