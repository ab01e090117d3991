#include "dictionary_reader.hpp"

#include <algorithm>

#include "core/system/interface_name.hpp"
#include "mission/xml/notation.hpp"
#include "mission/xml/text_file.hpp"
#include "mission/xml/words.hpp"
#include "mission/xml/xml_element.hpp"

namespace skein::profile {
namespace {

const std::vector<std::string_view> kTypeWords{"integer", "real",     "boolean",
                                               "text",    "duration", "service"};
const std::vector<std::string_view> kUnitsOfTime{"ns", "us", "ms", "s", "min", "h"};

bool is_number(ValueType type) {
  return type == ValueType::Integer || type == ValueType::Real || type == ValueType::Duration;
}

std::optional<double> read_limit(const XmlElement& element, const char* name) {
  const auto limit = element.maybe_attribute(name);
  if (!limit) return std::nullopt;
  DictionaryEntry number;
  number.name = name;
  number.type = ValueType::Real;
  try {
    return std::get<double>(parse_value(number, limit->value));
  } catch (const InvalidArgument& error) {
    element.findings().error(limit->where, error.what(), "write a plain number");
    return std::nullopt;
  }
}

/// False, with a finding, where it has none.
bool read_type(const XmlElement& element, DictionaryEntry& entry) {
  const auto word = element.attribute("type");
  if (word.value.empty()) return false;
  const auto type = maybe_value_type(word.value);
  if (type) {
    entry.type = *type;
    return true;
  }
  const std::string remedy = remedy_for(word.value, kTypeWords);
  const bool of_cpp = word.value == "double" || word.value == "float";
  element.findings().error(word.where, in_quotes(word.value) + " is no type",
                           of_cpp ? "write \"real\"" : remedy);
  return false;
}

void read_unit_and_range(const XmlElement& element, DictionaryEntry& entry) {
  const auto unit = element.maybe_attribute("unit");
  entry.unit = unit ? unit->value : "";
  entry.minimum = read_limit(element, "min");
  entry.maximum = read_limit(element, "max");
  auto& findings = element.findings();
  const bool unknown_unit =
      std::find(kUnitsOfTime.begin(), kUnitsOfTime.end(), entry.unit) == kUnitsOfTime.end();
  if (entry.type == ValueType::Duration && unknown_unit) {
    findings.error(unit ? unit->where : element.where(),
                   "the duration " + in_quotes(entry.name) + " has " +
                       (entry.unit.empty() ? "no unit" : "the unit " + in_quotes(entry.unit)),
                   "write one of ns, us, ms, s, min, h");
    entry.unit = "s";
  }
  if (!is_number(entry.type) && (unit || entry.minimum || entry.maximum)) {
    findings.error(element.where(),
                   in_quotes(entry.name) + " is a " + std::string(to_string(entry.type)) +
                       " and has a unit or a range",
                   "only numbers and durations have them");
  }
  if (entry.minimum && entry.maximum && *entry.minimum > *entry.maximum) {
    findings.error(element.where(), "the range of " + in_quotes(entry.name) + " is empty",
                   "exchange min and max");
  }
}

/// What Skein itself reads is of the type that it reads it as.
void demand_type_of_known_attribute(const XmlElement& element, const DictionaryEntry& entry) {
  if (entry.kind != EntryKind::Attribute) return;
  const auto demand = [&](bool fits, const char* wanted) {
    if (fits) return;
    element.findings().error(element.where(),
                             "the attribute " + in_quotes(entry.name) + " is a " +
                                 std::string(to_string(entry.type)) +
                                 (entry.unit.empty() ? "" : " in " + entry.unit) +
                                 ", and Skein reads it as something else",
                             std::string("write ") + wanted);
  };
  if (entry.name == "latency") {
    demand(entry.type == ValueType::Duration && entry.unit == "ms",
           "type=\"duration\" unit=\"ms\"; its values may be in other units of time");
  } else if (entry.name == "quality") {
    demand(entry.type == ValueType::Real || entry.type == ValueType::Integer, "type=\"real\"");
  } else if (entry.name == "isolated") {
    demand(entry.type == ValueType::Boolean, "type=\"boolean\"");
  }
}

void read_interface(const XmlElement& element, DictionaryEntry& entry) {
  const auto interface = element.maybe_attribute("interface");
  if (!interface) return;
  if (entry.type != ValueType::Service) {
    element.findings().error(interface->where, in_quotes(entry.name) + " has an interface",
                             "only a type=\"service\" has one");
  } else if (!is_interface_name(interface->value)) {
    element.findings().error(interface->where,
                             in_quotes(interface->value) + " is no interface name",
                             "write one like IDL:AE_navigator/IPlanner");
  } else {
    entry.interface = canonical_interface_name(interface->value);
  }
}

DictionaryEntry read_entry(const XmlElement& element) {
  DictionaryEntry entry;
  entry.kind = element.name() == "attribute" ? EntryKind::Attribute : EntryKind::Parameter;
  entry.name = element.attribute("name").value;
  entry.where = element.where();
  entry.documentation = element.text();
  if (read_type(element, entry)) {
    read_unit_and_range(element, entry);
    demand_type_of_known_attribute(element, entry);
    read_interface(element, entry);
  }
  if (entry.documentation.empty()) {
    element.findings().error(element.where(), in_quotes(entry.name) + " is not documented",
                             "say in the element's text what it means");
  }
  return entry;
}

}  // namespace

Dictionary read_dictionary(const XmlNode& node, FindingList& findings) {
  const XmlElement root(node, findings);
  if (root.name() != dictionary_notation().name) {
    findings.error(root.where(), "<" + shortened(root.name()) + "> is no dictionary",
                   "its outermost element is <dictionary>");
    return {};
  }
  demand_notation(node, dictionary_notation(), findings);
  std::vector<DictionaryEntry> entries;
  std::map<std::pair<EntryKind, std::string>, SourcePosition> seen;
  for (const auto& child : root.children()) {
    if (child.name() != "attribute" && child.name() != "parameter") continue;
    entries.push_back(read_entry(child));
    const auto& entry = entries.back();
    const auto [first, fresh] = seen.emplace(std::pair(entry.kind, entry.name), entry.where);
    if (!fresh) {
      findings.error(entry.where, in_quotes(entry.name) + " is defined twice",
                     "the first is at " + to_text(first->second));
    }
  }
  return Dictionary(std::move(entries));
}

Dictionary parse_dictionary(std::string_view xml, const std::string& file) {
  FindingList findings;
  auto dictionary = read_dictionary(parse_xml(xml, file, findings), findings);
  findings.throw_if_errors();
  return dictionary;
}

Dictionary read_dictionary(const std::filesystem::path& file) {
  return parse_dictionary(read_text_file(file), file.string());
}

}  // namespace skein::profile
