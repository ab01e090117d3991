#include "skein/constraint.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <utility>

#include "skein/discovery.idl.hpp"
#include "skein/error.hpp"

namespace skein::brokerless_discovery {
namespace {

using discovery::ServiceDescription;

constexpr std::array<std::pair<std::string_view, double>, 6> kTimeUnits{
    {{"ns", 1e-9}, {"us", 1e-6}, {"ms", 1e-3}, {"s", 1}, {"min", 60}, {"h", 3600}}};

bool is_order(Relation relation) {
  return relation == Relation::AtMost || relation == Relation::AtLeast;
}

const char* words_of(Relation relation) {
  switch (relation) {
    case Relation::Equal:
      return "";
    case Relation::NotEqual:
      return "anything but ";
    case Relation::AtMost:
      return "at most ";
    case Relation::AtLeast:
      break;
  }
  return "at least ";
}

}  // namespace

Quantity quantity_of(std::string_view text) {
  double value = 0;
  const char* const end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, value);
  if (error != std::errc() || std::isnan(value)) return {};
  std::string_view unit(stop, static_cast<std::size_t>(end - stop));
  if (unit.empty()) return {Quantity::Kind::Number, value};
  unit.remove_prefix(std::min(unit.find_first_not_of(' '), unit.size()));
  const auto* const known = std::find_if(kTimeUnits.begin(), kTimeUnits.end(),
                                         [&](const auto& entry) { return entry.first == unit; });
  if (known == kTimeUnits.end()) return {};
  return {Quantity::Kind::Time, value * known->second};
}

std::string text_of(double number) {
  std::array<char, 32> text{};
  return {text.data(), std::to_chars(text.data(), text.data() + text.size(), number).ptr};
}

void check(const Constraint& constraint) {
  if (!is_order(constraint.relation) ||
      quantity_of(constraint.value).kind != Quantity::Kind::Text) {
    return;
  }
  throw InvalidArgument("the constraint '" + constraint.attribute + "' " +
                        words_of(constraint.relation) + "'" + constraint.value +
                        "' asks for an order, and '" + constraint.value +
                        "' is no number; write a number, or a length of time such as '100 ms'");
}

bool meets(const ServiceDescription& provider, const Constraint& constraint) {
  const std::string* const declared = find_attribute(provider, constraint.attribute);
  if (!declared) return false;
  const Quantity have = quantity_of(*declared);
  const Quantity want = quantity_of(constraint.value);
  const bool numbers = have.kind == want.kind && have.kind != Quantity::Kind::Text;
  switch (constraint.relation) {
    case Relation::Equal:
      return numbers ? have.value == want.value : *declared == constraint.value;
    case Relation::NotEqual:
      return numbers ? have.value != want.value : *declared != constraint.value;
    case Relation::AtMost:
      return numbers && have.value <= want.value;
    case Relation::AtLeast:
      break;
  }
  return numbers && have.value >= want.value;
}

std::string shortfall(const ServiceDescription& provider, const Constraint& constraint) {
  const std::string wanted = words_of(constraint.relation) + constraint.value;
  const std::string* const declared = find_attribute(provider, constraint.attribute);
  if (!declared) return "it declares no " + constraint.attribute + ", which must be " + wanted;
  return "its " + constraint.attribute + " is " + *declared + ", not " + wanted;
}

const std::string* find_attribute(const ServiceDescription& provider, std::string_view name) {
  for (const auto& attribute : provider.attributes) {
    if (attribute.name == name) return &attribute.value;
  }
  return nullptr;
}

std::optional<double> number_attribute(const ServiceDescription& provider, std::string_view name) {
  const std::string* const declared = find_attribute(provider, name);
  if (!declared) return std::nullopt;
  const Quantity quantity = quantity_of(*declared);
  return quantity.kind == Quantity::Kind::Number ? std::optional(quantity.value) : std::nullopt;
}

}  // namespace skein::brokerless_discovery
