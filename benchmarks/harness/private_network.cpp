#include "harness/private_network.hpp"

#include <fcntl.h>
#include <net/if.h>
#include <sched.h>
#include <sys/ioctl.h>
#include <sys/mount.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstring>
#include <fstream>
#include <thread>
#include <vector>

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

int open_network() { return open("/proc/thread-self/ns/net", O_RDONLY | O_CLOEXEC); }

// A network namespace that lives as long as the descriptor; this thread returns to its own.
int make_network() {
  const int own = open_network();
  int made = -1;
  if (unshare(CLONE_NEWNET) == 0) {
    raise_loopback();
    made = open_network();
    setns(own, CLONE_NEWNET);
  }
  close(own);
  if (made < 0) throw Skipped("no network namespaces can be made here (run as root)");
  return made;
}

void run_ip(std::vector<std::string> arguments, int network = -1) {
  arguments.insert(arguments.begin(), "ip");
  const pid_t pid = fork();
  if (pid == 0) {
    if (network >= 0 && setns(network, CLONE_NEWNET) != 0) _exit(126);
    std::vector<char*> words;
    for (std::string& argument : arguments) words.push_back(argument.data());
    words.push_back(nullptr);
    execvp("ip", words.data());
    _exit(127);
  }
  int status = 1;
  waitpid(pid, &status, 0);
  if (status == 0) return;
  std::string text;
  for (const std::string& argument : arguments) text += argument + " ";
  throw Skipped("'" + text + "' failed; it needs iproute2 and the right to make interfaces");
}

bool is_running(int network, const char* interface) {
  const int own = open_network();
  setns(network, CLONE_NEWNET);
  const int socket_ = socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  ifreq request{};
  std::strcpy(request.ifr_name, interface);
  const bool running =
      ioctl(socket_, SIOCGIFFLAGS, &request) == 0 && (request.ifr_flags & IFF_RUNNING);
  close(socket_);
  setns(own, CLONE_NEWNET);
  close(own);
  return running;
}

// The kernel raises a cable's ends a moment after they were switched on; Fast DDS passes over an
// interface that is not up.
void await_running(int network, const char* interface) {
  for (int attempt = 0; !is_running(network, interface); ++attempt) {
    if (attempt == 1000) throw Skipped(std::string(interface) + " does not come up");
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
}

std::string path_of(int network) {
  return "/proc/" + std::to_string(getpid()) + "/fd/" + std::to_string(network);
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

TwoHosts::TwoHosts() {
  first_.network = make_network();
  second_.network = make_network();
  run_ip({"link", "add", "skein0", "netns", path_of(first_.network), "type", "veth", "peer", "name",
          "skein1", "netns", path_of(second_.network)});
  run_ip({"address", "add", first_.address + "/24", "dev", "skein0"}, first_.network);
  run_ip({"address", "add", second_.address + "/24", "dev", "skein1"}, second_.network);
  run_ip({"link", "set", "skein0", "up"}, first_.network);
  run_ip({"link", "set", "skein1", "up"}, second_.network);
  await_running(first_.network, "skein0");
  await_running(second_.network, "skein1");
}

// Each takes the other for a card that does not exist.
void TwoHosts::cut() {
  const char* nobody = "02:00:00:00:00:01";
  run_ip({"neighbour", "replace", second_.address, "lladdr", nobody, "dev", "skein0", "nud",
          "permanent"},
         first_.network);
  run_ip({"neighbour", "replace", first_.address, "lladdr", nobody, "dev", "skein1", "nud",
          "permanent"},
         second_.network);
}

void TwoHosts::heal() {
  run_ip({"neighbour", "del", second_.address, "dev", "skein0"}, first_.network);
  run_ip({"neighbour", "del", first_.address, "dev", "skein1"}, second_.network);
}

TwoHosts::~TwoHosts() {
  close(first_.network);
  close(second_.network);
}

}  // namespace skein::benchmarks
