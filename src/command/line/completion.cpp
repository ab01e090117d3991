#include "completion.hpp"

#include <algorithm>

#include "command_line.hpp"
#include "help.hpp"

namespace skein::command {
namespace {

/// The kinds of `skein complete` by the types of options.
constexpr std::pair<const char*, const char*> kLive[] = {
    {kService, "service"}, {kOperation, "operation"}, {kTopic, "topic"},
    {kEntity, "entity"},   {kParameter, "parameter"}, {kServiceOrTopic, "name"}};

/// Of a kind `live:topic`, `topic`; empty for others.
std::string live_kind(const std::string& kind) {
  constexpr std::string_view kPrefix = "live:";
  return kind.starts_with(kPrefix) ? kind.substr(kPrefix.size()) : "";
}

/// What completes a value: `file`, `directory`, `interface`, `words:a,b`, `live:topic` for what
/// `skein complete topic` tells of a domain, or `value` for one that only the user knows.
std::string kind_of(const CLI::Option& option) {
  const std::string type = option.get_type_name();
  if (type == kFile) return "file";
  if (type == kDirectory) return "directory";
  if (type == kInterface) return "interface";
  for (const auto& [name, kind] : kLive)
    if (type == name) return "live:" + std::string(kind);
  if (type.find('|') == std::string::npos) return "value";
  return "words:" + CLI::detail::find_and_replace(type, "|", ",");
}

std::vector<std::string> names(const CLI::Option& option) {
  std::vector<std::string> all;
  for (const std::string& name : option.get_snames()) all.push_back("-" + name);
  for (const std::string& name : option.get_lnames()) all.push_back("--" + name);
  return all;
}

bool takes_value(const CLI::Option& option) { return option.get_items_expected_max() > 0; }

std::string command_names(const CLI::App& command) {
  std::vector<std::string> all;
  for (const CLI::App* child : shown_commands(command)) all.push_back(child->get_name());
  return CLI::detail::join(all, " ");
}

// --- bash

std::string bash_entry(const CLI::App& command, const std::string& words) {
  std::string options, kinds, places;
  for (const CLI::Option* option : options_of(command)) {
    for (const std::string& name : names(*option)) {
      options += name + " ";
      if (takes_value(*option)) kinds += name + "=" + kind_of(*option) + " ";
    }
  }
  for (const CLI::Option* argument : arguments_by_place(command))
    places += kind_of(*argument) + " ";
  return "    '" + words + "')\n      commands='" + command_names(command) + "' options='" +
         options + "'\n      kinds='" + kinds + "' places=(" + places + ") ;;\n";
}

constexpr const char* kBash = R"bash(
_skein() {
  local current=${COMP_WORDS[COMP_CWORD]} path=skein commands options kinds waiting= place=0 word kind=
  local -a places said=()
  [[ $current == '=' ]] && current=
  _skein_describe "$path"
  for word in "${COMP_WORDS[@]:1:COMP_CWORD-1}"; do
    [[ $word == '=' ]] && continue
    said+=("$word")
    if [[ -n $waiting ]]; then
      waiting=
    elif [[ $word == -* ]]; then
      [[ " $kinds" == *" $word="* ]] && waiting=$word
    elif [[ " $commands " == *" $word "* ]]; then
      path+=" $word" place=0
      _skein_describe "$path"
    else
      place=$((place + 1))
    fi
  done
  if [[ -n $waiting ]]; then
    kind=" $kinds"
    kind=${kind#* "$waiting"=}
    kind=${kind%% *}
  elif [[ $current == -* ]]; then
    kind=words:${options// /,}
  elif [[ -n $commands ]]; then
    kind=words:${commands// /,}
  else
    kind=${places[place]-}
  fi
  COMPREPLY=()
  case $kind in
    file | directory)
      compopt -o filenames 2>/dev/null
      local only=-f
      [[ $kind == directory ]] && only=-d
      mapfile -t COMPREPLY < <(compgen $only -- "$current") ;;
    interface) mapfile -t COMPREPLY < <(compgen -W "$(ls /sys/class/net)" -- "$current") ;;
    live:*)  # names from a network, which compgen would expand
      mapfile -t COMPREPLY < <(skein complete "${kind#live:}" "${said[@]}" 2>/dev/null |
        while IFS= read -r word; do [[ $word == "$current"* ]] && printf '%q\n' "$word"; done) ;;
    words:*) mapfile -t COMPREPLY < <(IFS=,; compgen -W "${kind#words:}" -- "$current") ;;
  esac
}
complete -F _skein skein
)bash";

