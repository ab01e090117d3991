#include "mission/component/component_xml.hpp"

#include <pugixml.hpp>
#include <sstream>

#include "component_reader.hpp"
#include "core/system/interface_name.hpp"
#include "mission/xml/notation.hpp"
#include "mission/xml/text_file.hpp"
#include "mission/xml/words.hpp"
#include "mission/xml/xml_element.hpp"

namespace skein::profile {
namespace {

/// The canonical name in the text of an element; a finding and nothing if it is none.
std::optional<std::string> interface_in(const XmlElement& element) {
  const std::string& text = element.text();
  if (is_interface_name(text)) return canonical_interface_name(text);
  element.findings().error(element.where(),
                           "<" + std::string(element.name()) + "> holds " +
                               (text.empty() ? "nothing" : in_quotes(text)) +
                               " instead of an interface",
                           "write a name like IDL:AE_navigator/IPlanner");
  return std::nullopt;
}

Parameter read_parameter(const XmlElement& element) {
  Parameter parameter{element.attribute("name").value, "", element.where()};
  const auto type = element.maybe_child("type");
  if (!type) return parameter;
  if (maybe_value_type(type->text())) {
    parameter.type = type->text();
  } else if (const auto interface = interface_in(*type)) {
    parameter.type = *interface;
  }
  return parameter;
}

/// Of a component, or of an interface that it implements.
std::vector<Parameter> read_parameters(const XmlElement& owner, std::string_view group_name) {
  std::vector<Parameter> parameters;
  const auto group = owner.maybe_child(group_name);
  if (!group) return parameters;
  for (const auto& child : group->children("parameter")) {
    parameters.push_back(read_parameter(child));
  }
  return parameters;
}

std::optional<ImplementedInterface> read_implements(const XmlElement& element) {
  ImplementedInterface implemented;
  implemented.where = element.where();
  implemented.required = read_parameters(element, "required");
  implemented.optional = read_parameters(element, "optional");
  for (const auto& child : element.children("attribute")) {
    implemented.attributes.push_back(
        {child.attribute("name").value, child.attribute("value").value, child.where()});
  }
  const auto type = element.maybe_child("type");
  if (type && !element.text().empty()) {
    element.findings().error(element.where(), "<implements> names an interface twice",
                             "keep either the text or <type>");
  }
  const auto name = interface_in(type ? *type : element);
  if (!name) return std::nullopt;
  implemented.type = *name;
  return implemented;
}

std::vector<InterfaceReference> read_references(const XmlElement& component,
                                                std::string_view group_name,
                                                std::string_view item_name) {
  std::vector<InterfaceReference> references;
  const auto group = component.maybe_child(group_name);
  if (!group) return references;
  for (const auto& item : group->children(item_name)) {
    if (const auto name = interface_in(item)) references.push_back({*name, item.where()});
  }
  return references;
}

}  // namespace

ComponentDescription read_component(const XmlNode& node, FindingList& findings) {
  const XmlElement root(node, findings);
  ComponentDescription component;
  component.where = root.where();
  if (root.name() != component_notation().name) {
    findings.error(root.where(), "<" + shortened(root.name()) + "> is no component description",
                   "its outermost element is <component name=\"...\">");
    return component;
  }
  demand_notation(node, component_notation(), findings);
  component.name = root.attribute("name").value;
  if (const auto interfaces = root.maybe_child("interfaces")) {
    for (const auto& child : interfaces->children("implements")) {
      if (auto implemented = read_implements(child)) {
        component.interfaces.push_back(*std::move(implemented));
      }
    }
    component.complete = component.interfaces.size() == interfaces->children().size();
  }
  component.required = read_parameters(root, "required");
  component.optional = read_parameters(root, "optional");
  component.dependencies = read_references(root, "dependencies", "depends");
  component.subcomponents = read_references(root, "subcomponents", "subcomponent");
  return component;
}

ComponentDescription parse_component(std::string_view xml, const std::string& file) {
  FindingList findings;
  auto component = read_component(parse_xml(xml, file, findings), findings);
  findings.throw_if_errors();
  return component;
}

ComponentDescription read_component(const std::filesystem::path& file) {
  return parse_component(read_text_file(file), file.string());
}

namespace {

/// The paper writes interfaces as repository ids.
std::string repository_id(const std::string& interface) { return "IDL:" + interface; }

void add_text_child(pugi::xml_node parent, const char* name, const std::string& text) {
  parent.append_child(name).append_child(pugi::node_pcdata).set_value(text.c_str());
}

void write_parameters(pugi::xml_node owner, const char* group_name,
                      const std::vector<Parameter>& parameters) {
  if (parameters.empty()) return;
  auto group = owner.append_child(group_name);
  for (const auto& parameter : parameters) {
    auto node = group.append_child("parameter");
    node.append_attribute("name") = parameter.name.c_str();
    if (parameter.type.empty()) continue;
    add_text_child(
        node, "type",
        maybe_value_type(parameter.type) ? parameter.type : repository_id(parameter.type));
  }
}

void write_implements(pugi::xml_node interfaces, const ImplementedInterface& implemented) {
  const bool bare = implemented.required.empty() && implemented.optional.empty() &&
                    implemented.attributes.empty();
  if (bare) return add_text_child(interfaces, "implements", repository_id(implemented.type));
  auto node = interfaces.append_child("implements");
  add_text_child(node, "type", repository_id(implemented.type));
  write_parameters(node, "required", implemented.required);
  write_parameters(node, "optional", implemented.optional);
  for (const auto& attribute : implemented.attributes) {
    auto child = node.append_child("attribute");
    child.append_attribute("name") = attribute.name.c_str();
    child.append_attribute("value") = attribute.value.c_str();
  }
}

void write_references(pugi::xml_node component, const char* group_name, const char* item_name,
                      const std::vector<InterfaceReference>& references) {
  if (references.empty()) return;
  auto group = component.append_child(group_name);
  for (const auto& reference : references) {
    add_text_child(group, item_name, repository_id(reference.type));
  }
}

}  // namespace

std::string write_component(const ComponentDescription& component) {
  pugi::xml_document document;
  auto root = document.append_child("component");
  root.append_attribute("name") = component.name.c_str();
  if (!component.interfaces.empty()) {
    auto interfaces = root.append_child("interfaces");
    for (const auto& implemented : component.interfaces) write_implements(interfaces, implemented);
  }
  write_parameters(root, "required", component.required);
  write_parameters(root, "optional", component.optional);
  write_references(root, "dependencies", "depends", component.dependencies);
  write_references(root, "subcomponents", "subcomponent", component.subcomponents);
  std::ostringstream text;
  document.save(text, "  ", pugi::format_indent | pugi::format_no_declaration, pugi::encoding_utf8);
  return text.str();
}

}  // namespace skein::profile
