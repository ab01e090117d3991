#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

// What help and manual pages say of a command and of its options, from its CLI::App.
namespace skein::command {

/// The first line of its description.
std::string summary_of(const CLI::App& command);
/// What follows the first line; may be empty.
std::string details_of(const CLI::App& command);

/// The names that a user may write: `-h, --help`; `PROFILE` of an argument by its place.
std::string names_of(const CLI::Option& option);
/// What stands for its value: `SECONDS`, `fastdds|cyclonedds`; empty for a flag and for an argument
/// by its place.
std::string value_of(const CLI::Option& option);
/// What it says, with its default, and which others it needs or excludes.
std::string text_of(const CLI::Option& option);

/// The options that are shown, and the arguments by place, in the order in which they were added.
std::vector<const CLI::Option*> options_of(const CLI::App& command);
std::vector<const CLI::Option*> arguments_by_place(const CLI::App& command);

/// Whether one of the options is a length of time.
bool takes_duration(const CLI::App& command);

/// `[OPTIONS] PROFILE [NAME...]`: what follows the command's words.
std::string usage_of(const CLI::App& command);

/// Help that fits into 80 columns.
class HelpFormatter final : public CLI::Formatter {
 public:
  std::string make_help(const CLI::App* app, std::string name,
                        CLI::AppFormatMode mode) const override;
};

}  // namespace skein::command
