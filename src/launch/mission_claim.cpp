#include "launch/mission_claim.hpp"

#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <cerrno>
#include <optional>
#include <set>
#include <string>

#include "../core/file_descriptor.hpp"
#include "skein/error.hpp"
#include "wake_up.hpp"

namespace skein::launch {
namespace {

/// Two launchers of one name start the same peers.
std::string name_of(const profile::MissionProfile& mission, const std::string& host) {
  std::set<std::string> systems;
  for (const auto& peer : mission.peers) systems.insert(peer.system);
  std::string all = mission.name + '\0' + host;
  for (const std::string& system : systems) all += '\0' + system;
  return "skein-launch-" + std::to_string(::getuid()) + "-" + std::to_string(mission.domain) + "-" +
         std::to_string(std::hash<std::string>()(all));
}

/// In the abstract namespace, which begins with a zero and is each network namespace's own.
sockaddr_un address_of(const std::string& name) {
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  name.copy(address.sun_path + 1, sizeof address.sun_path - 1);
  return address;
}

/// Who listens there; nothing where nobody does any more.
std::optional<ucred> holder_of(const sockaddr_un& address) {
  const FileDescriptor client(::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0));
  ucred holder{};
  socklen_t size = sizeof holder;
  if (::connect(client.get(), reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0 ||
      ::getsockopt(client.get(), SOL_SOCKET, SO_PEERCRED, &holder, &size) != 0) {
    return std::nullopt;
  }
  return holder;
}

}  // namespace

MissionClaim::MissionClaim(const profile::MissionProfile& mission, const std::string& host) {
  FileDescriptor socket(::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0));
  if (!socket) throw_system_error("a socket");
  const sockaddr_un address = address_of(name_of(mission, host));
  if (::bind(socket.get(), reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0) {
    if (::listen(socket.get(), 8) != 0) throw_system_error("a socket that listens");
    socket_ = socket.release();
    return;
  }
  if (errno != EADDRINUSE) throw_system_error("a socket with a name");
  const auto holder = holder_of(address);
  // Somebody else's process may take any name; that must not keep a mission from flying.
  if (holder && holder->uid != ::getuid()) return;
  const std::string who = holder ? "process " + std::to_string(holder->pid) : "another process";
  throw InvalidArgument("the mission '" + mission.name + "' is flown here already, on domain " +
                        std::to_string(mission.domain) + ", by " + who +
                        " (skein launch); end that one first, or fly this one on another domain");
}

MissionClaim::~MissionClaim() {
  if (socket_ >= 0) ::close(socket_);
}

}  // namespace skein::launch
