#pragma once

#include <chrono>
#include <concepts>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>

#include "skein/detail/version.hpp"

namespace skein::discovery {
struct ServiceDescription;
}

namespace skein::brokerless_discovery {

enum class Relation { Equal, NotEqual, AtMost, AtLeast };

std::string text_of(double number);

/// An attribute's value as text. A number becomes its shortest text, a duration one in
/// milliseconds: `"20"`, `20` and `20ms` are `20`, `20` and `20 ms`.
struct AttributeValue : std::string {
  AttributeValue() = default;
  template <std::convertible_to<std::string> Text>
  AttributeValue(Text&& text) : std::string(std::forward<Text>(text)) {}
  template <class Number>
  requires(std::is_arithmetic_v<Number>) AttributeValue(Number number)
      : std::string(text_of(static_cast<double>(number))) {
    static_assert(!std::is_same_v<Number, bool> && !std::is_same_v<Number, char>,
                  "an attribute's value is a text, a number or a duration");
  }
  template <class Rep, class Period>
  AttributeValue(const std::chrono::duration<Rep, Period>& time)
      : std::string(text_of(std::chrono::duration<double, std::milli>(time).count()) + " ms") {}
};

/// A condition on an attribute that providers declare: `{"latency", Relation::AtMost, "300"}`.
///
/// Numbers compare as numbers. A plain number is in the unit that the dictionary gives the
/// attribute; a duration has one of the units ns, us, ms, s, min, h. Everything else, also a plain
/// number with a duration, compares as text, for equality alone. A provider that does not declare
/// the attribute does not meet the constraint.
struct Constraint {
  std::string attribute;
  Relation relation = Relation::Equal;
  AttributeValue value;
};

/// A value as it is compared.
struct Quantity {
  enum class Kind { Number, Time, Text };
  Kind kind = Kind::Text;
  double value = 0;  ///< Of a duration: in seconds.
};
Quantity quantity_of(std::string_view text);

/// Throws InvalidArgument if AtMost or AtLeast is used with a value that is neither a number nor a
/// duration.
void check(const Constraint& constraint);

bool meets(const discovery::ServiceDescription& provider, const Constraint& constraint);

/// Why `provider` does not meet the constraint: `its latency is 500, not at most 300`.
std::string shortfall(const discovery::ServiceDescription& provider, const Constraint& constraint);

/// The declared value, or nullptr.
const std::string* find_attribute(const discovery::ServiceDescription& provider,
                                  std::string_view name);

/// The declared value, if it is a plain number without a unit.
std::optional<double> number_attribute(const discovery::ServiceDescription& provider,
                                       std::string_view name);

}  // namespace skein::brokerless_discovery
