#pragma once

#include <CLI/CLI.hpp>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "command/look/onlooker.hpp"
#include "mission/process/exit_codes.hpp"

// What the command line of `skein` is made of. Only this folder includes CLI11, which takes long to
// compile. Help, manual pages and completion are made from the same CLI::App.
namespace skein::command {

/// Adds every subcommand, with its help, to `app`. The one that is run leaves its exit code in
/// `result`, which must outlive `app`.
void make_command_line(CLI::App& app, int& result);

/// Adds a subcommand, with its help, to `app`.
using AddCommand = void (*)(CLI::App& app, int& result);

/// The subcommands of a file, in the order in which help lists them.
using Subcommands = std::vector<AddCommand>;
extern Subcommands mission_commands;
extern Subcommands inspection_commands;
extern Subcommands topic_commands;
extern Subcommands recording_commands;
extern Subcommands measuring_commands;
extern Subcommands shell_commands;

/// Stands behind the function that adds a subcommand, in its file, and makes it one of these.
struct SubcommandRow {
  SubcommandRow(Subcommands& all, AddCommand add) { all.push_back(add); }
};

/// A command line as a user would type it, and what it does.
struct Example {
  std::string line;
  std::string purpose;
};

/// A subcommand. The first line of `description` is its summary in lists of commands; more may
/// follow after an empty line.
CLI::App& add_command(CLI::App& parent, const std::string& name, const std::string& description,
                      const std::vector<Example>& examples);

/// Makes `command` run `function`, whose exit code becomes `result`. Returns the arguments for its
/// options to fill.
template <typename Arguments>
Arguments& arguments_of(CLI::App& command, int (*function)(const Arguments&), int& result) {
  const auto arguments = std::make_shared<Arguments>();
  command.callback([arguments, function, &result] {
    if constexpr (std::is_base_of_v<Onlooker, Arguments>) {
      result = look(*arguments, [&] { return function(*arguments); });
    } else {
      result = function(*arguments);
    }
  });
  return *arguments;
}

/// The exit codes of that kind of command with their meanings, for the end of a help; of all
/// commands if `kind` is null.
std::string exit_codes_text(const launch::CommandKind* kind = nullptr);

/// Those of a command at the end of its help.
void add_exit_codes(CLI::App& command, const launch::CommandKind& kind = launch::kLooking);

/// The kinds of values that completion knows. Any other text may be an option's `type_name`: the
/// unit of its value, or a word for it.
inline constexpr const char* kFile = "FILE";
inline constexpr const char* kDirectory = "DIRECTORY";
inline constexpr const char* kInterface = "INTERFACE";
inline constexpr const char* kService = "SERVICE";  ///< By interface or entity.
inline constexpr const char* kOperation = "OPERATION";
inline constexpr const char* kTopic = "TOPIC";
inline constexpr const char* kEntity = "ENTITY";  ///< That tells its parameters.
inline constexpr const char* kParameter = "PARAMETER";
inline constexpr const char* kServiceOrTopic = "SERVICE-OR-TOPIC";
std::string one_of(const std::vector<std::string>& words);  ///< `a|b|c`

/// A length of time, with or without a unit; help says once what that is.
inline constexpr const char* kDuration = "DURATION";
inline constexpr const char* kDurationHelp =
    "DURATION: seconds, or a number with a unit: 500ms, 2min (us, ms, s, min, h)";

/// Whether no time at all makes sense.
enum class Zero { Taken, Refused };

/// An option for a length of time, which becomes `seconds`.
CLI::Option* add_duration(CLI::App& command, const std::string& name, double& seconds,
                          const std::string& what, Zero zero);
/// How help writes it: `1.5s`.
std::string default_duration(double seconds);

/// For an option whose value `parse` takes: what it throws is told.
CLI::Validator of_form(const std::function<void(const std::string& text)>& parse);

/// For an option whose value must be a number above 0.
CLI::Validator above_zero();

/// For an option whose value must be one of these words.
CLI::Validator known_word(const std::vector<std::string>& words);

/// For options whose value must be the number of a DDS domain, a vendor that reaches other
/// processes, or a network interface that this host has, by name or address.
CLI::Validator domain_number();
CLI::Validator known_vendor();
CLI::Validator interface_of_this_host();

/// The options of a command that joins a domain to look at it.
void add_onlooker(CLI::App& command, Onlooker& onlooker);

/// The option --variable of a command that reads a mission profile.
CLI::Option* add_variables(CLI::App& command, std::vector<std::string>& variables);

/// The option --wait of a command that listens before it prints.
void add_wait(CLI::App& command, double& seconds);

/// The option --json of a command that prints; `form` says what is printed.
CLI::Option* add_json(CLI::App& command, bool& json, const std::string& form = "");

/// Calls `visit` with each command, `app` first, and its words: `skein`, `skein bench latency`.
/// Hidden ones (of an empty group) are left out.
void for_each_command(const CLI::App& app,
                      const std::function<void(const CLI::App&, const std::string&)>& visit);

/// The subcommands that are shown, in the order in which they were added.
std::vector<const CLI::App*> shown_commands(const CLI::App& app);

}  // namespace skein::command
