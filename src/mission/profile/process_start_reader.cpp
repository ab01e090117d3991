#include "process_start_reader.hpp"

#include <algorithm>
#include <array>
#include <filesystem>

#include "cpu_list_reader.hpp"
#include "mission/xml/notation.hpp"
#include "mission/xml/words.hpp"
#include "repeated.hpp"

namespace skein::profile {
namespace {

constexpr const char* kCpus = "process_cpus";

/// Obeyed by the launcher, like kProcessAttributes; skein peer obeys the rest.
constexpr std::array<std::string_view, 6> kOfPrograms{"system",  "host",  "component",
                                                      "program", "ready", kCpus};

/// A path is relative to the file in which it stands.
std::string read_program(const XmlElement& element) {
  if (!element.maybe_attribute("program")) return {};
  const auto program = element.attribute("program");
  if (program.value.find('/') == std::string::npos) return program.value;
  const auto folder = std::filesystem::path(program.where.file).parent_path();
  return std::filesystem::absolute(folder / program.value).lexically_normal().string();
}

bool read_tells_ready(const XmlElement& element, const ProcessStart& start) {
  const auto word = element.maybe_attribute("ready");
  if (start.program.empty()) {
    if (word && !word->inherited) {
      element.findings().error(word->where, "ready is for a program of one's own",
                               "leave it out: skein peer tells when it is ready");
    }
    return true;
  }
  if (!word || word->value == "started") return false;
  if (word->value == "told") return true;
  element.findings().error(word->where, "ready is " + in_quotes(word->value),
                           remedy_for(word->value, {"started", "told"}));
  return true;
}

bool is_variable_name(std::string_view name) {
  const auto letter = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_';
  };
  return !name.empty() && letter(name.front()) &&
         std::all_of(name.begin(), name.end(),
                     [&](char c) { return letter(c) || (c >= '0' && c <= '9'); });
}

void read_environment(const XmlElement& element, ProcessStart& start) {
  Repeated names("the environment variable");
  for (const auto& child : element.children("environment")) {
    const auto name = child.attribute("name");
    const auto value = child.maybe_attribute("value");
    auto& findings = child.findings();
    if (!value) (void)child.attribute("value");
    if (name.value.empty() || !value) continue;
    names.add(name.value, child.where(), findings);
    if (!is_variable_name(name.value)) {
      findings.error(name.where, in_quotes(name.value) + " is no name of an environment variable",
                     "use letters, digits and _");
    } else if (name.value == kReadyVariable) {
      findings.error(name.where, in_quotes(name.value) + " is set by the launcher", "remove it");
    } else {
      start.environment.emplace_back(name.value, value->value);
    }
  }
}

}  // namespace

ProcessStart read_process_start(const XmlElement& element) {
  ProcessStart start;
  start.program = read_program(element);
  start.tells_ready = read_tells_ready(element, start);
  start.cpus = read_cpus(element, kCpus);
  read_environment(element, start);
  for (const auto& child : element.children("argument")) {
    const auto value = child.maybe_attribute("value");
    start.arguments.push_back(value ? value->value : child.attribute("value").value);
  }
  return start;
}

void refuse_process_start(const XmlElement& element) {
  const auto refuse = [&](const SourcePosition& where, const std::string& what) {
    element.findings().error(where, what + " is for processes, and this CSP has none",
                             "write process=\"own\", or set it at the <peer>");
  };
  for (const char* name : {kCpus, "program"}) {
    if (const auto attribute = element.maybe_attribute(name)) refuse(attribute->where, name);
  }
  for (const char* name : {"environment", "argument"}) {
    for (const auto& child : element.children(name)) {
      refuse(child.where(), "<" + std::string(name) + ">");
    }
  }
}

void refuse_peer_options(const XmlElement& element) {
  const auto refuse = [&](const SourcePosition& where, const std::string& what) {
    element.findings().error(where, what + " has no effect on a program of one's own",
                             "remove it, or hand it over as an <argument> or <environment>");
  };
  const Names& of_processes = attribute_group(kProcessAttributes);
  for (const std::string_view name : attribute_group(kGroupDefaults)) {
    const auto attribute = element.maybe_attribute(name);
    if (!attribute || attribute->inherited || std::ranges::count(of_processes, name) != 0 ||
        std::ranges::count(kOfPrograms, name) != 0) {
      continue;
    }
    refuse(attribute->where, std::string(name));
  }
  for (const char* name : {"csp", "parameter", "topic"}) {
    for (const auto& child : element.children(name)) {
      refuse(child.where(), "<" + std::string(name) + ">");
    }
  }
}

}  // namespace skein::profile
