#pragma once

#include <string>

namespace skein::command {

/// JSON from the network for a terminal: what could drive one is escaped. In one line, or indented.
std::string json_text(const std::string& json, bool indented);

}  // namespace skein::command
