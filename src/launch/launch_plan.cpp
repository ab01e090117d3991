#include "launch/launch_plan.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <map>

#include "core/host.hpp"
#include "core/suggestion.hpp"

namespace skein::launch {
namespace {

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

bool is_here(const std::string& wanted, const std::string& self) {
  if (wanted.empty() || wanted == "localhost") return true;
  return self.empty() ? is_this_host(wanted) : wanted == self;
}

std::vector<std::string> hosts_of(const profile::MissionProfile& mission) {
  std::vector<std::string> hosts;
  for (const auto& peer : mission.peers) {
    const bool named = !peer.host.empty() && peer.host != "localhost";
    if (named && std::find(hosts.begin(), hosts.end(), peer.host) == hosts.end())
      hosts.push_back(peer.host);
  }
  return hosts;
}

std::string nobody_here(const profile::MissionProfile& mission, const std::string& host) {
  std::string self = "'" + host + "'";
  if (host.empty()) {
    self = "'" + name_of_this_host() + "' with " + to_text(interfaces_of_this_host());
  }
  const auto hosts = hosts_of(mission);
  std::string known;
  for (const std::string& name : hosts) {
    std::string names;
    for (const auto& peer : mission.peers) {
      if (peer.host == name) names += (names.empty() ? "" : ", ") + peer.name;
    }
    known += (known.empty() ? "" : "; ") + name + " (" + names + ")";
  }
  return "no peer of mission '" + mission.name + "' is of this host, which is " + self +
         (host.empty() ? "" : suggestion(host, hosts)) + "; its hosts are " + known +
         "; say by --host which of them this is";
}

LaunchPlan make_launch_plan(const profile::MissionProfile& mission, const MakeArgv& make_argv,
                            const std::string& host) {
  LaunchPlan plan;
  plan.mission = mission.name;
  std::map<std::string, bool> known{{"", true}};  // whether a host is here: names are asked once
  for (const std::string& name : hosts_of(mission)) known[name] = is_here(name, host);
  for (const auto& peer : mission.peers) {
    const bool here = peer.host == "localhost" || known[peer.host];
    if (peer.runs_mission && !here) plan.mission_elsewhere = peer.name + " on " + peer.host;
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
