#include <filesystem>
#include <fstream>
#include <iostream>

#include "command/commands.hpp"
#include "command_line.hpp"
#include "completion.hpp"
#include "core/whole_file.hpp"
#include "manual.hpp"

// Completion and manual pages, both made from the command line itself.
namespace skein::command {
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

void add_completion(CLI::App& app) {
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
  command.callback([&app, shell] { std::cout << completion(app, *shell); });
}

/// Of commands that are completed: their values are no words of `complete`.
void ignore_other_options(const CLI::App& app, CLI::App& complete) {
  for_each_command(app, [&](const CLI::App& command, const std::string&) {
    for (const CLI::Option* option : command.get_options()) {
      if (option->get_items_expected_max() == 0) continue;
      for (const std::string& name : option->get_lnames()) {
        if (complete.get_option_no_throw("--" + name)) continue;
        complete.add_option_function<std::string>("--" + name, [](const std::string&) {})
            ->expected(0, 1)  // it may be the value that is completed
            ->take_last();
      }
    }
  });
}

/// Hidden: completion runs it, with all words that were typed.
void add_complete(CLI::App& app, int& result) {
  auto& command = add_command(app, "complete", "Print names of a domain for completion", {});
  command.group("");
  auto& arguments = arguments_of(command, print_live_names, result);
  command.add_option("KIND", arguments.kind, "Of the names")->required();
  command.add_option("WORD", arguments.words, "What was typed");
  add_onlooker(command, arguments);
  ignore_other_options(app, command);
  command.allow_extras();
}

/// Hidden: the build runs it.
void add_man(CLI::App& app) {
  auto& command = add_command(app, "man", "Write the manual pages into a folder",
                              {{"skein man share/man/man1", "One page for each command"}});
  command.group("");
  const auto folder = std::make_shared<std::string>();
  command.add_option("FOLDER", *folder, "Is made where it is missing")
      ->type_name(kDirectory)
      ->required();
  command.callback([&app, folder] { write_manual(app, *folder); });
}

}  // namespace

void add_shell_commands(CLI::App& app, int& result) {
  add_completion(app);
  add_complete(app, result);
  add_man(app);
}

}  // namespace skein::command
