#include "harness/machine.hpp"

#include <sys/utsname.h>

#include <ctime>
#include <fstream>
#include <sstream>
#include <thread>

namespace skein::benchmarks {
namespace {

std::string first_line(const std::string& path) {
  std::ifstream file(path);
  std::string line;
  std::getline(file, line);
  return line.empty() ? "unknown" : line;
}

// The value behind `key` in a file of lines such as `MemTotal:  8046 kB`.
std::string field(const std::string& path, const std::string& key) {
  std::ifstream file(path);
  for (std::string line; std::getline(file, line);) {
    if (!line.starts_with(key)) continue;
    const std::size_t value = line.find_first_not_of(" \t", line.find_first_of(":=") + 1);
    if (value != std::string::npos) return line.substr(value);
  }
  return "unknown";
}

std::string time_text() {
  const std::time_t now = std::time(nullptr);
  char text[64];
  std::strftime(text, sizeof text, "%Y-%m-%d %H:%M UTC", std::gmtime(&now));
  return text;
}

}  // namespace

MachineFacts machine_facts() {
  utsname system{};
  uname(&system);
  const bool virtual_machine =
      field("/proc/cpuinfo", "flags").find(" hypervisor") != std::string::npos;
  return {
      {"When", time_text()},
      {"Processor",
       field("/proc/cpuinfo", "model name") + (virtual_machine ? " (a virtual machine)" : "")},
      {"Cores", std::to_string(std::thread::hardware_concurrency())},
      {"Governor", first_line("/sys/devices/system/cpu/cpu0/cpufreq/scaling_governor")},
      {"Memory", field("/proc/meminfo", "MemTotal")},
      {"Kernel", std::string(system.sysname) + " " + system.release},
      {"Distribution", field("/etc/os-release", "PRETTY_NAME=")},
      {"Greatest receive buffer (net.core.rmem_max)", first_line("/proc/sys/net/core/rmem_max")},
      {"Greatest send buffer (net.core.wmem_max)", first_line("/proc/sys/net/core/wmem_max")},
      {"Load average at the start", first_line("/proc/loadavg")}};
}

}  // namespace skein::benchmarks
