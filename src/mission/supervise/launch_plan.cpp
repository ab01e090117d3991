#include "mission/supervise/launch_plan.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <map>
#include <set>

#include "core/suggestion.hpp"
#include "core/system/host.hpp"
#include "mission/supervise/child_state.hpp"
#include "shell_word.hpp"
#include "skein/error.hpp"

namespace skein::launch {
namespace {

std::string seconds(std::chrono::nanoseconds time) {
  std::array<char, 32> buffer{};
  const double count = std::chrono::duration<double>(time).count();
  const auto end = std::to_chars(buffer.data(), buffer.data() + buffer.size(), count).ptr;
  return std::string(buffer.data(), end) + " s";
}

std::string restart_text(const profile::RestartRules& rules) {
  std::string text = "restart " + std::string(to_string(rules.policy));
  if (rules.policy == profile::RestartPolicy::Never) return text;
  return text + " after " + seconds(rules.delay) + ", doubling up to " + seconds(rules.max_delay) +
         ", given up after " + std::to_string(rules.max_restarts) + " in " + seconds(rules.window);
}

std::string end_text(const ChildPlan& child) {
  if (child.runs_mission) return "its end is the mission's, its exit code too";
  switch (child.rules.on_loss) {
    case profile::LossPolicy::Abort:
      return "its loss ends the mission";
    case profile::LossPolicy::Degrade:
      return "without it the mission goes on, degraded";
    case profile::LossPolicy::Continue:
      return "the mission goes on without it";
  }
  return "";
}

std::string after_text(const ChildPlan& child) {
  std::string text;
  for (const Prerequisite& prerequisite : child.after) {
    text += (text.empty() ? "" : "; ") + prerequisite.interface + " of ";
    for (std::size_t i = 0; i < prerequisite.providers.size(); ++i)
      text += (i == 0 ? "" : " or ") + prerequisite.providers[i];
  }
  return text.empty() ? "" : "  after: " + text + "\n";
}

std::string alive_text(const profile::ProcessRules& rules) {
  if (rules.progress_timeout == rules.progress_timeout.zero()) return "";
  return "  alive: killed after " + seconds(rules.progress_timeout) + " without progress\n";
}

std::string stop_text(std::chrono::nanoseconds timeout) {
  return "SIGINT, after " + seconds(time_to_terminate(timeout)) + " SIGTERM, after " +
         seconds(timeout) + " SIGKILL";
}

std::string to_text(const ChildPlan& child) {
  const std::string ready =
      child.tells_ready ? "within " + seconds(child.rules.ready_timeout) : "as soon as it runs";
  return child.name + "\n  run:   " + shell_command(child) + "\n" + after_text(child) +
         "  ready: " + ready + "\n" + alive_text(child.rules) +
         "  rules: " + restart_text(child.rules.restart) +
         "\n  stop:  " + stop_text(child.rules.stop_timeout) + "\n  end:   " + end_text(child) +
         "\n";
}

std::size_t count_layers(const LaunchPlan& plan) {
  std::set<std::size_t> layers;
  for (const ChildPlan& child : plan.children) layers.insert(child.layer);
  return layers.size();
}

/// With taskset(1), a process has its CPUs before its first instruction, whatever its program.
std::vector<std::string> on_cpus(const std::vector<unsigned>& cpus, std::vector<std::string> argv) {
  if (cpus.empty()) return argv;
  std::string list;
  for (const unsigned cpu : cpus) list += (list.empty() ? "" : ",") + std::to_string(cpu);
  argv.insert(argv.begin(), {"taskset", "--cpu-list", list});
  return argv;
}

std::vector<std::string> argv_of(const profile::PeerProfile& peer, const profile::CspProfile* csp,
                                 const MakeArgv& make_argv) {
  const auto& start = csp ? csp->start : peer.start;
  std::vector<std::string> argv{start.program};
  if (start.program.empty()) {
    argv = make_argv(peer, csp);
    if (!start.arguments.empty()) argv.emplace_back("--");
  }
  argv.insert(argv.end(), start.arguments.begin(), start.arguments.end());
  return on_cpus(start.cpus, std::move(argv));
}

void demand_known(const std::vector<std::string>& only, const profile::MissionProfile& mission) {
  std::vector<std::string> known;
  for (const auto& peer : mission.peers) {
    known.push_back(peer.name);
    const bool fresh = std::find(known.begin(), known.end(), peer.group) == known.end();
    if (!peer.group.empty() && fresh) known.push_back(peer.group);
  }
  for (const std::string& name : only) {
    if (std::find(known.begin(), known.end(), name) != known.end()) continue;
    std::string list;
    for (const std::string& one : known) list += (list.empty() ? "" : ", ") + one;
    throw InvalidArgument("mission '" + mission.name + "' has no peer and no group '" + name + "'" +
                          suggestion(name, known) + "; it has " + list);
  }
}

}  // namespace

bool is_chosen(const profile::PeerProfile& peer, const std::vector<std::string>& only) {
  return only.empty() || std::any_of(only.begin(), only.end(), [&](const std::string& name) {
           return name == peer.name || name == peer.group;
         });
}

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
                            const std::string& host, const std::vector<std::string>& only) {
  demand_known(only, mission);
  LaunchPlan plan;
  plan.mission = mission.name;
  plan.domain = mission.domain;
  std::map<std::string, bool> known{{"", true}};  // whether a host is here: names are asked once
  for (const std::string& name : hosts_of(mission)) known[name] = is_here(name, host);
  known["localhost"] = true;
  std::vector<bool> starts_here;
  for (const auto& peer : mission.peers)
    starts_here.push_back(known[peer.host] && is_chosen(peer, only));
  const StartOrder order(mission, starts_here);
  for (std::size_t i = 0; i < mission.peers.size(); ++i) {
    const auto& peer = mission.peers[i];
    const std::string why_not = starts_here[i]      ? ""
                                : !known[peer.host] ? " on " + peer.host
                                                    : kLeftOut;
    if (peer.runs_mission && !why_not.empty()) plan.mission_elsewhere = peer.name + why_not;
    const auto add = [&](ChildPlan child) {
      child.system = peer.system;
      if (why_not.empty()) {
        // Who waits for nothing is started at once, whatever its peer waits for.
        child.layer = child.after.empty() ? 0 : order.layer(i);
        plan.children.push_back(std::move(child));
      } else {
        plan.elsewhere.push_back(child.name + why_not);
      }
    };
    add({peer.name, argv_of(peer, nullptr, make_argv), peer.start.environment, peer.rules,
         peer.runs_mission, peer.start.tells_ready, 0, order.prerequisites(i)});
    for (const auto& csp : peer.csps) {
      if (csp.process != profile::CspProcess::Own) continue;
      add({peer.name + "/" + csp.name, argv_of(peer, &csp, make_argv), csp.start.environment,
           csp.rules, false, csp.start.tells_ready, 0, order.prerequisites(i, &csp)});
    }
  }
  return plan;
}

std::string to_text(const LaunchPlan& plan) {
  const std::size_t layers = count_layers(plan);
  std::string text =
      "mission \"" + plan.mission + "\": " + std::to_string(plan.children.size()) +
      " processes here, " +
      (layers > 1 ? "started in " + std::to_string(layers) + " layers\n" : "all started at once\n");
  std::map<std::size_t, std::string> texts;
  for (const auto& child : plan.children) texts[child.layer] += "\n" + to_text(child);
  for (const auto& [layer, children] : texts)
    text += (layers > 1 ? "\nlayer " + std::to_string(layer + 1) + "\n" : "") + children;
  if (!plan.elsewhere.empty()) text += "\nnot started here:\n";
  for (const auto& name : plan.elsewhere) text += "  " + name + "\n";
  return text;
}

}  // namespace skein::launch
