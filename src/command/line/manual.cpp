#include "manual.hpp"

#include <algorithm>
#include <sstream>

#include "command/print/wrapped.hpp"
#include "command_line.hpp"
#include "help.hpp"

namespace skein::command {
namespace {

/// Plain text for roff: nothing in it acts as a request or an escape.
std::string escaped(const std::string& text) {
  std::string safe;
  for (const char c : text) {
    if (c == '\\') {
      safe += "\\e";
    } else if (c == '-') {
      safe += "\\-";
    } else if (c == '\'') {
      safe += "\\(aq";
    } else if (c == '`') {
      safe += "\\(ga";
    } else {
      safe += c;
    }
  }
  return safe.starts_with('.') ? "\\&" + safe : safe;
}

/// A paragraph, in short lines.
std::string filled(const std::string& paragraph) {
  std::string text;
  std::istringstream lines(wrapped(paragraph, 72, 0));
  for (std::string line; std::getline(lines, line);) text += escaped(line) + "\n";
  return text;
}

std::string bold(const std::string& text) { return "\\fB" + escaped(text) + "\\fR"; }
std::string italic(const std::string& text) { return "\\fI" + escaped(text) + "\\fR"; }

std::string upper(std::string text) {
  std::ranges::transform(text, text.begin(), [](unsigned char c) { return std::toupper(c); });
  return text;
}

std::string items(const std::string& title, const std::vector<const CLI::Option*>& options) {
  if (options.empty()) return {};
  std::string text = ".SH " + upper(title) + "\n";
  for (const CLI::Option* option : options) {
    const std::string value = value_of(*option);
    text += ".TP\n" + bold(names_of(*option)) + (value.empty() ? "" : " " + italic(value)) + "\n" +
            filled(text_of(*option));
  }
  return text;
}

std::string commands(const CLI::App& command, const std::string& words) {
  const auto children = shown_commands(command);
  if (children.empty()) return {};
  std::string text = ".SH COMMANDS\n";
  for (const CLI::App* child : children) {
    text += ".TP\n.BR " + escaped(page_name(words + " " + child->get_name())) + " (1)\n" +
            escaped(summary_of(*child)) + "\n";
  }
  return text;
}

/// The parts of the help's end: a line that ends with a colon is a heading, and what is indented
/// stays as it is.
std::string sections(const std::string& footer) {
  std::string text;
  std::istringstream lines(footer);
  bool open = false;
  for (std::string line; std::getline(lines, line);) {
    if (line.empty()) continue;
    if (line.front() == ' ') {
      text += escaped(line) + "\n";
      continue;
    }
    text += (open ? ".fi\n" : "") + (".SH \"" + upper(escaped(line.substr(0, line.size() - 1)))) +
            "\"\n.nf\n";
    open = true;
  }
  return text + (open ? ".fi\n" : "");
}

}  // namespace

std::string page_name(std::string words) {
  std::ranges::replace(words, ' ', '-');
  return words;
}

std::string manual_page(const CLI::App& command, const std::string& words) {
  std::string text = ".TH " + upper(escaped(page_name(words))) + " 1 \"\" \"Skein " +
                     SKEIN_VERSION + "\" \"Skein\"\n";
  text += ".SH NAME\n" + filled(page_name(words) + " - " + summary_of(command));
  text += ".SH SYNOPSIS\n" + bold(words) + " " + escaped(usage_of(command)) + "\n";
  if (const std::string details = details_of(command); !details.empty()) {
    text += ".SH DESCRIPTION\n";
    std::istringstream lines(details);
    for (std::string line; std::getline(lines, line);)
      text += line.empty() ? ".PP\n" : filled(line);
  }
  text += items("Arguments", arguments_by_place(command));
  text += items("Options", options_of(command));
  if (takes_duration(command)) text += ".PP\n" + filled(kDurationHelp);
  text += commands(command, words);
  text += sections(command.get_footer());
  if (command.get_parent()) {
    const std::string parent = words.substr(0, words.rfind(' '));
    text += ".SH \"SEE ALSO\"\n.BR " + escaped(page_name(parent)) + " (1)\n";
  }
  return text;
}

}  // namespace skein::command
