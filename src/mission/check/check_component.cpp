#include "check_component.hpp"

#include <algorithm>

#include "core/suggestion.hpp"
#include "mission/profile/repeated.hpp"
#include "mission/xml/words.hpp"

namespace skein::profile {
namespace {

std::vector<std::string_view> parameter_names(const ComponentDescription& component) {
  std::vector<std::string_view> names;
  for (const Parameter* parameter : component.parameters()) names.push_back(parameter->name);
  return names;
}

bool is_known(std::string_view name, const std::vector<std::string_view>& known) {
  return std::find(known.begin(), known.end(), name) != known.end();
}

void check_value(const DictionaryEntry& entry, const std::string& value,
                 const SourcePosition& where, FindingList& findings) {
  try {
    parse_value(entry, value);
  } catch (const UnknownUnit& error) {
    findings.error(entry.where, error.what(),
                   "correct it there, or write the value without a unit at " + to_text(where));
  } catch (const InvalidArgument& error) {
    findings.error(where, error.what(), "it is defined at " + to_text(entry.where));
  }
}

void check_attribute(const Attribute& attribute, const Dictionary& dictionary,
                     FindingList& findings) {
  if (attribute.name.empty() || attribute.value.empty()) return;  // a finding of the reader
  if (const auto* entry = dictionary.find(EntryKind::Attribute, attribute.name)) {
    check_value(*entry, attribute.value, attribute.where, findings);
  } else if (dictionary.is_read()) {
    findings.error(attribute.where, "the attribute " + in_quotes(attribute.name) + " is unknown",
                   dictionary.suggestion(EntryKind::Attribute, attribute.name));
  }
}

void refuse_unknown_parameter(const std::string& name, const SourcePosition& where,
                              const Dictionary& dictionary, FindingList& findings) {
  if (!dictionary.is_read()) return;
  findings.error(where, "the parameter " + in_quotes(name) + " is unknown",
                 dictionary.suggestion(EntryKind::Parameter, name));
}

void check_parameter(const Parameter& parameter, const Dictionary& dictionary,
                     FindingList& findings) {
  if (parameter.name.empty()) return;  // a finding of the reader
  const auto* entry = dictionary.find(EntryKind::Parameter, parameter.name);
  if (entry == nullptr) {
    refuse_unknown_parameter(parameter.name, parameter.where, dictionary, findings);
    return;
  }
  if (parameter.type.empty()) return;
  const bool reference = entry->type == ValueType::Service && !maybe_value_type(parameter.type);
  const bool same = reference ? entry->interface.empty() || entry->interface == parameter.type
                              : parameter.type == to_string(entry->type);
  if (same) return;
  const std::string expected =
      entry->interface.empty() ? std::string(to_string(entry->type)) : entry->interface;
  findings.error(parameter.where,
                 "the parameter " + in_quotes(parameter.name) + " is a " + expected + ", not a " +
                     parameter.type,
                 "it is defined at " + to_text(entry->where));
}

/// Whether the component's own parameter of nearly that name is the one that no dictionary has.
bool is_misspelt_in(const ComponentDescription& component, const std::string& name,
                    const Dictionary& dictionary) {
  if (!dictionary.is_read() || dictionary.find(EntryKind::Parameter, name) == nullptr) return false;
  return std::ranges::any_of(component.parameters(), [&](const Parameter* parameter) {
    const std::vector<std::string> one{parameter->name};
    return dictionary.find(EntryKind::Parameter, parameter->name) == nullptr &&
           !suggestion(name, one).empty();
  });
}

/// What a value looks like.
std::string example_of(const DictionaryEntry& entry) {
  if (entry.type == ValueType::Boolean) return "true";
  return entry.unit.empty() ? "..." : "... " + entry.unit;
}

template <class Owner>
void check_parameters(const Owner& owner, const Dictionary& dictionary, FindingList& findings) {
  Repeated parameters("the parameter");
  for (const auto* group : {&owner.required, &owner.optional}) {
    for (const auto& parameter : *group) {
      check_parameter(parameter, dictionary, findings);
      parameters.add(parameter.name, parameter.where, findings);
    }
  }
}

void check_interface(const ImplementedInterface& implemented, const Dictionary& dictionary,
                     FindingList& findings) {
  check_parameters(implemented, dictionary, findings);
  Repeated attributes("the attribute");
  for (const auto& attribute : implemented.attributes) {
    check_attribute(attribute, dictionary, findings);
    attributes.add(attribute.name, attribute.where, findings);
  }
}

}  // namespace

void check_component(const ComponentDescription& component, const Dictionary& dictionary,
                     FindingList& findings) {
  check_parameters(component, dictionary, findings);
  Repeated interfaces("the interface");
  for (const auto& implemented : component.interfaces) {
    check_interface(implemented, dictionary, findings);
    interfaces.add(implemented.type, implemented.where, findings);
  }
  Repeated dependencies("the dependency");
  for (const auto& item : component.dependencies) dependencies.add(item.type, item.where, findings);
  Repeated subcomponents("the subcomponent");
  for (const auto& item : component.subcomponents) {
    subcomponents.add(item.type, item.where, findings);
  }
}

void check_settings(const std::string& owner, const std::vector<Setting>& settings,
                    const SourcePosition& where, const ComponentDescription& component,
                    const Dictionary& dictionary, FindingList& findings) {
  const auto known = parameter_names(component);
  const bool takes_any = known.empty() && component.interfaces.empty();
  Repeated names("the parameter");
  for (const auto& setting : settings) {
    if (setting.name.empty()) continue;  // a finding of the reader
    names.add(setting.name, setting.where, findings);
    if (!takes_any && !is_known(setting.name, known)) {
      if (is_misspelt_in(component, setting.name, dictionary)) continue;  // which is a finding
      findings.error(setting.where,
                     in_quotes(component.name) + " has no parameter " + in_quotes(setting.name),
                     remedy_for(setting.name, known));
    } else if (const auto* entry = dictionary.find(EntryKind::Parameter, setting.name)) {
      if (!setting.value.empty()) check_value(*entry, setting.value, setting.value_where, findings);
    } else if (takes_any) {
      refuse_unknown_parameter(setting.name, setting.where, dictionary, findings);
    }
  }
  for (const Parameter* parameter : component.required_parameters()) {
    const bool given = std::ranges::any_of(
        settings, [&](const Setting& setting) { return setting.name == parameter->name; });
    const auto* entry = dictionary.find(EntryKind::Parameter, parameter->name);
    const bool unknown = entry == nullptr && dictionary.is_read();  // a finding of the component
    if (given || parameter->name.empty() || unknown) continue;
    findings.error(where,
                   in_quotes(owner) + " has no value for the parameter " +
                       in_quotes(parameter->name) + ", which its component requires (" +
                       to_text(parameter->where) + ")",
                   "write <parameter name=" + in_quotes(parameter->name) + " value=\"" +
                       (entry ? example_of(*entry) : "...") + "\"/>");
  }
}

}  // namespace skein::profile
