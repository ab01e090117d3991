#include "missions_elsewhere.hpp"

#include <algorithm>
#include <set>

#include "command/doctor/reading.hpp"

namespace skein::command {

std::string missions_elsewhere(std::uint32_t domain, const std::vector<std::uint32_t>& flying) {
  const std::set<std::uint32_t> domains(flying.begin(), flying.end());
  if (domains.empty() || domains.contains(domain)) return {};
  std::string list;
  for (const std::uint32_t each : domains)
    list += (list.empty() ? "" : ", ") + std::to_string(each);
  return "missions fly here on domain " + list;
}

std::string missions_elsewhere(std::uint32_t domain) {
  std::vector<std::uint32_t> flying;
  for (const doctor::Launcher& launcher : doctor::read_launchers({}))
    flying.push_back(launcher.domain);
  return missions_elsewhere(domain, flying);
}

bool mission_flies_on(std::uint32_t domain) {
  const auto launchers = doctor::read_launchers({});
  return std::ranges::count(launchers, domain, &doctor::Launcher::domain) > 0;
}

std::string missions_beside(std::uint32_t domain, const std::vector<doctor::Launcher>& launchers) {
  std::string list;
  for (const doctor::Launcher& launcher : launchers) {
    if (launcher.domain != domain) continue;
    const int pid = launcher.program.pid;
    list += (list.empty() ? "" : ", ") +
            (pid == 0 ? "another user's launcher" : "process " + std::to_string(pid));
  }
  if (list.empty()) return {};
  return "another mission flies on domain " + std::to_string(domain) + " (" + list +
         "), and the peers of both meet; if they are not meant to, give one of them another domain";
}

std::string missions_beside(std::uint32_t domain) {
  const bool alone = missions_beside(domain, doctor::read_launchers({})).empty();
  return alone ? "" : missions_beside(domain, doctor::read_launchers(doctor::owners_of_sockets()));
}

}  // namespace skein::command
