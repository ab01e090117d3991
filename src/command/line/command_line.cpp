#include "command_line.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <sstream>

#include "command/print/wrapped.hpp"
#include "core/printable.hpp"
#include "core/suggestion.hpp"
#include "dds/port/options_check.hpp"
#include "dds/port/vendor_names.hpp"
#include "help.hpp"
#include "mission/component/dictionary.hpp"
#include "mission/profile/mission_profile.hpp"
#include "skein/error.hpp"

namespace skein::command {
namespace {

std::string examples_text(const std::vector<Example>& examples) {
  std::string text = "Examples:\n";
  for (const Example& example : examples)
    text += "  " + example.line + "\n      " + example.purpose + "\n";
  return text;
}

}  // namespace

std::string exit_codes_text(const launch::CommandKind* kind) {
  constexpr std::size_t kTextColumn = 12;
  std::string text = "Exit codes:\n";
  std::string_view last;
  for (const launch::ExitCode& entry : launch::kExitCodes) {
    if (kind && entry.of && entry.of != kind) continue;
    std::string line = entry.code == last ? "" : "  " + std::string(entry.code);
    line.resize(kTextColumn, ' ');
    std::string meaning(entry.meaning);
    if (!kind && entry.of) meaning = std::string(entry.of->name) + ": " + meaning;
    text += line + wrapped(meaning, 80, kTextColumn) + "\n";
    last = entry.code;
  }
  return text;
}

void add_exit_codes(CLI::App& command, const launch::CommandKind& kind) {
  command.footer(command.get_footer() + "\n" + exit_codes_text(&kind));
}

void make_command_line(CLI::App& app, int& result) {
  app.name("skein");
  app.description("Skein: autonomous entities on DDS");
  app.formatter(std::make_shared<HelpFormatter>());
  app.set_help_flag("-h,--help", "Print this help and exit");
  app.require_subcommand(1);
  app.set_version_flag("--version", SKEIN_VERSION, "Print the version and exit");
  const auto add = [&](const char* group, const Subcommands& commands) {
    app.group(group);  // which subcommands take from their parent
    for (const AddCommand each : commands) each(app, result);
  };
  add("Missions", mission_commands);
  for (const Subcommands* commands : {&inspection_commands, &topic_commands, &recording_commands})
    add("Looking at a domain", *commands);
  add("Measuring", measuring_commands);
  add("For the shell", shell_commands);
  app.footer(exit_codes_text() + "\n" +
             examples_text({{"skein check mission.xml && skein launch mission.xml",
                             "Fly a mission if nothing is missing"},
                            {"skein services --profile mission.xml",
                             "Who provides what in a mission that flies"},
                            {"skein services --help", "Everything about one command"}}));
}

CLI::App& add_command(CLI::App& parent, const std::string& name, const std::string& description,
                      const std::vector<Example>& examples) {
  CLI::App& command = *parent.add_subcommand(name, description);
  command.footer(examples_text(examples));
  return command;
}

std::string one_of(const std::vector<std::string>& words) { return CLI::detail::join(words, "|"); }

void add_onlooker(CLI::App& command, Onlooker& onlooker) {
  command.add_option("--vendor", onlooker.vendor, "DDS vendor by which it joins the domain")
      ->type_name(one_of(dds::networked_vendors()))
      ->check(known_vendor())
      ->capture_default_str();
  auto* domain = command
                     .add_option("--domain", onlooker.domain,
                                 "DDS domain of the mission; default: SKEIN_DOMAIN of the "
                                 "environment, or 0")
                     ->type_name("NUMBER")
                     ->check(domain_number());
  auto* interface =
      command.add_option("--interface", onlooker.interface, "Network interface; default: loopback")
          ->type_name(kInterface)
          ->check(interface_of_this_host());
  command
      .add_option("--peers", onlooker.peers,
                  "Hosts to ask for peers, with commas between them; default: this one")
      ->type_name("HOSTS")
      ->delimiter(',')
      ->needs(interface);
  command
      .add_flag("--multicast", onlooker.multicast,
                "Find peers by multicast; default: ask hosts one by one")
      ->needs(interface);
  auto* profile =
      command
          .add_option("--profile", onlooker.profile,
                      "Mission profile: domain and network are those of its peers on this host; "
                      "default: the other options'")
          ->type_name(kFile)
          ->excludes(domain)
          ->excludes(interface);
  command
      .add_option("--host", onlooker.host,
                  "Which host of the profile this is; default: as names tell")
      ->type_name("NAME")
      ->needs(profile);
  add_variables(command, onlooker.variables)->needs(profile);
}

CLI::Option* add_variables(CLI::App& command, std::vector<std::string>& variables) {
  return command
      .add_option("--variable", variables,
                  "A value for a variable of the profile, or @FILE for the text of a file; may be "
                  "given several times; default: as the profile says")
      ->type_name("NAME=VALUE")
      ->check(of_form([](const std::string& text) { profile::parse_variables({text}); }))
      ->allow_extra_args(false);
}

CLI::Option* add_json(CLI::App& command, bool& json, const std::string& form) {
  return command.add_flag("--json", json,
                          "Print JSON, for programs" + (form.empty() ? "" : ": " + form));
}

void add_wait(CLI::App& command, double& seconds) {
  add_duration(command, "--wait", seconds, "How long to listen before it prints", Zero::Taken)
      ->default_str(default_duration(seconds));
}

CLI::Option* add_duration(CLI::App& command, const std::string& name, double& seconds,
                          const std::string& what, Zero zero) {
  const auto refusal = [zero](std::string& text) -> std::string {
    try {
      if (profile::parse_seconds(text) > 0 || zero == Zero::Taken) return {};
      return "must be more than 0";
    } catch (const InvalidArgument& error) {
      return error.what();
    }
  };
  return command
      .add_option_function<std::string>(
          name, [&seconds](const std::string& text) { seconds = profile::parse_seconds(text); },
          what)
      ->type_name(kDuration)
      ->check(CLI::Validator(refusal, ""));
}

CLI::Validator of_form(const std::function<void(const std::string& text)>& parse) {
  return CLI::Validator(
      [parse](std::string& text) -> std::string {
        try {
          parse(text);
          return {};
        } catch (const InvalidArgument& error) {
          return error.what();
        }
      },
      "");
}

CLI::Validator above_zero() {
  return CLI::Validator(
      [](std::string& text) -> std::string {
        double number = 0;
        if (!CLI::detail::lexical_cast(text, number)) return "is no number: " + text;
        return number > 0 && std::isfinite(number) ? "" : "must be more than 0";
      },
      "");
}

CLI::Validator known_word(const std::vector<std::string>& words) {
  return CLI::Validator(
      [words](std::string& text) -> std::string {
        if (std::ranges::count(words, text) > 0) return {};
        return "'" + printable(text) + "' is none of " + CLI::detail::join(words, ", ") +
               suggestion(text, words);
      },
      "");
}

CLI::Validator known_vendor() { return known_word(dds::networked_vendors()); }

CLI::Validator interface_of_this_host() {
  return CLI::Validator(
      [](std::string& text) -> std::string {
        try {
          dds::Network network;
          network.interfaces = {text};
          dds::interface_addresses(network);
          return {};
        } catch (const InvalidArgument& error) {
          return error.what();
        } catch (const Unavailable&) {
          return {};  // it may come until it is used, which tells it otherwise
        }
      },
      "");
}

CLI::Validator domain_number() {
  return CLI::Validator(
      [](std::string& text) -> std::string {
        std::uint32_t number = 0;
        const char* const end = text.data() + text.size();
        const auto [stop, error] = std::from_chars(text.data(), end, number);
        if (error == std::errc() && stop == end && number <= dds::kMaxDomain) return {};
        return "'" + text + "' is no number from 0 to " + std::to_string(dds::kMaxDomain);
      },
      "");
}

std::string default_duration(double seconds) {
  std::ostringstream text;
  text << seconds << 's';
  return text.str();
}

std::vector<const CLI::App*> shown_commands(const CLI::App& app) {
  return app.get_subcommands([](const CLI::App* command) { return !command->get_group().empty(); });
}

void for_each_command(const CLI::App& app,
                      const std::function<void(const CLI::App&, const std::string&)>& visit) {
  const std::function<void(const CLI::App&, const std::string&)> descend =
      [&](const CLI::App& command, const std::string& words) {
        visit(command, words);
        for (const CLI::App* child : shown_commands(command))
          descend(*child, words + " " + child->get_name());
      };
  descend(app, app.get_name());
}

}  // namespace skein::command
