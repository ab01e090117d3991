#include "diagnosis.hpp"

#include <algorithm>

namespace skein::command::doctor {

Symptoms diagnose(const Purpose& purpose, const Facts& facts) {
  Symptoms symptoms = diagnose_network(purpose, facts);
  const Symptoms more = diagnose_system(purpose, facts);
  symptoms.insert(symptoms.end(), more.begin(), more.end());
  return symptoms;
}

Severity worst_of(const Symptoms& symptoms) {
  const auto worst = std::ranges::max_element(symptoms, {}, &Symptom::severity);
  return worst == symptoms.end() ? Severity::Fine : worst->severity;
}

const char* to_string(Severity severity) {
  switch (severity) {
    case Severity::Fine:
      return "fine";
    case Severity::Note:
      return "note";
    case Severity::Warning:
      return "warning";
    case Severity::Error:
      break;
  }
  return "error";
}

}  // namespace skein::command::doctor
