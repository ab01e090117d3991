#include "completion.hpp"

#include <algorithm>

#include "command_line.hpp"
#include "core/system/network_interface.hpp"
#include "help.hpp"

namespace skein::command {
namespace {

/// The kinds of print_live_names() by the types of options.
constexpr std::pair<const char*, const char*> kLive[] = {
    {kService, "service"}, {kOperation, "operation"}, {kTopic, "topic"},
    {kEntity, "entity"},   {kParameter, "parameter"}, {kServiceOrTopic, "name"}};

void add_values(const CLI::Option& option, Completion& completion) {
  const std::string type = option.get_type_name();
  if (type == kFile) completion.lines = {":file"};
  if (type == kDirectory) completion.lines = {":directory"};
  if (type == kInterface) {
    for (const NetworkInterface& interface : network_interfaces())
      completion.lines.push_back(interface.name);
  }
  for (const auto& [name, kind] : kLive)
    if (type == name) completion.live = kind;
  if (type.find('|') != std::string::npos) completion.lines = CLI::detail::split(type, '|');
}

/// Which option takes the next word as its value; null if none does.
const CLI::Option* awaiting(const CLI::App& command, const std::string& word) {
  const CLI::Option* option = command.get_option_no_throw(word);
  return option && option->get_items_expected_max() > 0 ? option : nullptr;
}

std::vector<std::string> option_lines(const CLI::App& command) {
  std::vector<std::string> lines;
  for (const CLI::Option* option : options_of(command)) {
    for (const std::string& name : option->get_snames())
      lines.push_back("-" + name + "\t" + option->get_description());
    for (const std::string& name : option->get_lnames())
      lines.push_back("--" + name + "\t" + option->get_description());
  }
  return lines;
}

constexpr const char* kBash = R"bash(# Completion of skein for bash.
_skein() {
  local current=${COMP_WORDS[COMP_CWORD]} line
  local -a words=()
  for line in "${COMP_WORDS[@]:1:COMP_CWORD-1}"; do  # bash takes an equals sign for a word
    [[ $line == '=' ]] || words+=("$line")
  done
  [[ $current == '=' ]] && current=
  COMPREPLY=()
  while IFS=$'\t' read -r line _; do
    case $line in
      :file | :directory)
        compopt -o filenames 2>/dev/null
        mapfile -t COMPREPLY < <(compgen "-${line:1:1}" -- "$current") ;;
      "$current"*) COMPREPLY+=("$(printf %q "$line")") ;;  # a name from a network may be hostile
    esac
  done < <(skein complete -- "${words[@]}" "$current" 2>/dev/null)
}
complete -F _skein skein
)bash";

constexpr const char* kZsh = R"zsh(#compdef skein
# Completion of skein for zsh.
_skein() {
  local line name
  local -a names
  for line in ${(f)"$(skein complete -- "${(@Q)words[2,CURRENT-1]}" "${(Q)PREFIX}" 2>/dev/null)"}; do
    case $line in
      :file) _files ;;
      :directory) _files -/ ;;
      *)
        name=${line%%$'\t'*}
        names+=("${name//:/\\:}:${${line#$name}#$'\t'}") ;;
    esac
  done
  (( $#names )) && _describe skein names
}
# Loaded by name from fpath, the file is the function's body; sourced, it only defines it.
if [ "$funcstack[1]" = "_skein" ]; then
  _skein "$@"
else
  compdef _skein skein
fi
)zsh";

constexpr const char* kFish = R"fish(# Completion of skein for fish.
function __skein
    for line in (skein complete -- (commandline -opc)[2..] "$(commandline -ct)" 2>/dev/null)
        switch $line
            case :file
                __fish_complete_path (commandline -ct)
            case :directory
                __fish_complete_directories (commandline -ct)
            case '*'
                printf '%s\n' $line
        end
    end
end
complete -c skein -f -a '(__skein)'
)fish";

}  // namespace

const std::vector<std::string>& shells() {
  static const std::vector<std::string> known{"bash", "zsh", "fish"};
  return known;
}

std::string completion_script(const std::string& shell) {
  return shell == "bash" ? kBash : shell == "zsh" ? kZsh : kFish;
}

Completion completion_of(const CLI::App& app, std::vector<std::string> words) {
  const std::string last = words.empty() ? "" : words.back();
  if (!words.empty()) words.pop_back();
  const CLI::App* command = &app;
  const CLI::Option* waiting = nullptr;
  std::vector<std::string> arguments;
  for (const std::string& word : words) {
    const auto commands = shown_commands(*command);
    const auto child = std::ranges::find(commands, word, &CLI::App::get_name);
    if (waiting) {
      waiting = nullptr;
    } else if (word.starts_with('-')) {
      waiting = awaiting(*command, word);
    } else if (child != commands.end()) {
      command = *child;
    } else {
      arguments.push_back(word);
    }
  }
  Completion completion;
  if (!arguments.empty()) completion.before = arguments.back();
  const auto places = arguments_by_place(*command);
  if (waiting) {
    add_values(*waiting, completion);
  } else if (last.starts_with('-')) {
    completion.lines = option_lines(*command);
    const std::string name = last.substr(0, last.find('='));
    if (const CLI::Option* option = awaiting(*command, name); option && name != last) {
      completion.lines.clear();
      add_values(*option, completion);
      completion.live.clear();  // names and files are printed without the option
      std::erase_if(completion.lines, [](const std::string& line) { return line[0] == ':'; });
      for (std::string& line : completion.lines) line.insert(0, name + "=");
    }
  } else if (const auto commands = shown_commands(*command); !commands.empty()) {
    for (const CLI::App* child : commands)
      completion.lines.push_back(child->get_name() + "\t" + summary_of(*child));
  } else if (arguments.size() < places.size()) {
    add_values(*places[arguments.size()], completion);
  }
  // fish would take the letters of a word in any place, even those of its meaning.
  std::erase_if(completion.lines,
                [&](const std::string& line) { return line[0] != ':' && !line.starts_with(last); });
  return completion;
}

}  // namespace skein::command
