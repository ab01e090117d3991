#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

namespace skein::command {

/// The shells for which there is completion.
const std::vector<std::string>& shells();

/// A script by which that shell completes commands, options, and values of known kinds. Throws
/// InvalidArgument for another shell.
std::string completion(const CLI::App& app, const std::string& shell);

}  // namespace skein::command
