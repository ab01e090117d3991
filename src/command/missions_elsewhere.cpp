#include "missions_elsewhere.hpp"

#include <set>

#include "doctor/reading.hpp"

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

}  // namespace skein::command
