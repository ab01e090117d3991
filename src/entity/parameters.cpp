#include "skein/parameters.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <mutex>
#include <set>
#include <string_view>

#include "asked_parameters.hpp"
#include "core/suggestion.hpp"
#include "skein/error.hpp"

namespace skein {
namespace {

std::string short_text(double number) {
  std::array<char, 32> text;
  const auto end = std::to_chars(text.data(), text.data() + text.size(), number).ptr;
  return {text.data(), end};
}

/// The type by its name in the dictionary, and the value.
std::string text_of(const ParameterValue& value) {
  struct Words {
    std::string operator()(std::int64_t number) const {
      return "an integer, " + std::to_string(number);
    }
    std::string operator()(double number) const { return "a real, " + short_text(number); }
    std::string operator()(bool flag) const {
      return std::string("a boolean, ") + (flag ? "true" : "false");
    }
    std::string operator()(std::chrono::nanoseconds time) const {
      return "a duration, " + short_text(std::chrono::duration<double>(time).count()) + " s";
    }
    std::string operator()(const std::string& text) const { return "a text, '" + text + "'"; }
  };
  return std::visit(Words{}, value);
}

struct Asked {
  std::mutex mutex;
  std::set<std::string> names;
};

/// Of the whole process: the values are copied at will, and each copy may be read.
Asked& asked() {
  static auto& all = *new Asked;  // static objects may ask when they end
  return all;
}

}  // namespace

bool was_parameter_asked(const std::string& name) {
  const std::lock_guard lock(asked().mutex);
  return asked().names.contains(name);
}

const ParameterValue* ParameterValues::find_value(const std::string& name) const {
  {
    const std::lock_guard lock(asked().mutex);
    asked().names.insert(name);
  }
  const auto found = values_.find(name);
  return found == values_.end() ? nullptr : &found->second;
}

void ParameterValues::throw_missing(const std::string& name) const {
  std::vector<std::string> names;
  for (const auto& [known, value] : values_) names.push_back(known);
  throw InvalidArgument("the code asks for the parameter '" + name + "', which has no value" +
                        suggestion(name, names) +
                        "; set it in the mission profile, and declare it as "
                        "<required>, so that this is found before the start");
}

void ParameterValues::throw_other_type(const std::string& name, const ParameterValue& value,
                                       const char* wanted) {
  if (std::holds_alternative<std::int64_t>(value) &&
      std::string_view(wanted).starts_with("an integer")) {
    throw InvalidArgument("the parameter '" + name + "' is " + text_of(value) +
                          ", which does not fit into the integer type that the code asks for; ask "
                          "for a larger one, or bound the parameter in the dictionary (max=)");
  }
  throw InvalidArgument("the code asks for the parameter '" + name + "' as " + wanted +
                        ", and by the dictionary it is " + text_of(value) +
                        "; change the one or the other");
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
