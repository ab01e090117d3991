#pragma once

#include <string>

namespace skein::command {

/// What Graphviz's `dot` makes of a graph in its language, in one of its formats, such as `svg`. A
/// process of its own: it may fail, and be slow, without harm. Throws Unavailable where it is not
/// installed, fails, or takes more than ten seconds.
std::string run_dot(const std::string& format, const std::string& graph);

}  // namespace skein::command
