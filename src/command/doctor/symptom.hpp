#pragma once

#include <string>
#include <vector>

namespace skein::command::doctor {

enum class Severity {
  Fine,     ///< Was looked at, and is in order.
  Note,     ///< Worth knowing, or could not be looked at.
  Warning,  ///< Missions run, but may not do what was meant.
  Error,    ///< Missions cannot run.
};

struct Symptom {
  Severity severity = Severity::Fine;
  std::string about;     ///< A word or two: `buffers`.
  std::string cause;     ///< The fact, in one sentence without a full stop.
  std::string evidence;  ///< The command or file that shows it; may be empty.
  std::string remedy;    ///< What to do or to type; empty if nothing needs doing.
};

using Symptoms = std::vector<Symptom>;

Severity worst_of(const Symptoms& symptoms);

const char* to_string(Severity severity);

}  // namespace skein::command::doctor
