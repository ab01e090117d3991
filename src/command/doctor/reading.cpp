#include "reading.hpp"

#include <sched.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <sys/statvfs.h>
#include <sys/timex.h>
#include <unistd.h>

#include <algorithm>
#include <charconv>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <memory>
#include <sstream>

#include "core/system/file_descriptor.hpp"
#include "dds/port/options_check.hpp"
#include "dds/port/vendor_names.hpp"
#include "mission/supervise/mission_claim.hpp"
#include "skein/error.hpp"
#include "skein/vendor.hpp"

namespace skein::command::doctor {
namespace {

namespace fs = std::filesystem;

/// The whole file; empty if it cannot be read.
std::string read_file(const std::string& path) {
  std::ifstream file(path);
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

/// `process`: its folder in /proc.
Program read_program(int pid, const fs::path& process) {
  Program program{pid, read_file(process / "comm")};
  program.name.resize(std::min(program.name.size(), program.name.find('\n')));
  program.stopped = is_stopped(pid);
  if (!program.stopped) return program;
  program.command = read_file(process / "cmdline");
  while (program.command.ends_with('\0')) program.command.pop_back();
  std::ranges::replace(program.command, '\0', ' ');
  return program;
}

Program owner_of(std::uint64_t inode, const std::map<std::uint64_t, Program>& owners) {
  const auto owner = owners.find(inode);
  return owner == owners.end() ? Program() : owner->second;
}

std::vector<UdpSocket> read_udp_sockets(const std::map<std::uint64_t, Program>& owners) {
  std::vector<UdpSocket> sockets;
  for (const SocketLine& line : parse_udp(read_file("/proc/net/udp")))
    sockets.push_back({line.port, line.dropped, owner_of(line.inode, owners)});
  return sockets;
}

/// The smaller one of both directions.
std::uint64_t read_buffer() {
  const FileDescriptor socket(::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0));
  int least = dds::kSocketBuffer;
  for (const int option : {SO_RCVBUF, SO_SNDBUF}) {
    const int wanted = dds::kSocketBuffer;
    int got = 0;
    socklen_t size = sizeof got;
    setsockopt(socket.get(), SOL_SOCKET, option, &wanted, sizeof wanted);
    getsockopt(socket.get(), SOL_SOCKET, option, &got, &size);
    least = std::min(least, got / 2);  // the kernel doubles what it grants
  }
  return static_cast<std::uint64_t>(least);
}

/// The rules that nft lists; nullopt if it fails, or is not there.
std::optional<std::string> read_firewall() {
  const auto close = [](std::FILE* stream) { return pclose(stream); };
  std::unique_ptr<std::FILE, decltype(close)> stream(
      popen("PATH=$PATH:/usr/sbin:/sbin nft list ruleset 2>/dev/null", "re"), close);
  if (!stream) return std::nullopt;
  std::string text;
  char part[4096];
  while (const std::size_t size = std::fread(part, 1, sizeof part, stream.get()))
    text.append(part, size);
  return pclose(stream.release()) == 0 ? std::optional(text) : std::nullopt;
}

/// The file of the vendor's own library that this process has loaded; empty if there is none.
std::string loaded_library(const std::vector<std::string>& beginnings) {
  std::istringstream lines(read_file("/proc/self/maps"));
  for (std::string line; std::getline(lines, line);) {
    const std::size_t at = line.find('/');
    if (at == std::string::npos) continue;
    const fs::path path(line.substr(at));
    const std::string name = path.filename().string();
    const auto begins = [&](const std::string& each) { return name.starts_with(each); };
    if (std::ranges::any_of(beginnings, begins)) return path.string();
  }
  return {};
}

VendorModule read_vendor(const dds::VendorLibrary& library) {
  VendorModule module{.name = library.vendor,
                      .failure = {},
                      .library = {},
                      .version = {},
                      .tested = library.versions};
  try {
    dds::load_vendor(library.vendor);
    module.library = loaded_library(library.files);
    module.version = version_of(module.library);
  } catch (const Error& error) {
    module.failure = error.what();
  }
  return module;
}

std::optional<bool> read_clock() {
  timex told{};
  const int state = adjtimex(&told);
  if (state < 0) return std::nullopt;
  return state != TIME_ERROR && (told.status & STA_UNSYNC) == 0;
}

std::optional<std::uint64_t> read_free_shared_memory() {
  struct statvfs system {};
  if (statvfs("/dev/shm", &system) != 0) return std::nullopt;
  return std::uint64_t(system.f_bavail) * system.f_frsize;
}

std::optional<std::uint64_t> limit_of(decltype(RLIMIT_NOFILE) resource) {
  rlimit limit{};
  if (getrlimit(resource, &limit) != 0 || limit.rlim_cur == RLIM_INFINITY) return std::nullopt;
  return limit.rlim_cur;
}

bool may_set_any_priority() {
  sched_param parameter{};
  const int policy = sched_getscheduler(0);
  sched_getparam(0, &parameter);
  sched_param wanted{.sched_priority = sched_get_priority_max(SCHED_FIFO)};
  if (sched_setscheduler(0, SCHED_FIFO, &wanted) != 0) return false;
  sched_setscheduler(0, policy, &parameter);
  return true;
}

}  // namespace

bool is_stopped(int pid) {
  const std::string text = read_file("/proc/" + std::to_string(pid) + "/stat");
  // The state follows the name, which stands in parentheses and may contain some.
  const std::size_t at = text.rfind(") ");
  return at != std::string::npos && at + 2 < text.size() &&
         (text[at + 2] == 'T' || text[at + 2] == 't');
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

std::vector<SocketLine> parse_udp(const std::string& text) {
  std::vector<SocketLine> sockets;
  std::istringstream lines(text);
  std::string line;
  std::getline(lines, line);  // the names of the columns
  while (std::getline(lines, line)) {
    std::istringstream columns(line);
    std::vector<std::string> words;
    for (std::string word; columns >> word;) words.push_back(word);
    constexpr std::size_t kLocal = 1, kInode = 9, kDrops = 12;
    if (words.size() <= kDrops) continue;
    const std::string& local = words[kLocal];
    SocketLine socket;
    std::from_chars(local.data() + local.find(':') + 1, local.data() + local.size(), socket.port,
                    16);
    socket.inode = std::strtoull(words[kInode].c_str(), nullptr, 10);
    socket.dropped = std::strtoull(words[kDrops].c_str(), nullptr, 10);
    sockets.push_back(socket);
  }
  return sockets;
}

std::vector<Launcher> read_launchers(const std::map<std::uint64_t, Program>& owners) {
  std::vector<Launcher> launchers;
  std::istringstream lines(read_file("/proc/net/unix"));
  for (std::string line; std::getline(lines, line);) {
    std::istringstream columns(line);
    std::string word, inode, name;
    for (int i = 0; i < 6; ++i) columns >> word;
    columns >> inode >> name;
    if (const auto domain = launch::claimed_domain(name))
      launchers.push_back({*domain, owner_of(std::strtoull(inode.c_str(), nullptr, 10), owners)});
  }
  return launchers;
}

std::string version_of(const std::string& library) {
  const std::size_t at = library.rfind(".so.");
  return at == std::string::npos ? "" : library.substr(at + 4);
}

Facts collect_facts() {
  const auto owners = owners_of_sockets();
  Facts facts;
  facts.interfaces = network_interfaces();
  facts.sockets = read_udp_sockets(owners);
  facts.launchers = read_launchers(owners);
  facts.buffer = read_buffer();
  for (const dds::VendorLibrary& library : dds::vendor_libraries())
    facts.vendors.push_back(read_vendor(library));
  facts.synchronised_clock = read_clock();
  facts.free_shared_memory = read_free_shared_memory();
  facts.firewall = read_firewall();
  facts.limits.open_files = limit_of(RLIMIT_NOFILE);
  facts.limits.locked_memory = limit_of(RLIMIT_MEMLOCK);
  facts.limits.real_time_priority =
      may_set_any_priority() ? 99 : static_cast<int>(limit_of(RLIMIT_RTPRIO).value_or(99));
  return facts;
}

}  // namespace skein::command::doctor
