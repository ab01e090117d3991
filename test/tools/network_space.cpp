#include "network_space.hpp"

#include <fcntl.h>
#include <sched.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <stdexcept>

namespace skein::test {
namespace {

int open_own_space() { return open("/proc/thread-self/ns/net", O_RDONLY | O_CLOEXEC); }

void enter(int space) {
  if (setns(space, CLONE_NEWNET) != 0) throw std::runtime_error("cannot enter a network namespace");
}

}  // namespace

NetworkSpace::NetworkSpace(void (*refused)()) {
  const int before = open_own_space();
  if (before < 0 || unshare(CLONE_NEWNET) != 0) refused();
  descriptor_ = open_own_space();
  enter(before);
  close(before);
  run("ip link set lo up");
}

void NetworkSpace::skip() {
  std::fprintf(stderr, "skipped: network namespaces may not be made here\n");
  std::_Exit(77);
}

NetworkSpace::~NetworkSpace() { close(descriptor_); }

void NetworkSpace::run(const std::string& command) const {
  const pid_t child = fork();
  if (child == 0) {
    if (setns(descriptor_, CLONE_NEWNET) != 0) _exit(126);
    execl("/bin/sh", "sh", "-c", command.c_str(), nullptr);
    _exit(127);
  }
  int status = 0;
  waitpid(child, &status, 0);
  if (status != 0) throw std::runtime_error("'" + command + "' failed in a network namespace");
}

void join(const NetworkSpace& one, const NetworkSpace& other, const std::string& subnet) {
  one.run("ip link add skein0 type veth peer name skein0 netns /proc/" + std::to_string(getpid()) +
          "/fd/" + std::to_string(other.descriptor()));
  one.run("ip address add " + subnet + ".1/24 dev skein0 && ip link set skein0 up");
  other.run("ip address add " + subnet + ".2/24 dev skein0 && ip link set skein0 up");
  for (const NetworkSpace* each : {&one, &other})  // the kernel sees a carrier a little later
    each->run("timeout 20 sh -c 'until ip link show skein0 | grep -q LOWER_UP; do :; done'");
}

Inside::Inside(const NetworkSpace& space) : before_(open_own_space()) { enter(space.descriptor()); }

Inside::~Inside() {
  static_cast<void>(setns(before_, CLONE_NEWNET));
  close(before_);
}

}  // namespace skein::test
