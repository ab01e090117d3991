#include "skein/parameters.hpp"

#include <algorithm>

#include "core/suggestion.hpp"
#include "skein/error.hpp"

namespace skein {
namespace {

std::string text_of(const ParameterValue& value) {
  struct Words {
    std::string operator()(std::int64_t number) const { return std::to_string(number); }
    std::string operator()(double number) const { return std::to_string(number); }
    std::string operator()(bool flag) const { return flag ? "true" : "false"; }
    std::string operator()(std::chrono::nanoseconds time) const {
      return std::to_string(std::chrono::duration<double>(time).count()) + " s";
    }
    std::string operator()(const std::string& text) const { return "'" + text + "'"; }
  };
  return std::visit(Words{}, value);
}

}  // namespace

const ParameterValue* ParameterValues::find_value(const std::string& name) const {
  const auto found = values_.find(name);
  return found == values_.end() ? nullptr : &found->second;
}

void ParameterValues::throw_missing(const std::string& name) {
  throw InvalidArgument("the parameter '" + name +
                        "' has no value; set it in the mission profile, and declare it as "
                        "<required>, so that this is found before the start");
}

void ParameterValues::throw_other_type(const std::string& name, const ParameterValue& value,
                                       const char* wanted) {
  throw InvalidArgument("the parameter '" + name + "' is " + text_of(value) + ", which is not " +
                        wanted + "; the dictionary says its type");
}

ParameterValues ParameterResolver::resolve(const std::vector<ParameterValues>& sources) const {
  if (!sources.empty()) refuse_unknown(sources.front());
  ParameterValues resolved;
  std::string missing;
  for (const Declared& parameter : declared_) {
    const auto source = std::find_if(
        sources.begin(), sources.end(),
        [&](const ParameterValues& values) { return values.contains(parameter.name); });
    if (source != sources.end()) {
      resolved.set(parameter.name, source->all().at(parameter.name));
    } else if (parameter.required) {
      missing += (missing.empty() ? "'" : ", '") + parameter.name + "'";
    }
  }
  if (missing.empty()) return resolved;
  throw InvalidArgument(service_ + " needs a value for " + missing +
                        ": pass it with the request or set it in the mission profile");
}

void ParameterResolver::refuse_unknown(const ParameterValues& values) const {
  std::vector<std::string> names;
  for (const Declared& parameter : declared_) names.push_back(parameter.name);
  for (const auto& [name, value] : values.all()) {
    if (std::find(names.begin(), names.end(), name) != names.end()) continue;
    throw InvalidArgument(service_ + " has no parameter '" + name + "'" + suggestion(name, names));
  }
}

}  // namespace skein
