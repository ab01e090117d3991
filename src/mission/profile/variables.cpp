#include "variables.hpp"

#include "mission/xml/words.hpp"
#include "plain_name.hpp"

namespace skein::profile {
namespace {

constexpr std::size_t kLongestValue = 4096;
constexpr std::string_view kInstance = "instance";

}  // namespace

void Variables::define(const XmlElement& variable) {
  auto& findings = variable.findings();
  const auto name = variable.attribute("name");
  if (name.value.empty() || !demand_plain_name(name, findings)) return;
  if (name.value == kInstance) {
    findings.error(name.where, "the variable \"instance\" has a meaning of its own",
                   "it is the number of a peer with count=\"...\"; take another name");
    return;
  }
  if (const auto known = variables_.find(name.value); known != variables_.end()) {
    if (known->second.where.file != variable.where().file) return;
    findings.error(variable.where(), "the variable " + in_quotes(name.value) + " is there twice",
                   "the first is at " + to_text(known->second.where));
    return;
  }
  Variable entry{variable.where(), variable.where(), "", false};
  if (const auto given = given_.find(name.value); given != given_.end()) {
    entry.value_where = {"--variable " + shortened(name.value), 0, 0};
    entry.value = given->second;
  } else if (auto value = variable.maybe_attribute("default")) {
    expand(*value, std::nullopt, findings);
    entry.value_where = value->given_by.value_or(variable.where());
    entry.value = value->value;
    entry.unreadable = value->unreadable;
  } else {
    findings.error(
        variable.where(), "the variable " + in_quotes(name.value) + " has no value",
        "give it one by --variable " + shortened(name.value) + "=VALUE, or write default=\"...\"");
    entry.unreadable = true;
  }
  variables_.emplace(name.value, std::move(entry));
}

void Variables::expand(XmlAttribute& attribute, const std::optional<std::string>& instance,
                       FindingList& findings) const {
  const auto refuse = [&](const std::string& problem, const std::string& remedy) {
    findings.error(attribute.where, problem, remedy);
    attribute.unreadable = true;
  };
  std::string text;
  for (std::string_view rest = attribute.value; !rest.empty();) {
    const auto dollar = rest.find('$');
    text += rest.substr(0, dollar);
    if (dollar == std::string_view::npos) break;
    rest.remove_prefix(dollar);
    if (rest.substr(0, 2) == "$$") {
      text += '$';
      rest.remove_prefix(2);
      continue;
    }
    const auto end = rest.find('}');
    const bool closed = end != std::string_view::npos && rest.find('$', 1) > end;
    if (rest.substr(0, 2) != "${" || !closed) {
      return refuse(in_quotes(attribute.value) + " holds a lone \"$\"",
                    "write ${name} for a variable's value, $$ for a dollar");
    }
    const auto name = rest.substr(2, end - 2);
    rest.remove_prefix(end + 1);
    if (name == kInstance) {
      if (!instance) {
        return refuse("${instance} stands outside of a peer with count=\"...\"",
                      "write count=\"...\" at the <peer>");
      }
      text += *instance;
    } else if (const auto found = variables_.find(name); found == variables_.end()) {
      std::vector<std::string_view> known;
      for (const auto& [known_name, variable] : variables_) known.push_back(known_name);
      return refuse("the variable " + in_quotes(name) + " is unknown here",
                    known.empty() ? "define it before: <variable name=\"...\" default=\"...\"/>"
                                  : remedy_for(name, known));
    } else if (found->second.unreadable) {
      attribute.unreadable = true;  // its definition has the finding
      return;
    } else {
      text += found->second.value;
      if (text.size() == found->second.value.size() && rest.empty())
        attribute.given_by = found->second.value_where;
    }
    if (text.size() > kLongestValue) {
      return refuse("with its variables, the value is longer than " +
                        std::to_string(kLongestValue) + " characters",
                    "shorten it, or let a parameter's value be @FILE, which names a file of it");
    }
  }
  attribute.value = trimmed(text);
}

void Variables::demand_known(const std::string& file, FindingList& findings) const {
  std::vector<std::string_view> known;
  for (const auto& [name, variable] : variables_) known.push_back(name);
  for (const auto& [name, value] : given_) {
    if (variables_.find(name) != variables_.end()) continue;
    findings.error({file, 0, 0},
                   "there is no variable " + in_quotes(name) + ", which --variable sets",
                   known.empty() ? "the profile has none" : remedy_for(name, known));
  }
}

}  // namespace skein::profile
