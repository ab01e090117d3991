#include "brokerless_discovery/kill_process.hpp"

#include <sys/syscall.h>

#include <cerrno>
#include <csignal>
#include <fstream>

#include "brokerless_discovery/process_watch.hpp"
#include "core/system/abstract_socket.hpp"

namespace skein::brokerless_discovery {
namespace {

// The system's own header declares neither call for C++.
FileDescriptor open_process(pid_t pid) {
  return FileDescriptor(static_cast<int>(syscall(SYS_pidfd_open, pid, 0)));
}
bool send_kill(const FileDescriptor& process) {
  return syscall(SYS_pidfd_send_signal, process.get(), SIGKILL, nullptr, 0) == 0;
}

// 0 where nobody listens.
pid_t listening_at(const std::string& address) {
  const FileDescriptor socket = local_socket();
  if (connect_to(socket, address) != Reached::Yes) return 0;
  const auto owner = other_end(socket);
  return owner ? owner->pid : 0;
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
  const pid_t number = listening_at(address);
  if (number <= 0 || number == getpid()) return false;
  // Who listened before and listens still has lived all the while, so the number was his when it
  // was looked up.
  const FileDescriptor process = open_process(number);
  return process && listening_at(address) == number && condition(number) && send_kill(process);
}

}  // namespace

bool kill_process(const std::string& address) {
  return kill_if(address, [](pid_t) { return true; });
}

bool kill_stopped_process(const std::string& address) { return kill_if(address, is_stopped); }

}  // namespace skein::brokerless_discovery
