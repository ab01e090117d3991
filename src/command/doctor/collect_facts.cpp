#include <sys/timex.h>
#include <unistd.h>

#include <algorithm>
#include <charconv>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "reading.hpp"

namespace skein::command::doctor {
namespace {

namespace fs = std::filesystem;

/// How far the clock is ahead of one that is never set.
std::chrono::nanoseconds lead_of_clock() {
  return std::chrono::system_clock::now().time_since_epoch() -
         std::chrono::steady_clock::now().time_since_epoch();
}

std::optional<SystemClock> read_clock(std::chrono::nanoseconds lead_before) {
  timex told{};
  const int state = adjtimex(&told);
  if (state < 0) return std::nullopt;
  return SystemClock{.synchronised = state != TIME_ERROR && (told.status & STA_UNSYNC) == 0,
                     .stepped = std::chrono::duration_cast<std::chrono::microseconds>(
                         lead_of_clock() - lead_before)};
}

std::optional<std::pair<std::uint16_t, std::uint16_t>> read_any_ports() {
  std::pair<std::uint16_t, std::uint16_t> ports;
  std::istringstream text(read_file("/proc/sys/net/ipv4/ip_local_port_range").value_or(""));
  if (!(text >> ports.first >> ports.second)) return std::nullopt;
  return ports;
}

bool is_stopped(const fs::path& process) {
  const std::string text = read_file(process / "stat").value_or("");
  // The state follows the name, which stands in parentheses and may contain some.
  const std::size_t at = text.rfind(") ");
  return at != std::string::npos && at + 2 < text.size() &&
         (text[at + 2] == 'T' || text[at + 2] == 't');
}

/// `process`: its folder in /proc.
Program read_program(int pid, const fs::path& process) {
  Program program{pid, read_file(process / "comm").value_or("?")};
  program.name.resize(std::min(program.name.size(), program.name.find('\n')));
  program.stopped = is_stopped(process);
  if (!program.stopped) return program;
  program.command = read_file(process / "cmdline").value_or("");
  while (program.command.ends_with('\0')) program.command.pop_back();
  std::ranges::replace(program.command, '\0', ' ');
  return program;
}

}  // namespace

std::optional<std::string> read_file(const std::string& path) {
  std::ifstream file(path);
  if (!file) return std::nullopt;
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

std::optional<std::uint64_t> read_number(const std::string& path) {
  const std::string text = read_file(path).value_or("");
  std::uint64_t value = 0;
  const auto read = std::from_chars(text.data(), text.data() + text.size(), value);
  return read.ec == std::errc() ? std::optional(value) : std::nullopt;
}

std::map<std::uint64_t, Program> owners_of_sockets() {
  std::map<std::uint64_t, Program> owners;
  std::error_code failed;
  for (const auto& process : fs::directory_iterator("/proc", failed)) {
    const int pid = std::atoi(process.path().filename().c_str());
    if (pid == 0 || pid == getpid()) continue;
    const Program program = read_program(pid, process.path());
    std::error_code hidden;
    for (const auto& file : fs::directory_iterator(process.path() / "fd", hidden)) {
      const std::string target = fs::read_symlink(file.path(), hidden).string();
      if (target.starts_with("socket:["))
        owners.emplace(std::strtoull(target.c_str() + 8, nullptr, 10), program);
    }
  }
  return owners;
}

Facts collect_facts() {
  const auto lead = lead_of_clock();
  const auto owners = owners_of_sockets();
  Facts facts;
  facts.interfaces = network_interfaces();
  facts.sockets = read_udp_sockets(owners);
  facts.launchers = read_launchers(owners);
  facts.receive_buffer = read_number("/proc/sys/net/core/rmem_max");
  facts.send_buffer = read_number("/proc/sys/net/core/wmem_max");
  facts.any_ports = read_any_ports();
  facts.vendors = read_vendors();
  facts.shared_memory = read_shared_memory("/dev/shm");
  facts.firewall = read_firewall();
  facts.limits = read_limits();
  facts.processors = read_processors();
  facts.missing_folders = read_missing_folders();
  facts.clock = read_clock(lead);
  return facts;
}

}  // namespace skein::command::doctor
