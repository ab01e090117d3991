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

NetworkSpace::NetworkSpace() {
  const int before = open_own_space();
  if (before < 0 || unshare(CLONE_NEWNET) != 0) {
    std::fprintf(stderr, "skipped: network namespaces may not be made here\n");
    std::_Exit(77);
  }
  descriptor_ = open_own_space();
  enter(before);
  close(before);
  run("ip link set lo up");
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

Inside::Inside(const NetworkSpace& space) : before_(open_own_space()) { enter(space.descriptor()); }

Inside::~Inside() {
  static_cast<void>(setns(before_, CLONE_NEWNET));
  close(before_);
}

}  // namespace skein::test
