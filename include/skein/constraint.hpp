#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "skein/detail/version.hpp"

namespace skein::discovery {
struct ServiceDescription;
}

namespace skein::brokerless_discovery {

enum class Relation { Equal, NotEqual, AtMost, AtLeast };

/// A condition on an attribute that providers declare: `{"latency", Relation::AtMost, "300"}`.
///
/// Numbers compare as numbers. A plain number is in the unit that the dictionary gives the
/// attribute; a duration has one of the units ns, us, ms, s, min, h. Everything else, also a plain
/// number with a duration, compares as text, for equality alone. A provider that does not declare
/// the attribute does not meet the constraint.
struct Constraint {
  std::string attribute;
  Relation relation = Relation::Equal;
  std::string value;
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
