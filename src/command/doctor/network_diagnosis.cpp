#include <algorithm>
#include <map>
#include <set>
#include <sstream>

#include "core/printable.hpp"
#include "core/suggestion.hpp"
#include "dds/port/options_check.hpp"
#include "diagnosis.hpp"

namespace skein::command::doctor {
namespace {

/// So many ports a domain has of its own.
constexpr std::uint32_t kPortsOfDomain = 250;

const Interface* find_interface(const Facts& facts, const std::string& wanted) {
  for (const Interface& interface : facts.interfaces) {
    if (interface.name == wanted || std::ranges::count(interface.addresses, wanted) > 0)
      return &interface;
  }
  return nullptr;
}

std::string to_text(const Program& program) {
  if (program.pid == 0) return "another user's process";
  return program.name + " (pid " + std::to_string(program.pid) + ")";
}

std::string joined(const std::set<std::string>& words) {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "" : ", ") + word;
  return text;
}

std::string mebibytes(std::uint64_t bytes) {
  return bytes >= 1 << 20 ? std::to_string(bytes >> 20) + " MiB"
                          : std::to_string(bytes >> 10) + " KiB";
}

Symptom loopback(const Facts& facts) {
  const Interface* found = find_interface(facts, "127.0.0.1");
  if (found && found->up) {
    return {Severity::Fine, "loopback", found->name + " is up, with 127.0.0.1", "", ""};
  }
  if (const auto down = find_obstacle(facts.interfaces, ""))
    return {Severity::Error, "loopback", down->problem, "lo is not up", down->remedy};
  const Interface* named = find_interface(facts, "lo");
  return {Severity::Error, "loopback",
          "no interface has 127.0.0.1: the peers of this host cannot speak to each other",
          named ? "lo has no such address" : "there is no interface lo",
          "sudo ip address add 127.0.0.1/8 dev lo && sudo ip link set lo up"};
}

Symptom missing_interface(const Facts& facts, const std::string& wanted) {
  std::vector<std::string> names;
  std::set<std::string> usable;
  for (const Interface& interface : facts.interfaces) {
    names.push_back(interface.name);
    if (interface.up && !interface.addresses.empty())
      usable.insert(interface.name + " (" + interface.addresses.front() + ")");
  }
  return {Severity::Error, "interface",
          "there is no interface '" + wanted + "'" + suggestion(wanted, names),
          "those that are up and have an address: " + joined(usable),
          "name one of these by --interface, or in the profile"};
}

Symptom interface(const std::string& wanted, bool by_multicast, const Facts& facts) {
  const Interface* found = find_interface(facts, wanted);
  if (!found) return missing_interface(facts, wanted);
  const std::string& name = found->name;
  if (const auto down = find_obstacle(facts.interfaces, wanted))
    return {Severity::Error, "interface", down->problem,
            found->up ? "ip -4 address show dev " + name : "its flags lack UP", down->remedy};
  if (by_multicast && !found->multicast) {
    return {Severity::Error, "interface",
            "the interface " + name + " takes no multicast: peers do not find each other by it",
            "its flags lack MULTICAST",
            "sudo ip link set " + name +
                " multicast on; or name the hosts instead: peers=\"...\" "
                "in the profile, --peers of commands"};
  }
  if (const auto cut = find_obstacle(facts.interfaces, wanted, Carrier::Needed))
    return {Severity::Warning, "interface", cut->problem + "; no peer on Fast DDS starts on it",
            "its flags lack RUNNING", cut->remedy};
  return {Severity::Fine, "interface",
          name + " is up, with " + found->addresses.front() +
              (found->multicast ? "" : "; it takes no multicast, so that hosts must be named"),
          "", ""};
}

Symptom buffers(const Facts& facts) {
  constexpr std::uint64_t kWanted = dds::kSocketBuffer;
  if (facts.buffer >= kWanted)
    return {Severity::Fine, "buffers", "UDP buffers may hold " + mebibytes(facts.buffer), "", ""};
  const std::string size = std::to_string(kWanted);
  return {Severity::Warning, "buffers",
          "UDP buffers may hold " + mebibytes(facts.buffer) + " of the " + mebibytes(kWanted) +
              " that Skein asks for: bursts and large messages lose packets, and take longer",
          "sysctl net.core.rmem_max net.core.wmem_max",
          "sudo sysctl -w net.core.rmem_max=" + size + " net.core.wmem_max=" + size +
              "; for good, write both into /etc/sysctl.d/60-skein.conf"};
}

bool within(const PortRange& ports, std::uint16_t port) {
  return port >= ports.first && port <= ports.last;
}

void lost_packets(const Facts& facts, const PortRange& ports, Symptoms& symptoms) {
  for (const UdpSocket& socket : facts.sockets) {
    if (!within(ports, socket.port) || socket.dropped == 0) continue;
    symptoms.push_back({Severity::Warning, "lost packets",
                        to_text(socket.owner) + " has lost packets, because its buffer was full",
                        std::to_string(socket.dropped) + " dropped at UDP port " +
                            std::to_string(socket.port) + " (/proc/net/udp)",
                        "give it larger buffers (see buffers) or more time on a processor"});
  }
}

void stopped_programs(const Facts& facts, const PortRange& ports, Symptoms& symptoms) {
  std::set<int> told;
  for (const UdpSocket& socket : facts.sockets) {
    const Program& owner = socket.owner;
    if (!within(ports, socket.port) || !owner.stopped || !told.insert(owner.pid).second) continue;
    const std::string pid = std::to_string(owner.pid);
    symptoms.push_back({Severity::Warning, "stopped",
                        to_text(owner) + " is stopped, and answers nobody",
                        "it has UDP port " + std::to_string(socket.port) +
                            ", and was started as `" + printable(owner.command) + "`",
                        "let it go on: kill -CONT " + pid + "; or end it: kill -KILL " + pid});
  }
}

Symptom free_ports(const Purpose& purpose, const Facts& facts) {
  const PortRange ports = ports_of(purpose.domain);
  const std::string domain = "domain " + std::to_string(purpose.domain);
  std::set<std::string> owners;
  std::set<std::uint32_t> taken;
  for (const UdpSocket& socket : facts.sockets) {
    if (!within(ports, socket.port)) continue;
    owners.insert(to_text(socket.owner));
    const std::uint32_t offset = socket.port - ports.first;
    if (offset >= dds::kDiscoveryOffset) taken.insert((offset - dds::kDiscoveryOffset) / 2);
  }
  if (owners.empty()) return {Severity::Fine, "domain", "nobody speaks on " + domain, "", ""};
  const std::uint32_t places = (ports.last - ports.first + 1 - dds::kDiscoveryOffset) / 2;
  const std::string range =
      "UDP ports " + std::to_string(ports.first) + " to " + std::to_string(ports.last);
  const std::string evidence = "bound in " + range + ": " + joined(owners);
  if (taken.size() >= places) {
    return {Severity::Error, "domain", "all ports of " + domain + " are taken", evidence,
            "choose another domain, or end some of these"};
  }
  const bool flies = std::ranges::any_of(
      facts.launchers, [&](const Launcher& launcher) { return launcher.domain == purpose.domain; });
  if (purpose.mission.empty() || flies) {
    return {Severity::Note, "domain",
            std::to_string(owners.size()) +
                (owners.size() == 1 ? " program speaks" : " programs speak") + " on " + domain,
            evidence, ""};
  }
  return {Severity::Warning, "domain",
          "others speak on " + domain + ", where the mission '" + purpose.mission + "' is to fly",
          evidence, "if they are not meant to meet, give the mission another domain"};
}

void two_missions(const Purpose& purpose, const Facts& facts, Symptoms& symptoms) {
  std::map<std::uint32_t, std::set<std::string>> by_domain;
  for (const Launcher& launcher : facts.launchers)
    by_domain[launcher.domain].insert(to_text(launcher.program));
  for (const auto& [domain, launchers] : by_domain) {
    if (launchers.size() < 2) continue;
    symptoms.push_back({Severity::Warning, "missions",
                        std::to_string(launchers.size()) + " missions fly on domain " +
                            std::to_string(domain) + ": their peers meet each other",
                        "skein launch: " + joined(launchers),
                        "give each a domain of its own: domain=\"...\" in its profile"});
  }
  const auto here = by_domain.find(purpose.domain);
  if (here != by_domain.end() && here->second.size() == 1) {
    symptoms.push_back({Severity::Note, "missions",
                        "a mission flies on domain " + std::to_string(purpose.domain),
                        "skein launch: " + joined(here->second), ""});
  }
}

/// Whether a rule drops our packets depends on the rules before it, which are not read.
Symptom firewall(const Purpose& purpose, const Facts& facts) {
  constexpr const char* kAbout = "firewall";
  if (!facts.firewall) {
    return {Severity::Note, kAbout, "the firewall's rules cannot be read",
            "nft list ruleset needs root, and the package nftables",
            "install nftables, then run `sudo skein doctor`"};
  }
  std::istringstream lines(*facts.firewall);
  for (std::string line; std::getline(lines, line);) {
    if (line.find("drop") == std::string::npos && line.find("reject") == std::string::npos)
      continue;
    const PortRange ports = ports_of(purpose.domain);
    return {Severity::Note, kAbout, "a firewall is active, and drops packets",
            line.substr(line.find_first_not_of(" \t")),
            "see by `sudo nft list ruleset` whether it accepts UDP ports " +
                std::to_string(ports.first) + "-" + std::to_string(ports.last) +
                " on lo and on the interfaces of the mission"};
  }
  return {Severity::Fine, kAbout, "no rule of nftables drops packets", "", ""};
}

}  // namespace

PortRange ports_of(std::uint32_t domain) {
  const std::uint32_t first = dds::domain_port(domain);
  return {static_cast<std::uint16_t>(first),
          static_cast<std::uint16_t>(std::min<std::uint32_t>(first + kPortsOfDomain - 1, 65535))};
}

Symptoms diagnose_network(const Purpose& purpose, const Facts& facts) {
  Symptoms symptoms{loopback(facts)};
  for (const std::string& wanted : purpose.interfaces)
    symptoms.push_back(interface(wanted, purpose.multicast, facts));
  symptoms.push_back(buffers(facts));
  lost_packets(facts, ports_of(purpose.domain), symptoms);
  stopped_programs(facts, ports_of(purpose.domain), symptoms);
  symptoms.push_back(free_ports(purpose, facts));
  two_missions(purpose, facts, symptoms);
  symptoms.push_back(firewall(purpose, facts));
  return symptoms;
}

}  // namespace skein::command::doctor
