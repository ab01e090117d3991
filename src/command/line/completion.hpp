#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

namespace skein::command {

/// The shells for which there is completion.
const std::vector<std::string>& shells();

/// The script by which one of shells() completes: it asks `skein complete`, and lets the shell
/// complete files itself.
std::string completion_script(const std::string& shell);

/// The candidates for the last word of a command line.
struct Completion {
  /// Each with its meaning behind a tab, or `:file` or `:directory` alone.
  std::vector<std::string> lines;
  std::string live{};    ///< The kind for print_live_names(); empty: no domain is asked.
  std::string before{};  ///< The last argument by place before it.
};

/// `words`: those behind `skein`, the last of which may be a part, or empty.
Completion completion_of(const CLI::App& app, std::vector<std::string> words);

}  // namespace skein::command
