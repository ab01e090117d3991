#include <filesystem>
#include <fstream>
#include <iostream>

#include "command/commands.hpp"
#include "command_line.hpp"
#include "completion.hpp"
#include "core/system/whole_file.hpp"
#include "manual.hpp"

// Completion and manual pages, both made from the command line itself.
namespace skein::command {

Subcommands shell_commands;

namespace {

void write_manual(const CLI::App& app, const std::filesystem::path& folder) {
  std::filesystem::create_directories(folder);
  for_each_command(app, [&](const CLI::App& command, const std::string& words) {
    const auto path = folder / (page_name(words) + ".1");
    std::ofstream file(path);
    file << manual_page(command, words);
    if (!file.flush())
      throw WriteFailed(path.string() + " cannot be written; is its folder writable?");
  });
}

void add_completion(CLI::App& app, int& /*result*/) {
  auto& command = add_command(
      app, "completion", "Print what completes Skein's commands in a shell",
      {{"source <(skein completion bash)", "For this bash"},
       {"skein completion zsh > ~/.zfunc/_skein", "For zsh, where ~/.zfunc is in fpath"},
       {"skein completion fish | source", "For this fish"}});
  const auto shell = std::make_shared<std::string>();
  command.add_option("SHELL", *shell, "The shell: " + one_of(shells()))
      ->type_name(one_of(shells()))
      ->check(known_word(shells()))
      ->required();
  command.callback([shell] { std::cout << completion_script(*shell); });
}
const SubcommandRow kCompletionRow(shell_commands, add_completion);

int complete(const CLI::App& app, const std::vector<std::string>& words) {
  const Completion completion = completion_of(app, words);
  for (const std::string& line : completion.lines) std::cout << line << '\n';
  if (completion.live.empty()) return 0;
  LiveNamesArguments arguments;
  arguments.kind = completion.live;
  arguments.before = completion.before;
  CLI::App looking;
  add_onlooker(looking, arguments);
  looking.allow_extras();  // options and arguments of the command that is completed
  try {
    looking.parse(std::vector<std::string>(words.rbegin(), words.rend()));
  } catch (const CLI::ParseError&) {
    return 0;
  }
  return look(arguments, [&] { return print_live_names(arguments); });
}

/// Hidden: completion runs it, with all words that were typed.
void add_complete(CLI::App& app, int& result) {
  auto& command = add_command(app, "complete", "Print what completes a command line", {});
  command.group("");
  const auto words = std::make_shared<std::vector<std::string>>();
  command.add_option("WORD", *words, "What was typed behind skein; the last may be a part");
  command.callback([&app, &result, words] { result = complete(app, *words); });
}
const SubcommandRow kCompleteRow(shell_commands, add_complete);

/// Hidden: the build runs it.
void add_man(CLI::App& app, int& /*result*/) {
  auto& command = add_command(app, "man", "Write the manual pages into a folder",
                              {{"skein man share/man/man1", "One page for each command"}});
  command.group("");
  const auto folder = std::make_shared<std::string>();
  command.add_option("FOLDER", *folder, "Is made where it is missing")
      ->type_name(kDirectory)
      ->required();
  command.callback([&app, folder] { write_manual(app, *folder); });
}
const SubcommandRow kManRow(shell_commands, add_man);

}  // namespace
}  // namespace skein::command
