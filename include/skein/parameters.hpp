#pragma once

#include <chrono>
#include <cstdint>
#include <initializer_list>
#include <map>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

#include "skein/detail/version.hpp"

namespace skein {

/// The value of a parameter. The mission's dictionary says which of these it is: an `integer`, a
/// `real`, a `boolean`, a `duration`; a `text` or a `service` is a string. Numbers are in the
/// dictionary's unit.
using ParameterValue =
    std::variant<std::int64_t, double, bool, std::chrono::nanoseconds, std::string>;

/// Values by parameter name, as a component gets them: typed, converted and checked.
class ParameterValues {
 public:
  ParameterValues() = default;
  ParameterValues(std::initializer_list<std::pair<const std::string, ParameterValue>> values)
      : values_(values) {}

  void set(const std::string& name, ParameterValue value) {
    values_.insert_or_assign(name, std::move(value));
  }
  bool contains(const std::string& name) const { return values_.contains(name); }

  /// The value, or nothing if the parameter has none. T is an integer type, double, bool, a
  /// duration of std::chrono (finer fractions are cut off), or std::string. Throws InvalidArgument
  /// for a value of another type, or one that does not fit into T; an integer is a double, too.
  template <class T>
  std::optional<T> find(const std::string& name) const;

  /// As find(), but throws InvalidArgument if the parameter has no value: for one that the
  /// component's description requires.
  template <class T>
  T get(const std::string& name) const {
    if (auto value = find<T>(name)) return *std::move(value);
    throw_missing(name);
  }

  const std::map<std::string, ParameterValue>& all() const noexcept { return values_; }

  bool operator==(const ParameterValues&) const = default;

 private:
  const ParameterValue* find_value(const std::string& name) const;
  [[noreturn]] void throw_missing(const std::string& name) const;
  [[noreturn]] static void throw_other_type(const std::string& name, const ParameterValue& value,
                                            const char* wanted);

  std::map<std::string, ParameterValue> values_;
};

template <class T>
std::optional<T> ParameterValues::find(const std::string& name) const {
  const ParameterValue* const value = find_value(name);
  if (!value) return std::nullopt;
  if constexpr (std::is_same_v<T, bool>) {
    if (const auto* flag = std::get_if<bool>(value)) return *flag;
    throw_other_type(name, *value, "a boolean");
  } else if constexpr (std::is_integral_v<T>) {
    const auto* number = std::get_if<std::int64_t>(value);
    if (number && std::in_range<T>(*number)) return static_cast<T>(*number);
    throw_other_type(name, *value, number ? "an integer of that size" : "an integer");
  } else if constexpr (std::is_floating_point_v<T>) {
    if (const auto* number = std::get_if<double>(value)) return static_cast<T>(*number);
    if (const auto* number = std::get_if<std::int64_t>(value)) return static_cast<T>(*number);
    throw_other_type(name, *value, "a number");
  } else if constexpr (std::is_same_v<T, std::string>) {
    if (const auto* text = std::get_if<std::string>(value)) return *text;
    throw_other_type(name, *value, "a text");
  } else {
    static_assert(std::is_convertible_v<std::chrono::hours, T>,
                  "a parameter is an integer, double, bool, duration of std::chrono, or string");
    if (const auto* time = std::get_if<std::chrono::nanoseconds>(value))
      return std::chrono::duration_cast<T>(*time);
    throw_other_type(name, *value, "a duration");
  }
}

/// The variable parameters that a service declares (Figure 2 of the paper), and how they get their
/// values.
class ParameterResolver {
 public:
  struct Declared {
    std::string name;
    bool required = false;
  };

  /// `service` is its name in messages.
  ParameterResolver(std::string service, std::vector<Declared> declared)
      : service_(std::move(service)), declared_(std::move(declared)) {}

  /// Takes the value of each declared parameter from the first of `sources` that has one: the
  /// caller's, the profile's, the dependencies', in this order. Optional parameters may stay unset.
  /// Throws InvalidArgument that names each required parameter without a value, or an undeclared
  /// parameter of the caller (the first source) with the nearest declared name.
  ParameterValues resolve(const std::vector<ParameterValues>& sources) const;

 private:
  void refuse_unknown(const ParameterValues& values) const;

  std::string service_;
  std::vector<Declared> declared_;
};

}  // namespace skein
