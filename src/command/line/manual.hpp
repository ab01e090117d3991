#pragma once

#include <CLI/CLI.hpp>
#include <string>

namespace skein::command {

/// The manual page of a command, in the man macros of roff: what its help says. `words` are those
/// that call it: `skein bench latency`.
std::string manual_page(const CLI::App& command, const std::string& words);

/// The name of that page: `skein-bench-latency`.
std::string page_name(std::string words);

}  // namespace skein::command
