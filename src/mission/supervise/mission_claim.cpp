#include "mission/supervise/mission_claim.hpp"

#include <sys/socket.h>
#include <sys/time.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <charconv>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <map>
#include <optional>
#include <set>
#include <sstream>
#include <string>

#include "core/log.hpp"
#include "core/system/abstract_socket.hpp"
#include "mission/process/wake_up.hpp"
#include "skein/error.hpp"

namespace skein::launch {
namespace {

constexpr std::string_view kPrefix = "skein-launch-";

/// A launcher takes the first name that no process of another user has: anybody may take any name.
constexpr int kNames = 16;

/// With which the names of all this user's launchers begin.
std::string own_prefix() { return std::string(kPrefix) + std::to_string(::getuid()) + "-"; }

/// Two launchers of one name start the same peers. `number` is less than kNames.
std::string name_of(const profile::MissionProfile& mission, const std::string& host, int number) {
  std::set<std::string> systems;
  for (const auto& peer : mission.peers) systems.insert(peer.system);
  std::string all = mission.name + '\0' + host;
  for (const std::string& system : systems) all += '\0' + system;
  return own_prefix() + std::to_string(mission.domain) + "-" +
         std::to_string(std::hash<std::string>()(all)) +
         (number == 0 ? "" : "-" + std::to_string(number));
}

/// The process that listens there, once `client` is connected to it; nothing if none does.
std::optional<ucred> holder_of(const std::string& name, const FileDescriptor& client) {
  return connect_to(client, name) == Reached::Yes ? other_end(client) : std::nullopt;
}

constexpr std::string_view kUnconnected = "01";  // SS_UNCONNECTED of <linux/net.h>

/// Sockets that are bound to a name in the abstract namespace, with the inode of each.
std::map<std::string, std::string> bound_sockets() {
  std::map<std::string, std::string> inodes;
  std::ifstream sockets("/proc/net/unix");
  for (std::string line; std::getline(sockets, line);) {
    std::istringstream columns(line);
    std::string word, state, inode, shown;
    for (int i = 0; i < 5; ++i) columns >> word;
    columns >> state >> inode >> shown;
    // What is connected to it bears its name, too.
    if (state == kUnconnected && shown.starts_with('@')) inodes.emplace(shown.substr(1), inode);
  }
  return inodes;
}

/// The socket that is bound to that name, as a process's descriptor shows it.
std::optional<std::string> link_to(const std::string& name) {
  const auto sockets = bound_sockets();
  const auto found = sockets.find(name);
  if (found == sockets.end()) return std::nullopt;
  return "socket:[" + found->second + "]";
}

/// Not by the owner of the folder, which is root where a process has changed its user.
bool is_ours(const std::filesystem::path& process) {
  std::ifstream status(process / "status");
  std::string word;
  uid_t user = 0;
  while (status >> word && word != "Uid:") {
  }
  return status >> user && user == ::getuid();
}

bool has_open(const std::filesystem::path& process, const std::string& link) {
  std::error_code error;
  for (const auto& each : std::filesystem::directory_iterator(process / "fd", error)) {
    if (std::filesystem::read_symlink(each, error) == link) return true;
  }
  return false;
}

/// The process of this user whose socket has that name. One that listens is known by its
/// connection, any other by its descriptors.
std::optional<pid_t> own_holder_of(const std::string& name) {
  if (const auto holder = holder_of(name, local_socket()))
    return holder->uid == ::getuid() ? std::optional(holder->pid) : std::nullopt;
  const auto link = link_to(name);
  if (!link) return std::nullopt;
  for (const auto& each : std::filesystem::directory_iterator("/proc")) {
    const std::string number = each.path().filename();
    if (number.find_first_not_of("0123456789") != std::string::npos) continue;
    if (is_ours(each) && has_open(each, *link)) return std::stoi(number);
  }
  return std::nullopt;
}

constexpr timeval kSocketPatience{10, 0};
constexpr std::size_t kLongestAnswer = 1 << 20;

/// All that comes until the other side ends; what has come if all of it takes too long.
std::string read_all(const FileDescriptor& socket) {
  const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(kSocketPatience.tv_sec);
  std::string text;
  std::array<char, 4096> part;
  while (text.size() < kLongestAnswer && std::chrono::steady_clock::now() < end) {
    const auto size = ::read(socket.get(), part.data(), part.size());
    if (size < 0 && errno == EINTR) continue;
    if (size <= 0) break;
    text.append(part.data(), static_cast<std::size_t>(size));
  }
  return text;
}

FileDescriptor patient_socket() {
  FileDescriptor socket(::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0));
  if (!socket) throw_system_error("a socket");
  for (const int option : {SO_RCVTIMEO, SO_SNDTIMEO})
    ::setsockopt(socket.get(), SOL_SOCKET, option, &kSocketPatience, sizeof kSocketPatience);
  return socket;
}

/// `; missions of this user fly here on domain 42`, where some do.
std::string flown_instead() {
  std::set<std::uint32_t> domains;
  for (const auto& [name, inode] : bound_sockets()) {
    if (!name.starts_with(own_prefix())) continue;
    if (const auto domain = claimed_domain("@" + name)) domains.insert(*domain);
  }
  std::string list;
  for (const std::uint32_t domain : domains)
    list += (list.empty() ? "" : ", ") + std::to_string(domain);
  return list.empty() ? "" : "; missions of this user fly here on domain " + list;
}

/// What the launcher at the other end answers. Throws as ask_launcher().
std::string ask(const FileDescriptor& socket, pid_t launcher, const std::string& request) {
  const std::string line = request + "\n";
  std::string answer;
  if (::send(socket.get(), line.data(), line.size(), MSG_NOSIGNAL) ==
      static_cast<ssize_t>(line.size()))
    answer = read_all(socket);
  const bool accepted = answer.starts_with(kAccepted);
  if (!accepted && !answer.starts_with(kRefused)) {
    throw Unavailable("the launcher, process " + std::to_string(launcher) +
                      ", does not answer; is it stopped?");
  }
  answer.erase(0, accepted ? kAccepted.size() : kRefused.size());
  if (!accepted) throw Unavailable("the launcher refuses: " + answer);
  return answer;
}

}  // namespace

