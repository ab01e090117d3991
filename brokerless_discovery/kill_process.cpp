#include "brokerless_discovery/kill_process.hpp"

#include <sys/syscall.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <fstream>

#include "brokerless_discovery/process_watch.hpp"
#include "core/system/abstract_socket.hpp"
#include "core/system/bound_sockets.hpp"
#include "core/system/other_process.hpp"
#include "core/system/trusted_users.hpp"

namespace skein::brokerless_discovery {
namespace {

// The system's own header does not declare it for C++.
bool send_kill(const FileDescriptor& process) {
  return syscall(SYS_pidfd_send_signal, process.get(), SIGKILL, nullptr, 0) == 0;
}

// The socket may outlive the process that began to listen, in a child of it. The descriptor was
// opened before: if that process holds the socket, the number is still its own.
bool still_listens(pid_t number, const std::string& address) {
  const auto sockets = bound_sockets();
  const auto socket = sockets.find(address);
  if (socket == sockets.end()) return false;
  const auto links = open_in(number);
  return std::ranges::find(links, socket->second) != links.end();
}

// The state stands behind the name, which may hold anything.
bool is_stopped(pid_t pid) {
  std::ifstream file("/proc/" + std::to_string(pid) + "/stat");
  std::string text;
  std::getline(file, text, '\0');
  const auto name_ends = text.rfind(") ");
  return name_ends != std::string::npos && text.compare(name_ends + 2, 1, "T") == 0;
}

bool kill_if(const std::string& address, bool (*condition)(pid_t)) {
  if (!ProcessWatch::is_address(address)) return false;
  const Contact contact = reach(address, is_own_user);
  if (contact.reached != Reached::Yes || contact.process <= 0 || contact.process == getpid()) {
    return false;
  }
  const OtherProcess process = other_process(contact.socket);
  return process.descriptor && (process.is_exact || still_listens(contact.process, address)) &&
         condition(contact.process) && send_kill(process.descriptor);
}

}  // namespace

bool kill_process(const std::string& address) {
  return kill_if(address, [](pid_t) { return true; });
}

bool kill_stopped_process(const std::string& address) { return kill_if(address, is_stopped); }

}  // namespace skein::brokerless_discovery
