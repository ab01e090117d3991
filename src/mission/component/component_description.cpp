#include "mission/component/component_description.hpp"

#include <algorithm>

#include "core/system/interface_name.hpp"

namespace skein::profile {
namespace {

template <typename Item>
const Item* find_named(const std::vector<Item>& items, std::string_view name) {
  const auto found =
      std::find_if(items.begin(), items.end(), [&](const Item& item) { return item.name == name; });
  return found == items.end() ? nullptr : &*found;
}

}  // namespace

const Attribute* ImplementedInterface::find_attribute(std::string_view attribute_name) const {
  return find_named(attributes, attribute_name);
}

const Parameter* ImplementedInterface::find_parameter(std::string_view parameter_name) const {
  const auto* found = find_named(required, parameter_name);
  return found != nullptr ? found : find_named(optional, parameter_name);
}

const ImplementedInterface* ComponentDescription::find_interface(
    std::string_view interface_name) const {
  const std::string type = canonical_interface_name(interface_name);
  const auto found =
      std::find_if(interfaces.begin(), interfaces.end(),
                   [&](const ImplementedInterface& item) { return item.type == type; });
  return found == interfaces.end() ? nullptr : &*found;
}

std::vector<const Parameter*> ComponentDescription::required_parameters() const {
  std::vector<const Parameter*> found;
  for (const Parameter& parameter : required) found.push_back(&parameter);
  for (const auto& implemented : interfaces) {
    for (const Parameter& parameter : implemented.required) found.push_back(&parameter);
  }
  return found;
}

std::vector<const Parameter*> ComponentDescription::parameters() const {
  auto found = required_parameters();
  for (const Parameter& parameter : optional) found.push_back(&parameter);
  for (const auto& implemented : interfaces) {
    for (const Parameter& parameter : implemented.optional) found.push_back(&parameter);
  }
  return found;
}

bool ComponentDescription::has_subcomponent(std::string_view interface_name) const {
  const std::string type = canonical_interface_name(interface_name);
  return std::any_of(subcomponents.begin(), subcomponents.end(),
                     [&](const InterfaceReference& item) { return item.type == type; });
}

}  // namespace skein::profile