std::string bash(const CLI::App& app) {
  std::string text = "# Completion of skein for bash.\n_skein_describe() {\n  case $1 in\n";
  for_each_command(app, [&](const CLI::App& command, const std::string& words) {
    text += bash_entry(command, words);
  });
  return text + "  esac\n}\n" + (kBash + 1);
}

// --- zsh

/// Within single quotes, in a specification of _arguments.
std::string zsh_escaped(const std::string& text) {
  std::string safe;
  for (const char c : text) {
    if (c == '\'') {
      safe += "'\\''";
      continue;
    }
    if (c == '[' || c == ']' || c == ':' || c == '\\') safe += '\\';
    safe += c;
  }
  return safe;
}

std::string zsh_action(const CLI::Option& option) {
  const std::string kind = kind_of(option);
  if (kind == "file") return "_files";
  if (kind == "directory") return "_files -/";
  if (kind == "interface") return "_net_interfaces";
  if (const std::string live = live_kind(kind); !live.empty())
    return " _skein_live " + live;  // the blank: without arguments of _arguments
  if (kind == "value") return " ";
  return "(" + CLI::detail::find_and_replace(kind.substr(kind.find(':') + 1), ",", " ") + ")";
}

std::string zsh_option(const CLI::Option& option) {
  const auto all = names(option);
  const bool several = option.get_expected_max() == CLI::detail::expected_max_vector_size;
  std::string text;
  for (const std::string& name : all) {
    // Names of one option exclude each other, unless it may be given several times.
    text += " \\\n    '" + (several ? "*" : "(" + CLI::detail::join(all, " ") + ")") + name + "[" +
            zsh_escaped(option.get_description()) + "]";
    if (takes_value(option))
      text += ":" + zsh_escaped(option.get_type_name()) + ":" + zsh_action(option);
    text += "'";
  }
  return text;
}

std::string zsh_function(std::string words) {
  std::ranges::replace(words, ' ', '_');
  return "_" + words;
}

std::string zsh_commands(const CLI::App& command, const std::string& words) {
  std::string list, branches;
  for (const CLI::App* child : shown_commands(command)) {
    list += "\n        '" + child->get_name() + ":" + zsh_escaped(summary_of(*child)) + "'";
    branches += "\n        " + child->get_name() + ") " +
                zsh_function(words + " " + child->get_name()) + " ;;";
  }
  return "  case $state in\n    command)\n      local -a commands=(" + list +
         ")\n      _describe command commands ;;\n    rest)\n      case $words[1] in" + branches +
         "\n      esac ;;\n  esac\n";
}

std::string zsh_command(const CLI::App& command, const std::string& words) {
  const bool has_commands = !shown_commands(command).empty();
  std::string text = zsh_function(words) + "() {\n";
  if (has_commands) text += "  local curcontext=\"$curcontext\" state line\n";
  text += std::string("  _arguments") + (has_commands ? " -C" : "");
  for (const CLI::Option* option : options_of(command)) text += zsh_option(*option);
  for (const CLI::Option* argument : arguments_by_place(command))
    text +=
        " \\\n    ':" + zsh_escaped(argument->get_name(true)) + ":" + zsh_action(*argument) + "'";
  if (has_commands) text += " \\\n    ': :->command' '*:: :->rest'";
  text += "\n";
  if (has_commands) text += zsh_commands(command, words);
  return text + "}\n";
}

