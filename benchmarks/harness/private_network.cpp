#include "harness/private_network.hpp"

#include <net/if.h>
#include <sched.h>
#include <sys/ioctl.h>
#include <sys/mount.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cstring>
#include <fstream>
#include <stdexcept>

#include "harness/skipped.hpp"

namespace skein::benchmarks {
namespace {

bool raise_loopback() {
  const int socket_ = socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  ifreq request{};
  std::strcpy(request.ifr_name, "lo");
  request.ifr_flags = IFF_UP;
  const bool up = socket_ >= 0 && ioctl(socket_, SIOCSIFFLAGS, &request) == 0;
  close(socket_);
  return up;
}

bool hide_shared_memory() {
  return mount("none", "/", nullptr, MS_REC | MS_PRIVATE, nullptr) == 0 &&
         mount("tmpfs", "/dev/shm", "tmpfs", MS_NOSUID | MS_NODEV, nullptr) == 0;
}

void map_to_root(uid_t user, gid_t group) {
  std::ofstream("/proc/self/setgroups") << "deny";
  std::ofstream("/proc/self/uid_map") << "0 " << user << " 1";
  std::ofstream("/proc/self/gid_map") << "0 " << group << " 1";
}

}  // namespace

std::string enter_private_network() {
  const uid_t user = geteuid();
  const gid_t group = getegid();
  if (unshare(CLONE_NEWNET | CLONE_NEWNS) != 0) {
    if (unshare(CLONE_NEWUSER | CLONE_NEWNET | CLONE_NEWNS) != 0) {
      return "network namespaces are not allowed here; other traffic on loopback may disturb";
    }
    map_to_root(user, group);
  }
  if (!raise_loopback()) return "loopback cannot be switched on";
  return hide_shared_memory()
             ? ""
             : "the run shares /dev/shm with the machine, and may leave files there";
}

TwoHosts::TwoHosts() try {
  const auto refused = [] {
    throw Skipped("no network namespaces can be made here (run as root)");
  };
  first_.emplace(refused);
  second_.emplace(refused);
  join(*first_, *second_, "10.77.0");
} catch (const std::runtime_error& error) {
  throw Skipped(error.what() + std::string("; it needs iproute2 and the right to make interfaces"));
}

// Each takes the other for a card that does not exist.
void TwoHosts::cut() {
  const std::string card = " lladdr 02:00:00:00:00:01 dev skein0 nud permanent";
  first_->run("ip neighbour replace " + second().address + card);
  second_->run("ip neighbour replace " + first().address + card);
}

void TwoHosts::heal() {
  first_->run("ip neighbour del " + second().address + " dev skein0");
  second_->run("ip neighbour del " + first().address + " dev skein0");
}

}  // namespace skein::benchmarks
