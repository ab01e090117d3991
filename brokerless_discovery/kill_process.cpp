#include "skein/brokerless_discovery/kill_process.hpp"

#include <poll.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <csignal>

#include "abstract_socket.hpp"

namespace skein::brokerless_discovery {
namespace {

struct Descriptor {
  explicit Descriptor(int number) : value(number) {}
  ~Descriptor() {
    if (value >= 0) close(value);
  }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  const int value;
};

// The system's own header declares neither call for C++.
int open_process(pid_t pid) { return static_cast<int>(syscall(SYS_pidfd_open, pid, 0)); }
bool send_kill(const Descriptor& process) {
  return syscall(SYS_pidfd_send_signal, process.value, SIGKILL, nullptr, 0) == 0;
}

bool hung_up(const Descriptor& connection) {
  pollfd look{connection.value, POLLRDHUP, 0};
  return poll(&look, 1, 0) != 0;
}

}  // namespace

bool kill_process(const std::string& address) {
  const Descriptor connection(socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0));
  sockaddr_un name;
  const socklen_t length = fill(name, address);
  ucred owner{};
  socklen_t size = sizeof owner;
  if (connection.value < 0 ||
      connect(connection.value, reinterpret_cast<sockaddr*>(&name), length) != 0 ||
      getsockopt(connection.value, SOL_SOCKET, SO_PEERCRED, &owner, &size) != 0 || owner.pid <= 0 ||
      owner.pid == getpid()) {
    return false;
  }
  // While the connection stands its owner lives, so the number is still his, and so is what the
  // descriptor holds.
  const Descriptor process(open_process(owner.pid));
  return process.value >= 0 && !hung_up(connection) && send_kill(process);
}

}  // namespace skein::brokerless_discovery
