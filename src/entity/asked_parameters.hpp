#pragma once

#include <string>

namespace skein {

/// Whether code of this process has asked for a parameter of that name, by ParameterValues::get()
/// or find(), whether it had a value or not. Thread-safe.
bool was_parameter_asked(const std::string& name);

}  // namespace skein
