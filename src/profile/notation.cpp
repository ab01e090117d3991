#include "notation.hpp"

#include <algorithm>
#include <array>
#include <set>

#include "head_reader.hpp"
#include "rules_reader.hpp"
#include "thread_rules_reader.hpp"
#include "topic_rules_reader.hpp"
#include "words.hpp"

namespace skein::profile {
namespace {

using Names = std::vector<std::string_view>;

/// An element's attributes: its own, and those of the readers that it is handed to.
template <class... Lists>
Names joined(const Lists&... lists) {
  Names names;
  (names.insert(names.end(), lists.begin(), lists.end()), ...);
  return names;
}

Notation leaf(std::string_view name, Names attributes) {
  return {name, std::move(attributes), {}, false};
}

Notation text(std::string_view name) { return {name, {}, {}, true}; }

Notation variable() { return leaf("variable", {"name", "default"}); }
Notation parameter() { return leaf("parameter", {"name", "value"}); }
Notation environment() { return leaf("environment", {"name", "value"}); }
Notation argument() { return leaf("argument", {"value"}); }
Notation topic() { return leaf("topic", joined(Names{"name"}, kTopicAttributes)); }

Notation csp() {
  return {"csp",
          joined(Names{"name", "component", "process", "vendor", "shared_memory",
                       "shared_memory_calls", "plugin", "process_cpus"},
                 kProcessAttributes, kThreadAttributes),
          {parameter(), environment(), argument()}};
}

Notation peer() {
  return {"peer",
          joined(Names{"name", "count", "role"}, group_defaults()),
          {csp(), parameter(), environment(), argument(), topic(), include_notation()}};
}

Notation group() {
  return {"group",
          joined(Names{"name"}, group_defaults()),
          {peer(), environment(), topic(), include_notation()}};
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

const std::vector<std::string_view>& mission_defaults() {
  static const Names kNames{"vendor", "system",    "host",   "interface",
                            "peers",  "multicast", "plugin", "allowed_sources"};
  return kNames;
}

const std::vector<std::string_view>& group_defaults() {
  static const Names kNames =
      joined(Names{"component", "program", "ready"}, mission_defaults(),
             Names{"shared_memory", "shared_memory_calls", "process_cpus"}, kProcessAttributes,
             kThreadCountAttributes, kThreadAttributes, kHeadAttributes);
  return kNames;
}

const Notation& include_notation() {
  static const Notation kInclude = leaf("include", {"file"});
  return kInclude;
}

const Notation& mission_notation() {
  static const Notation kMission{
      "mission",
      joined(Names{"name", "domain", "dictionary", "logs"}, mission_defaults()),
      {peer(), group(), variable(), environment(), topic(), include_notation()}};
  return kMission;
}

const Notation& part_notation() {
  static const Notation kPart{"part",
                              {},
                              {peer(), group(), csp(), variable(), parameter(), environment(),
                               argument(), topic(), include_notation()}};
  return kPart;
}

const Notation& component_notation() {
  static const std::vector<Notation> kParameters{{"parameter", {"name"}, {text("type")}}};
  static const Notation kComponent{"component",
                                   {"name"},
                                   {{"interfaces",
                                     {},
                                     {{"implements",
                                       {},
                                       {text("type"),
                                        {"required", {}, kParameters},
                                        {"optional", {}, kParameters},
                                        leaf("attribute", {"name", "value"})},
                                       true}}},
                                    {"required", {}, kParameters},
                                    {"optional", {}, kParameters},
                                    {"dependencies", {}, {text("depends")}},
                                    {"subcomponents", {}, {text("subcomponent")}}}};
  return kComponent;
}

const Notation& dictionary_notation() {
  static const Names kEntry{"name", "type", "unit", "min", "max", "interface"};
  static const Notation kDictionary{
      "dictionary", {}, {{"attribute", kEntry, {}, true}, {"parameter", kEntry, {}, true}}};
  return kDictionary;
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
