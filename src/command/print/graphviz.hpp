#pragma once

#include <string>

namespace skein::command {

/// Has Graphviz's `dot` draw a graph of its language, in one of its formats, such as `svg`. `dot`
/// is a process: if it fails, this one goes on. Throws Unavailable if it is not
/// installed, fails, or takes more than ten seconds.
std::string run_dot(const std::string& format, const std::string& graph);

}  // namespace skein::command
