#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace skein::discovery {
struct ServiceDescription;
}

namespace skein::brokerless_discovery {

enum class Relation { Equal, NotEqual, AtMost, AtLeast };

/// What a provider's declared attribute must be: `{"latency", Relation::AtMost, "300"}`.
///
/// Numbers compare as numbers: plain ones, which count in the dictionary's unit of the attribute,
/// or lengths of time with one of the units ns, us, ms, s, min, h; one kind does not compare with
/// the other. Everything else compares as text, and has no order. A provider that does not declare
/// the attribute does not meet the constraint.
struct Constraint {
  std::string attribute;
  Relation relation = Relation::Equal;
  std::string value;
};

/// What a value is when it is compared.
struct Quantity {
  enum class Kind { Number, Time, Text };
  Kind kind = Kind::Text;
  double value = 0;  ///< A length of time is in seconds.
};
Quantity quantity_of(std::string_view text);

/// Throws InvalidArgument where an order is asked of what is no number.
void check(const Constraint& constraint);

bool meets(const discovery::ServiceDescription& provider, const Constraint& constraint);

/// Why `provider` does not meet it: `its latency is 500, not at most 300`.
std::string shortfall(const discovery::ServiceDescription& provider, const Constraint& constraint);

/// The declared value, or null.
const std::string* find_attribute(const discovery::ServiceDescription& provider,
                                  std::string_view name);

/// The declared value as a plain number; nothing where it is none.
std::optional<double> number_attribute(const discovery::ServiceDescription& provider,
                                       std::string_view name);

}  // namespace skein::brokerless_discovery
