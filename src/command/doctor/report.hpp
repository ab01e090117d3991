#pragma once

#include <string>

#include "symptom.hpp"

namespace skein::command::doctor {

/// For people: a line for what is fine, and cause, evidence and remedy of the rest. Text from
/// elsewhere is printable.
std::string to_text(const Symptoms& symptoms);

/// JSON: `{"worst": "warning", "findings": [{"severity", "about", "cause", "evidence",
/// "remedy"}]}`.
void print_as_json(const Symptoms& symptoms);

}  // namespace skein::command::doctor
