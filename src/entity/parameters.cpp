#include "skein/parameters.hpp"

#include <algorithm>

#include "core/suggestion.hpp"
#include "skein/error.hpp"

namespace skein {

ParameterValues ParameterResolver::resolve(const std::vector<ParameterValues>& sources) const {
  if (!sources.empty()) refuse_unknown(sources.front());
  ParameterValues resolved;
  std::string missing;
  for (const Declared& parameter : declared_) {
    const auto source = std::find_if(
        sources.begin(), sources.end(),
        [&](const ParameterValues& values) { return values.contains(parameter.name); });
    if (source != sources.end()) {
      resolved[parameter.name] = source->at(parameter.name);
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
  for (const auto& [name, value] : values) {
    if (std::find(names.begin(), names.end(), name) != names.end()) continue;
    throw InvalidArgument(service_ + " has no parameter '" + name + "'" + suggestion(name, names));
  }
}

}  // namespace skein
