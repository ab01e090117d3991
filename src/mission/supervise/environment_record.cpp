#include "mission/supervise/environment_record.hpp"

#include <sys/utsname.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <fstream>
#include <set>
#include <string_view>
#include <thread>

#include "core/system/host.hpp"
#include "shell_word.hpp"
#include "skein/detail/abi.hpp"

namespace skein::launch {
namespace {

constexpr std::array<std::string_view, 6> kVariables{"SKEIN_",    "CYCLONEDDS_", "FASTDDS_",
                                                     "FASTRTPS_", "RMW_",        "ROS_"};
constexpr std::array<std::string_view, 4> kSecrets{"TOKEN", "SECRET", "PASSWORD", "KEY"};

std::string machine() {
  utsname system{};
  ::uname(&system);
  return std::string(system.sysname) + " " + system.release + " " + system.version + " on " +
         system.machine + ", " + std::to_string(std::thread::hardware_concurrency()) +
         " processors";
}

/// Of this process, as a shell would read it.
std::string command_line() {
  std::ifstream file("/proc/self/cmdline");
  std::string text;
  for (std::string word; std::getline(file, word, '\0');)
    text += (text.empty() ? "" : " ") + shell_word(word);
  return text;
}

void add_parameters(std::vector<std::string>& record, const std::string& owner,
                    const std::vector<profile::Setting>& parameters) {
  for (const profile::Setting& setting : parameters)
    record.push_back("parameter: " + owner + "." + setting.name + " = " +
                     (setting.file.empty() ? setting.value : "@" + setting.file));
}

/// Logs are passed on to others.
bool is_secret(std::string_view name) {
  return std::any_of(kSecrets.begin(), kSecrets.end(),
                     [&](std::string_view ending) { return name.ends_with(ending); });
}

void add_variables(std::vector<std::string>& record) {
  for (char** entry = environ; *entry != nullptr; ++entry) {
    const std::string text(*entry);
    const bool read = std::any_of(kVariables.begin(), kVariables.end(),
                                  [&](std::string_view name) { return text.starts_with(name); });
    if (!read) continue;
    const std::string name = text.substr(0, text.find('='));
    record.push_back("environment: " + (is_secret(name) ? name + " (not shown)" : text));
  }
}

}  // namespace

std::vector<std::string> environment_record(const profile::MissionProfile& mission,
                                            const std::string& version) {
  std::string vendors;
  std::set<std::string> known;
  for (const auto& peer : mission.peers) {
    if (known.insert(peer.vendor).second) vendors += (vendors.empty() ? "" : ", ") + peer.vendor;
  }
  std::error_code ignored;
  std::vector<std::string> record{
      "skein: " + version + ", ABI " + std::to_string(SKEIN_ABI) + ", compiled by " + __VERSION__,
      "host: " + name_of_this_host() + ", " + machine(), "command: " + command_line(),
      "folder: " + std::filesystem::current_path(ignored).string(),
      "profile: " + std::filesystem::absolute(mission.file, ignored).string() + ", mission '" +
          mission.name + "', domain " + std::to_string(mission.domain) + ", vendors " + vendors};
  for (const auto& peer : mission.peers) {
    add_parameters(record, peer.name, peer.parameters);
    for (const auto& csp : peer.csps)
      add_parameters(record, peer.name + "/" + csp.name, csp.parameters);
  }
  add_variables(record);
  return record;
}

}  // namespace skein::launch
