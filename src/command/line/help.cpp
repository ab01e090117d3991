#include "help.hpp"

#include <algorithm>
#include <sstream>

#include "command/print/wrapped.hpp"
#include "command_line.hpp"

namespace skein::command {
namespace {

constexpr std::size_t kWidth = 80;
constexpr std::size_t kTextColumn = 28;

std::string joined(const std::set<CLI::Option*>& options) {
  std::vector<std::string> names;
  for (const CLI::Option* option : options) names.push_back(option->get_name());
  std::ranges::sort(names);
  return CLI::detail::join(names, ", ");
}

/// `what`, then `text` from kTextColumn on, or on the next line where `what` is too long.
std::string entry(const std::string& what, const std::string& text) {
  std::string lines = "  " + what;
  if (lines.size() + 2 > kTextColumn) lines += "\n" + std::string(kTextColumn, ' ');
  lines.resize(std::max(lines.size(), kTextColumn), ' ');
  return lines + wrapped(text, kWidth, kTextColumn) + "\n";
}

std::string entry(const CLI::Option& option) {
  const std::string value = value_of(option);
  return entry(names_of(option) + (value.empty() ? "" : " " + value), text_of(option));
}

std::string entries(const std::string& title, const std::vector<const CLI::Option*>& options) {
  if (options.empty()) return {};
  std::string text = "\n" + title + ":\n";
  for (const CLI::Option* option : options) text += entry(*option);
  return text;
}

std::string command_list(const CLI::App& app) {
  std::string text, group;
  for (const CLI::App* command : shown_commands(app)) {
    if (command->get_group() != group) {
      group = command->get_group();
      text += "\n" + (app.get_parent() ? "Commands" : group) + ":\n";
    }
    text += entry(command->get_name(), summary_of(*command));
  }
  return text;
}

}  // namespace

std::string summary_of(const CLI::App& command) {
  const std::string text = command.get_description();
  return text.substr(0, text.find('\n'));
}

std::string details_of(const CLI::App& command) {
  const std::string text = command.get_description();
  const std::size_t end = text.find('\n');
  return end == std::string::npos ? "" : text.substr(text.find_first_not_of('\n', end));
}

std::string names_of(const CLI::Option& option) {
  if (option.get_positional()) return option.get_name(true);
  std::string names;
  for (const std::string& name : option.get_snames()) names += "-" + name + ", ";
  for (const std::string& name : option.get_lnames()) names += "--" + name + ", ";
  return names.substr(0, names.size() - 2);
}

std::string value_of(const CLI::Option& option) {
  if (option.get_positional() || option.get_items_expected_max() == 0) return {};
  const bool several = option.get_expected_max() == CLI::detail::expected_max_vector_size;
  return option.get_type_name() + (several ? "..." : "");
}

std::string text_of(const CLI::Option& option) {
  std::string text = option.get_description();
  if (std::string value = option.get_default_str(); !value.empty()) {
    std::erase_if(value, [](char c) { return c == '[' || c == ']'; });
    text += "; default: " + value;
  }
  if (!option.get_needs().empty()) text += "; only with " + joined(option.get_needs());
  if (!option.get_excludes().empty()) text += "; not with " + joined(option.get_excludes());
  return text;
}

std::vector<const CLI::Option*> options_of(const CLI::App& command) {
  return command.get_options([](const CLI::Option* option) {
    return !option->get_group().empty() && option->nonpositional();
  });
}

bool takes_duration(const CLI::App& command) {
  return std::ranges::any_of(options_of(command), [](const CLI::Option* option) {
    return option->get_type_name() == kDuration;
  });
}

std::vector<const CLI::Option*> arguments_by_place(const CLI::App& command) {
  return command.get_options([](const CLI::Option* option) { return option->get_positional(); });
}

std::string usage_of(const CLI::App& command) {
  std::string text = "[OPTIONS]";
  for (const CLI::Option* argument : arguments_by_place(command)) {
    const bool several = argument->get_expected_max() == CLI::detail::expected_max_vector_size;
    const std::string name = argument->get_name(true) + (several ? "..." : "");
    text += argument->get_required() ? " " + name : " [" + name + "]";
  }
  if (!shown_commands(command).empty()) text += " COMMAND";
  return text;
}

std::string HelpFormatter::make_help(const CLI::App* app, std::string name,
                                     CLI::AppFormatMode /*mode*/) const {
  std::string text = summary_of(*app) + "\n\nUsage: " + name + " " + usage_of(*app) + "\n";
  std::istringstream paragraphs(details_of(*app));
  for (std::string paragraph; std::getline(paragraphs, paragraph);)
    if (!paragraph.empty()) text += "\n" + wrapped(paragraph, kWidth, 0) + "\n";
  text += entries("Arguments", arguments_by_place(*app));
  text += entries("Options", options_of(*app));
  if (takes_duration(*app)) text += std::string("\n") + kDurationHelp + "\n";
  text += command_list(*app);
  return text + "\n" + app->get_footer();
}

}  // namespace skein::command
