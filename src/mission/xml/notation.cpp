#include "notation.hpp"

#include <algorithm>
#include <map>
#include <pugixml.hpp>
#include <set>
#include <string>

#include "skein/error.hpp"
#include "words.hpp"

namespace skein::profile {

// The files of mission_profiles/schema; schemas.cpp.in.
extern const char* const kMissionSchema;
extern const char* const kComponentSchema;
extern const char* const kDictionarySchema;

namespace {

/// As much of an XML schema as notations are made of.
class Schema {
 public:
  explicit Schema(const char* text) {
    const pugi::xml_parse_result parsed = document_.load_string(text);
    if (!parsed) throw Internal(std::string("a schema of profiles: ") + parsed.description());
  }

  /// Of an element at its top. Refers to this object.
  Notation element(const char* name) const { return notation_of(named("xs:element", name)); }

  Names group(const char* name) const { return attributes_of(named("xs:attributeGroup", name)); }

 private:
  pugi::xml_node named(const char* kind, const char* name) const {
    for (const auto& node : document_.document_element().children(kind))
      if (node.attribute("name").value() == std::string_view(name)) return node;
    return {};
  }

  Notation notation_of(const pugi::xml_node& element) const {
    auto type = element.child("xs:complexType");
    if (!type) type = named("xs:complexType", element.attribute("type").value());
    const auto extension = type.child("xs:simpleContent").child("xs:extension");
    Notation notation{element.attribute("name").value(),
                      attributes_of(extension ? extension : type),
                      {},
                      !type || extension || type.attribute("mixed").as_bool()};
    for (const char* group : {"xs:choice", "xs:all"}) {
      for (const auto& child : type.child(group).children("xs:element"))
        notation.children.push_back(notation_of(child));
    }
    return notation;
  }

  Names attributes_of(const pugi::xml_node& type) const {
    Names names;
    for (const auto& node : type.children()) {
      if (node.name() == std::string_view("xs:attribute"))
        names.push_back(node.attribute("name").value());
      if (node.name() != std::string_view("xs:attributeGroup")) continue;
      const Names group = attributes_of(named(node.name(), node.attribute("ref").value()));
      names.insert(names.end(), group.begin(), group.end());
    }
    return names;
  }

  pugi::xml_document document_;
};

const Schema& schema_of_missions() {
  static const Schema kSchema(kMissionSchema);
  return kSchema;
}

void demand_attributes(const XmlNode& node, const Notation& notation, FindingList& findings) {
  std::set<std::string_view> seen;
  for (const auto& attribute : node.attributes) {
    if (findings.full()) return;
    if (!seen.insert(attribute.name).second) {
      findings.error(attribute.where, in_quotes(attribute.name) + " is given twice", "keep one");
    } else if (std::find(notation.attributes.begin(), notation.attributes.end(), attribute.name) ==
               notation.attributes.end()) {
      findings.error(attribute.where,
                     "<" + shortened(node.name) + "> has no " + in_quotes(attribute.name),
                     remedy_for(attribute.name, notation.attributes));
    }
  }
}

void refuse_child(const XmlNode& child, const Notation& around, FindingList& findings) {
  Names names;
  for (const auto& known : around.children) names.push_back(known.name);
  findings.error(child.where,
                 "<" + shortened(child.name) + "> is unknown in <" + std::string(around.name) + ">",
                 names.empty() ? "nothing stands in it" : remedy_for(child.name, names));
}

}  // namespace

const Notation* Notation::find_child(std::string_view child_name) const {
  const auto found = std::find_if(children.begin(), children.end(),
                                  [&](const Notation& child) { return child.name == child_name; });
  return found == children.end() ? nullptr : &*found;
}

std::string_view mission_schema() { return kMissionSchema; }

const Notation& mission_notation() {
  static const Notation kMission = schema_of_missions().element("mission");
  return kMission;
}

const Notation& part_notation() {
  static const Notation kPart = schema_of_missions().element("part");
  return kPart;
}

const Notation& component_notation() {
  static const Schema kSchema(kComponentSchema);
  static const Notation kComponent = kSchema.element("component");
  return kComponent;
}

const Notation& dictionary_notation() {
  static const Schema kSchema(kDictionarySchema);
  static const Notation kDictionary = kSchema.element("dictionary");
  return kDictionary;
}

const Names& attribute_group(const char* name) {
  static const std::map<std::string_view, Names> kGroups = [] {
    std::map<std::string_view, Names> groups;
    for (const char* group :
         {kMissionDefaults, kGroupDefaults, kProcessAttributes, kThreadAttributes, kHeadAttributes})
      groups.emplace(group, schema_of_missions().group(group));
    return groups;
  }();
  return kGroups.at(name);
}

void demand_notation(const XmlNode& node, const Notation& notation, FindingList& findings) {
  demand_attributes(node, notation, findings);
  for (const auto& child : node.children) {
    if (const auto* known = notation.find_child(child.name)) {
      demand_notation(child, *known, findings);
    } else {
      refuse_child(child, notation, findings);
    }
  }
  if (notation.text || node.text.empty()) return;
  findings.error(node.where,
                 "<" + shortened(node.name) + "> holds the text " + in_quotes(node.text),
                 "it holds elements only");
}

}  // namespace skein::profile
