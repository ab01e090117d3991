#include "skein/launch/launch_plan.hpp"

#include <algorithm>
#include <array>
#include <charconv>

namespace skein::launch {
namespace {

bool is_here(const std::string& wanted, const std::string& host) {
  return wanted.empty() || wanted == host || wanted == "localhost";
}

std::string seconds(std::chrono::nanoseconds time) {
  std::array<char, 32> buffer{};
  const double count = std::chrono::duration<double>(time).count();
  const auto end = std::to_chars(buffer.data(), buffer.data() + buffer.size(), count).ptr;
  return std::string(buffer.data(), end) + " s";
}

std::string for_shell(const std::string& word) {
  const bool plain = !word.empty() && std::all_of(word.begin(), word.end(), [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
           std::string_view("_-./:=,+@%").find(c) != std::string_view::npos;
  });
  if (plain) return word;
  std::string text = "'";
  for (const char c : word) text += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return text + "'";
}

std::string restart_text(const profile::RestartRules& rules) {
  std::string text = "restart " + std::string(to_string(rules.policy));
  if (rules.policy == profile::RestartPolicy::Never) return text;
  return text + " after " + seconds(rules.delay) + ", doubling up to " + seconds(rules.max_delay) +
         ", given up after " + std::to_string(rules.max_restarts) + " in " + seconds(rules.window);
}

std::string end_text(const ChildPlan& child) {
  if (child.runs_mission) return "its end is the mission's, its exit code too";
  return child.required ? "its loss ends the mission" : "the mission goes on without it";
}

std::string to_text(const ChildPlan& child) {
  std::string command;
  for (const auto& [name, value] : child.environment)
    command += name + "=" + for_shell(value) + " ";
  for (const auto& word : child.argv) command += for_shell(word) + " ";
  if (!command.empty()) command.pop_back();
  return child.name + "\n  run:   " + command + "\n  ready: within " +
         seconds(child.rules.ready_timeout) + "\n  rules: " + restart_text(child.rules.restart) +
         "\n  stop:  SIGTERM, after " + seconds(child.rules.stop_timeout) +
         " SIGKILL\n  end:   " + end_text(child) + "\n";
}

}  // namespace

LaunchPlan make_launch_plan(const profile::MissionProfile& mission, const MakeArgv& make_argv,
                            const std::string& host) {
  LaunchPlan plan;
  plan.mission = mission.name;
  for (const auto& peer : mission.peers) {
    const bool here = is_here(peer.host, host);
    const auto add = [&](ChildPlan child) {
      if (here) {
        plan.children.push_back(std::move(child));
      } else {
        plan.elsewhere.push_back(child.name + " on " + peer.host);
      }
    };
    add({peer.name, make_argv(peer, nullptr), {}, peer.rules, peer.runs_mission, peer.required});
    for (const auto& csp : peer.csps) {
      if (csp.process != profile::CspProcess::Own) continue;
      add({peer.name + "/" + csp.name, make_argv(peer, &csp), {}, csp.rules, false, csp.required});
    }
  }
  return plan;
}

std::string to_text(const LaunchPlan& plan) {
  std::string text = "mission \"" + plan.mission + "\": " + std::to_string(plan.children.size()) +
                     " processes here, all started at once\n";
  for (const auto& child : plan.children) text += "\n" + to_text(child);
  if (!plan.elsewhere.empty()) text += "\nnot started here:\n";
  for (const auto& name : plan.elsewhere) text += "  " + name + "\n";
  return text;
}

}  // namespace skein::launch