/// $words begins with the last of the command's names.
constexpr const char* kZshLive = R"zsh(
_skein_live() {
  local -a names=(${(f)"$(skein complete $1 ${words[1,CURRENT-1]} 2>/dev/null)"})
  compadd -a names
}
)zsh";

std::string zsh(const CLI::App& app) {
  std::string text = "#compdef skein\n# Completion of skein for zsh.\n";
  for_each_command(app, [&](const CLI::App& command, const std::string& words) {
    text += zsh_command(command, words);
  });
  // Loaded by name from fpath, the file is the function's body; sourced, it only defines it.
  return text + (kZshLive + 1) +
         "if [ \"$funcstack[1]\" = \"_skein\" ]; then\n  _skein \"$@\"\nelse\n"
         "  compdef _skein skein\nfi\n";
}

// --- fish

std::string fish_quoted(const std::string& text) {
  std::string safe = "'";
  for (const char c : text) {
    if (c == '\'' || c == '\\') safe += '\\';
    safe += c;
  }
  return safe + "'";
}

std::string fish_values(const CLI::Option& option) {
  const std::string kind = kind_of(option);
  if (kind == "file") return " -r -F";
  if (kind == "directory") return " -x -a '(__fish_complete_directories)'";
  if (kind == "interface") return " -x -a '(__fish_print_interfaces)'";
  if (const std::string live = live_kind(kind); !live.empty())
    return " -x -a '(skein complete " + live + " (commandline -opc)[2..] 2>/dev/null)'";
  if (kind == "value") return " -x";
  return " -x -a " +
         fish_quoted(CLI::detail::find_and_replace(kind.substr(kind.find(':') + 1), ",", " "));
}

std::string fish_command(const CLI::App& command, const std::string& words) {
  const std::string begin = "complete -c skein -n " + fish_quoted("__skein_at " + words);
  std::string text;
  for (const CLI::App* child : shown_commands(command))
    text += begin + " -a " + child->get_name() + " -d " + fish_quoted(summary_of(*child)) + "\n";
  for (const CLI::Option* option : options_of(command)) {
    text += begin;
    for (const std::string& name : option->get_snames()) text += " -s " + name;
    for (const std::string& name : option->get_lnames()) text += " -l " + name;
    if (takes_value(*option)) text += fish_values(*option);
    text += " -d " + fish_quoted(option->get_description()) + "\n";
  }
  for (const CLI::Option* argument : arguments_by_place(command)) {
    const std::string values = fish_values(*argument);
    // -r and -x are of options alone.
    if (const std::size_t rest = values.find(" -", 1); rest != std::string::npos)
      text += begin + values.substr(rest) + "\n";
  }
  return text;
}

constexpr const char* kFish = R"(
function __skein_at --description 'Whether the words so far call this command'
    set -l path skein
    for word in (commandline -opc)[2..]
        if contains -- "$path $word" $__skein_commands
            set path "$path $word"
        end
    end
    test "$path" = "$argv"
end
complete -c skein -f
)";

std::string fish(const CLI::App& app) {
  std::string commands, completions;
  for_each_command(app, [&](const CLI::App& command, const std::string& words) {
    commands += " " + fish_quoted(words);
    completions += fish_command(command, words);
  });
  return "# Completion of skein for fish.\nset -g __skein_commands" + commands + kFish +
         completions;
}

}  // namespace

const std::vector<std::string>& shells() {
  static const std::vector<std::string> known{"bash", "zsh", "fish"};
  return known;
}

std::string completion(const CLI::App& app, const std::string& shell) {
  if (shell == "bash") return bash(app);
  if (shell == "zsh") return zsh(app);
  return fish(app);
}

}  // namespace skein::command
