#include <poll.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <iostream>
#include <string>
#include <vector>

#include "command/print/interruption.hpp"
#include "command_line.hpp"
#include "core/printable.hpp"
#include "core/suggestion.hpp"
#include "core/system/whole_file.hpp"
#include "familiar_names.hpp"
#include "mission/process/address_space.hpp"
#include "mission/process/exit_codes.hpp"
#include "mission/xml/finding.hpp"
#include "skein/error.hpp"
#include "skein/log.hpp"

namespace skein::command {
namespace {

constexpr std::size_t kLongestError = 4096;
constexpr const char* kHowToStop =
    "there is no command 'stop': Ctrl-C in the launch's terminal ends a mission, or SIGINT or "
    "SIGTERM to the launcher, whose process `skein status PROFILE` tells";

void complain(const std::string& text) { std::fprintf(stderr, "skein: %s\n", text.c_str()); }

int refuse(const std::string& text) {
  complain(text);
  return launch::kUsageError;
}

/// The command that `words` begin with, and how many of them are its name.
const CLI::App& command_of(const CLI::App& app, const std::vector<std::string>& words,
                           std::size_t& length) {
  if (length < words.size()) {
    for (const CLI::App* command : app.get_subcommands({}))
      if (command->get_name() == words[length]) return command_of(*command, words, ++length);
  }
  return app;
}

std::vector<std::string> long_options_of(const CLI::App& command) {
  std::vector<std::string> names;
  for (const CLI::Option* option : command.get_options())
    for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
  return names;
}

/// The complaint about options that come first; empty if none does.
std::string misplaced_options(const CLI::App& app, const std::vector<std::string>& words) {
  if (words.empty() || !words[0].starts_with('-') || app.get_option_no_throw(words[0])) return {};
  const std::string nearest = suggestion(words[0], long_options_of(app));
  if (!nearest.empty()) return "there is no option '" + printable(words[0]) + "'" + nearest;
  std::string line = "skein", options;
  const auto is_command = [&](const std::string& word) {
    return std::ranges::any_of(shown_commands(app),
                               [&](const auto* command) { return command->get_name() == word; });
  };
  const auto command = std::ranges::find_if(words, is_command);
  line += " " + (command == words.end() ? "COMMAND" : *command);
  for (auto word = words.begin(); word != words.end(); ++word)
    if (word != command) line += " " + printable(*word);
  return "options follow the command: " + line;
}

/// The complaint about a command that is none; empty for a command, or an option in its place.
/// CLI11 would say that a command is missing.
std::string unknown_command(const CLI::App& app, const std::vector<std::string>& words) {
  std::size_t length = 0;
  const CLI::App& parent = command_of(app, words, length);
  if (length == words.size() || words[length].starts_with('-')) return {};
  if (parent.get_require_subcommand_min() == 0) return {};
  std::vector<std::string> known;
  for (const CLI::App* command : shown_commands(parent)) known.push_back(command->get_name());
  const std::string& word = words[length];
  if (length == 0 && word == "stop") return kHowToStop;
  if (length == 0 && word == "help") return "help is an option: skein --help, skein COMMAND --help";
  std::string familiar = familiar_name(words);
  if (!familiar.empty()) familiar = "; in Skein: skein " + familiar;
  return "there is no command '" + (length == 0 ? "" : parent.get_name() + " ") + printable(word) +
         "'" + (familiar.empty() ? suggestion(word, known) : familiar) + "; known are " +
         CLI::detail::join(known, ", ");
}

/// CLI11 would tell them in reversed order.
std::string unexpected(const std::vector<std::string>& words,
                       const std::vector<std::string>& options) {
  const auto has = [&](const char* option) { return std::ranges::count(options, option) > 0; };
  std::string text = "not expected:";
  for (const std::string& word : words) {
    text += " " + printable(word);
    if (word == "--once" && has("--count")) {
      text += " (--count 1 does that)";
    } else if (const std::string ours = familiar_option(word); has(ours.c_str())) {
      text += " (" + ours + " does that)";
    } else if (word == "-a" || word == "--all") {
      text += " (all is taken unless an option says otherwise)";
    } else if ((word == "--domain" || word == "-d") && has("--variable")) {
      text += " (the profile says it: <mission domain=\"...\">)";
    } else if (word.starts_with("--")) {
      text += suggestion(word.substr(0, word.find('=')), options);
    } else if (word.ends_with(".xml") && has("--profile")) {
      text += " (a mission is named by --profile " + printable(word) + ")";
    }
  }
  return text;
}

/// CLI11's text, with the nearest option if there is none of that name.
std::string text_of(const CLI::ParseError& error, const CLI::App& app,
                    const std::vector<std::string>& words) {
  std::size_t length = 0;
  const CLI::App& command = command_of(app, words, length);
  std::string name = app.get_name();
  for (std::size_t i = 0; i < length; ++i) name += " " + words[i];
  const std::string text = dynamic_cast<const CLI::ExtrasError*>(&error)
                               ? unexpected(app.remaining(true), long_options_of(command))
                               : printable(error.what(), kLongestError);
  return text + "; see `" + name + " --help`";
}

int run(CLI::App& app, int argc, char** argv, const int& result) {
  const std::vector<std::string> words(argv + std::min(argc, 1), argv + argc);
  try {
    if (const std::string text = misplaced_options(app, words); !text.empty()) return refuse(text);
    if (const std::string text = unknown_command(app, words); !text.empty()) return refuse(text);
    app.parse(argc, argv);
    return result;
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) return app.exit(error);
    return refuse(text_of(error, app, words));
  } catch (const profile::DescriptionError& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return launch::kConfigurationError;
  } catch (const InvalidArgument& error) {
    complain(printable(error.what(), kLongestError));
    return launch::kConfigurationError;
  } catch (const WriteFailed& error) {
    complain(printable(error.what(), kLongestError));
    return launch::kOutputLost;
  } catch (const Interrupted& interrupted) {
    complain(printable(interrupted.what(), kLongestError));
    return launch::kInterrupted + interrupted.signal();
  } catch (const Error& error) {
    complain(printable(error.what(), kLongestError));
    return launch::kStartFailed;
  } catch (const std::exception& error) {  // what the system or the standard library refused
    const std::string limit = launch::address_space_limit();
    complain(printable(error.what(), kLongestError) + (limit.empty() ? "" : "; " + limit));
    return launch::kStartFailed;
  }
}

/// Whether stdout is a pipe that nobody reads any more.
bool reader_has_gone() {
  pollfd output{STDOUT_FILENO, POLLOUT, 0};
  return ::poll(&output, 1, 0) == 1 && (output.revents & POLLERR) != 0;
}

/// As any program ends whose reader has gone. Threads of DDS vendors, which print too, block the
/// signal that would have ended it.
void end_by_sigpipe() {
  std::signal(SIGPIPE, SIG_DFL);
  sigset_t signals;
  sigemptyset(&signals);
  sigaddset(&signals, SIGPIPE);
  pthread_sigmask(SIG_UNBLOCK, &signals, nullptr);
  std::raise(SIGPIPE);
}

/// What was printed and did not arrive (a full disk, say) must not pass for success.
int with_output_checked(int code) {
  const bool failed_before = std::ferror(stdout) != 0;
  errno = 0;
  std::cout.flush();
  if (std::fflush(stdout) == 0 && !failed_before && std::cout.good()) return code;
  const int reason = failed_before ? 0 : errno;
  if (reader_has_gone()) end_by_sigpipe();
  complain(std::string("the output could not be written: ") +
           (reason == 0 ? "an earlier write failed" : std::strerror(reason)));
  return code == 0 ? launch::kOutputLost : code;
}

/// The kernel gives PID 1, which a container's first process is, no default actions. Without these
/// a command that handles no signals, or does not handle them yet, could only be killed.
void give_default_actions_to_pid_1() {
  if (::getpid() != 1) return;
  for (const int signal : {SIGHUP, SIGINT, SIGQUIT, SIGTERM}) {
    if (is_ignored(signal)) continue;
    std::signal(signal, [](int number) { ::_exit(launch::kInterrupted + number); });
  }
}

}  // namespace
}  // namespace skein::command

int main(int argc, char** argv) {
  skein::command::give_default_actions_to_pid_1();
  std::signal(SIGXFSZ, SIG_IGN);  // beyond `ulimit -f` a write fails, which is told in words
  skein::is_logged(skein::LogLevel::Error);  // tells of a SKEIN_LOG that is no level
  CLI::App app;
  int result = 0;
  skein::command::make_command_line(app, result);
  return skein::command::with_output_checked(skein::command::run(app, argc, argv, result));
}