std::string ask_launcher(const profile::MissionProfile& mission, const std::string& host,
                         const std::string& request) {
  const FileDescriptor socket = patient_socket();
  std::optional<ucred> holder;
  for (int number = 0; number < kNames && !holder; ++number) {
    const std::string name = name_of(mission, host, number);
    if (own_holder_of(name)) holder = holder_of(name, socket);
  }
  if (!holder) {
    throw Unavailable("the mission '" + mission.name + "' is not flown here on domain " +
                      std::to_string(mission.domain) +
                      (host.empty() ? "" : " as host '" + host + "'") +
                      "; start it by skein launch, and ask as the same user" + flown_instead());
  }
  return ask(socket, holder->pid, request);
}

std::vector<LauncherAnswer> ask_launchers(const std::string& request) {
  std::vector<LauncherAnswer> answers;
  for (const auto& [name, inode] : bound_sockets()) {
    if (!name.starts_with(own_prefix())) continue;
    const FileDescriptor socket = patient_socket();
    const auto holder = holder_of(name, socket);
    if (!holder || holder->uid != ::getuid()) continue;
    try {
      answers.push_back({ask(socket, holder->pid, request), ""});
    } catch (const Unavailable& error) {
      answers.push_back({"", error.what()});
    }
  }
  return answers;
}

MissionClaim::MissionClaim(const profile::MissionProfile& mission, const std::string& host) {
  FileDescriptor socket = local_socket();
  if (!socket) throw_system_error("a socket");
  const auto refuse_if_flown = [&](int number) {
    const auto holder = own_holder_of(name_of(mission, host, number));
    if (!holder) return;
    throw InvalidArgument("the mission '" + mission.name + "' is flown here already, on domain " +
                          std::to_string(mission.domain) + ", by process " +
                          std::to_string(*holder) +
                          " (skein launch); end that one first, or fly this one on another domain");
  };
  // Another user may have given back a name since a launcher of this user took a later one.
  for (int number = 0; number < kNames; ++number) refuse_if_flown(number);
  for (int number = 0; number < kNames; ++number) {
    if (listen_at(socket, name_of(mission, host, number), 8)) {
      socket_ = std::move(socket);
      return;
    }
    if (errno != EADDRINUSE) throw_system_error("a socket with a name");
    refuse_if_flown(number);
  }
  log(LogLevel::Warning, "launch",
      "other users' processes have taken all names of the socket for requests (`ss -xlp` shows "
      "them): skein status finds nothing, and nothing keeps this mission from being flown twice");
}

std::optional<std::uint32_t> claimed_domain(std::string_view socket) {
  constexpr char kAbstract = '@';
  if (socket.empty() || socket.front() != kAbstract || !socket.substr(1).starts_with(kPrefix))
    return std::nullopt;
  socket.remove_prefix(1 + kPrefix.size());
  socket.remove_prefix(std::min(socket.find('-'), socket.size() - 1) + 1);  // the user
  std::uint32_t domain = 0;
  const auto read = std::from_chars(socket.data(), socket.data() + socket.size(), domain);
  return read.ec == std::errc() ? std::optional(domain) : std::nullopt;
}

}  // namespace skein::launch
