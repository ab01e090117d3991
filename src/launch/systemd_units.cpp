#include "systemd_units.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdio>

#include "core/printable.hpp"
#include "launch/exit_codes.hpp"
#include "skein/error.hpp"

namespace skein::launch {
namespace {

constexpr std::size_t kLongestUnitName = 255;

bool is_letter_or_digit(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9');
}

std::string hexadecimal(char c) {
  std::array<char, 8> text{};
  std::snprintf(text.data(), text.size(), "\\x%02x", static_cast<unsigned char>(c));
  return text.data();
}

std::string unit_name(const std::string& stem, const char* kind) {
  std::string name = "skein-" + stem + kind;
  if (name.size() <= kLongestUnitName) return name;
  throw InvalidArgument("a unit's name has at most " + std::to_string(kLongestUnitName) +
                        " characters, which '" + printable(name) +
                        "' exceeds; give the mission or the peer a shorter name");
}

std::string service_of(const LaunchPlan& plan, const std::string& process) {
  return unit_name(unit_name_part(plan.mission) + "-" + unit_name_part(process), ".service");
}

std::string target_of(const LaunchPlan& plan) {
  return unit_name(unit_name_part(plan.mission), ".target");
}

std::string end_of(const LaunchPlan& plan) {
  return unit_name(unit_name_part(plan.mission) + ".over", ".target");
}

bool is_needed(const ChildPlan& child) {
  return child.rules.on_loss == profile::LossPolicy::Abort || child.runs_mission;
}

/// Where its processes are started; a name of a folder, in which a unit's escapes have no place.
std::string folder_of(const LaunchPlan& plan) {
  std::string name = plan.mission;
  std::replace_if(
      name.begin(), name.end(), [](char c) { return !is_letter_or_digit(c) && c != '-'; }, '_');
  return "skein/" + name;
}

/// A text for people, in which `%` would be read as a specifier.
std::string description(const std::string& text) {
  std::string escaped;
  for (const char c : printable(text)) escaped += c == '%' ? std::string("%%") : std::string(1, c);
  return escaped;
}

std::string systemd_seconds(std::chrono::nanoseconds time) {
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%.6f",
                std::chrono::duration<double>(
                    std::max<std::chrono::nanoseconds>(time, std::chrono::microseconds(1)))
                    .count());
  return text.data();
}

/// systemd takes the program's path as it is, without the escapes of the words after it.
void demand_plain_program(const ChildPlan& child) {
  if (child.argv.empty()) throw InvalidArgument(child.name + " has no command line");
  const std::string& program = child.argv.front();
  const bool plain = std::none_of(program.begin(), program.end(), [](char c) {
    return static_cast<unsigned char>(c) < ' ' ||
           std::string_view("\"'\\\x7f").find(c) != std::string_view::npos;
  });
  if (plain && !program.empty() &&
      std::string_view("@-:+!").find(program.front()) == std::string_view::npos)
    return;
  throw InvalidArgument("systemd cannot start '" + printable(program) + "' for " + child.name +
                        ": a program's path must be without quotes, backslashes and control "
                        "characters there, and not begin with one of @-:+!");
}

void demand_plain_value(const ChildPlan& child, const std::string& name, const std::string& value) {
  const bool plain = std::none_of(value.begin(), value.end(), [](char c) {
    return (static_cast<unsigned char>(c) < ' ' && c != '\t' && c != '\n') || c == '\x7f';
  });
  if (plain) return;
  throw InvalidArgument("systemd takes no control characters in the environment, which '" + name +
                        "' of " + child.name + " has");
}

std::string restart_lines(const profile::RestartRules& rules) {
  if (rules.policy == profile::RestartPolicy::Never) return "Restart=no\n";
  return "Restart=" + std::string(to_string(rules.policy)) +
         "\n# The wait does not grow with each restart, as it does in Skein.\nRestartSec=" +
         systemd_seconds(rules.delay) +
         "\n# systemd takes these for an orderly end; Skein does not.\n"
         "RestartForceExitStatus=SIGHUP SIGINT SIGPIPE SIGTERM\n"
         "RestartPreventExitStatus=" +
         std::to_string(kConfigurationError) + "\n";
}

/// After the providers of earlier layers, as the launcher starts it; with the one provider that a
/// service has, if it is the only one.
std::string order_text(const LaunchPlan& plan, const ChildPlan& child) {
  std::string text;
  for (const Prerequisite& prerequisite : child.after) {
    for (const ChildPlan& other : plan.children) {
      const auto& providers = prerequisite.providers;
      const bool provides =
          std::find(providers.begin(), providers.end(), other.name) != providers.end();
      if (!provides || other.layer >= child.layer) continue;
      const std::string service = service_of(plan, other.name) + "\n";
      text += "After=" + service + (providers.size() == 1 ? "Requires=" : "Wants=") + service;
    }
  }
  return text;
}

std::string service_text(const LaunchPlan& plan, const ChildPlan& child) {
  demand_plain_program(child);
  const auto& restart = child.rules.restart;
  std::string text = "[Unit]\nDescription=" + description(plan.mission + ": " + child.name) +
                     "\nPartOf=" + target_of(plan) + "\n";
  text += order_text(plan, child);
  if (is_needed(child)) text += "OnFailure=" + end_of(plan) + "\n";
  if (child.runs_mission) text += "OnSuccess=" + end_of(plan) + "\n";
  if (restart.policy != profile::RestartPolicy::Never) {
    text += "StartLimitIntervalSec=" + systemd_seconds(restart.window) +
            "\nStartLimitBurst=" + std::to_string(restart.max_restarts + 1) + "\n";
  }
  text +=
      std::string("\n[Service]\nType=") + (child.tells_ready ? "notify" : "exec") + "\nExecStart=:";
  for (std::size_t i = 0; i < child.argv.size(); ++i)
    text += (i == 0 ? "" : " ") + unit_word(child.argv[i]);
  text += "\n";
  for (const auto& [name, value] : child.environment) {
    demand_plain_value(child, name, value);
    text += "Environment=" + unit_word(name + "=" + value) + "\n";
  }
  text += "StateDirectory=" + folder_of(plan) + "\nWorkingDirectory=%S/" + folder_of(plan) + "\n" +
          restart_lines(restart) + "TimeoutStartSec=" + systemd_seconds(child.rules.ready_timeout) +
          "\nTimeoutStopSec=" + systemd_seconds(child.rules.stop_timeout) +
          "\nKillMode=control-group\n";
  if (child.rules.progress_timeout > child.rules.progress_timeout.zero())
    text += "WatchdogSec=" + systemd_seconds(child.rules.progress_timeout) + "\n";
  return text;
}

std::string target_text(const LaunchPlan& plan) {
  std::string text = "[Unit]\nDescription=" + description("Mission " + plan.mission) + "\n";
  for (const ChildPlan& child : plan.children) {
    const std::string service = service_of(plan, child.name) + "\n";
    text += (is_needed(child) ? "Requires=" : "Wants=") + service + "After=" + service;
  }
  return text + "\n[Install]\nWantedBy=default.target\n";
}

/// Reached when the mission is over: it ends what is left of it.
std::string end_lines(const LaunchPlan& plan) {
  return "[Unit]\nDescription=" + description("End of mission " + plan.mission) +
         "\nConflicts=" + target_of(plan) + "\n";
}

}  // namespace

std::string unit_word(const std::string& word) {
  std::string text = "\"";
  for (const char c : word) {
    if (c == '%') {
      text += "%%";
    } else if (c == '"' || c == '\\') {
      text += std::string("\\") + c;
    } else if (static_cast<unsigned char>(c) < ' ' || static_cast<unsigned char>(c) >= 0x7f) {
      text += hexadecimal(c);
    } else {
      text += c;
    }
  }
  return text + "\"";
}

std::string unit_name_part(const std::string& text) {
  std::string part;
  for (const char c : text) {
    if (c == '/') {
      part += '-';
    } else {
      part += is_letter_or_digit(c) || c == '_' ? std::string(1, c) : hexadecimal(c);
    }
  }
  return part;
}

std::map<std::string, std::string> systemd_units(const LaunchPlan& plan) {
  const std::string beginning =
      "# The mission '" + printable(plan.mission) + "', by `skein script --systemd`.\n";
  std::map<std::string, std::string> units;
  units[target_of(plan)] = beginning + target_text(plan);
  units[end_of(plan)] = beginning + end_lines(plan);
  for (const ChildPlan& child : plan.children)
    units[service_of(plan, child.name)] = beginning + service_text(plan, child);
  return units;
}

}  // namespace skein::launch
