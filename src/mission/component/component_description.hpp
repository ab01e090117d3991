#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "mission/xml/finding.hpp"

namespace skein::profile {

/// A property of a service, such as `latency` = `100`. What the text means is told by the
/// dictionary: its type, unit and range.
struct Attribute {
  std::string name;
  std::string value;
  SourcePosition where;
};

/// A parameter of a component, whose value the profile gives, or of a service, whose value a client
/// or the Body may give, too.
struct Parameter {
  std::string name;
  /// The canonical name of an interface for a service reference, a type word of the dictionary
  /// (`integer`, `duration`, ...), or empty where the description leaves it to the dictionary.
  std::string type;
  SourcePosition where;
};

/// An interface that a component implements, and how to use it.
struct ImplementedInterface {
  std::string type;  ///< Canonical name, see skein::canonical_interface_name().
  std::vector<Parameter> required;
  std::vector<Parameter> optional;
  std::vector<Attribute> attributes;
  SourcePosition where;

  /// The attribute of that name, or null. The pointer lives as long as this object is unchanged.
  const Attribute* find_attribute(std::string_view attribute_name) const;
  /// The required or optional parameter of that name, or null. Lives as long as find_attribute()'s.
  const Parameter* find_parameter(std::string_view parameter_name) const;
};

/// An interface that a component depends on, or that it has as a subcomponent.
struct InterfaceReference {
  std::string type;  ///< Canonical name.
  SourcePosition where;
};

/// What one component says of itself: the only thing that others know of it before they call it.
/// A plain value; component_xml.hpp reads and writes it as XML.
struct ComponentDescription {
  std::string name;
  std::vector<Parameter> required;  ///< Beside those of its interfaces.
  std::vector<Parameter> optional;  ///< The same.
  std::vector<ImplementedInterface> interfaces;
  std::vector<InterfaceReference>
      dependencies;  ///< Services of others without which it cannot work.
  std::vector<InterfaceReference> subcomponents;  ///< Managed interfaces of the CSPs that it hosts.
  SourcePosition where;
  /// False where an interface that it implements stands in it and could not be read.
  bool complete = true;

  /// The implemented interface of that name in any spelling, or null.
  /// Throws InvalidArgument if `interface_name` is no interface name.
  const ImplementedInterface* find_interface(std::string_view interface_name) const;
  /// Its own parameters and those of its interfaces: those that the profile has to give a value, or
  /// all. The pointers live as long as this object is unchanged.
  std::vector<const Parameter*> required_parameters() const;
  std::vector<const Parameter*> parameters() const;
  /// Whether one of the subcomponents is that interface. Throws as find_interface() does.
  bool has_subcomponent(std::string_view interface_name) const;
};

}  // namespace skein::profile
