#include "ssh_host.hpp"

#include <sched.h>
#include <signal.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <stdexcept>

#include "eventually.hpp"
#include "places.hpp"

namespace skein::test {
namespace {

[[noreturn]] void skip(const char* why) {
  std::fprintf(stderr, "skipped: %s\n", why);
  std::_Exit(77);
}

std::string server() {
  for (const std::string& root : {std::string(), project_file("build/ssh-server")}) {
    if (access((root + "/usr/sbin/sshd").c_str(), X_OK) == 0) return root;
  }
  skip("there is no OpenSSH server (./dev test unpacks one)");
}

void run(const std::string& command) {
  if (std::system(command.c_str()) != 0) throw std::runtime_error("failed: " + command);
}

std::string program_of(pid_t process) {
  std::ifstream file("/proc/" + std::to_string(process) + "/comm");
  std::string name;
  std::getline(file, name);
  return name;
}

}  // namespace

SshHost::SshHost(const NetworkSpace& space, const std::string& address,
                 const std::string& prepare) {
  if (geteuid() != 0) skip("an OpenSSH server is run for the tests by root alone");
  const std::string root = server();
  struct stat status {};
  fstat(space.descriptor(), &status);
  space_ = status.st_ino;

  const std::string folder = folder_.path().string();
  for (const std::string key : {"host_key", "user_key"})
    run("ssh-keygen -q -t ed25519 -N '' -f '" + folder + "/" + key + "'");
  folder_.write("passwd", "root:*:0:0:root:" + folder +
                              ":/bin/sh\nsshd:*:100:65534::/run/sshd:/usr/sbin/nologin\n");
  folder_.write("server_config", "ListenAddress " + address + "\nHostKey " + folder +
                                     "/host_key\nAuthorizedKeysFile " + folder +
                                     "/user_key.pub\nStrictModes no\nUsePAM no\nPidFile none\n");
  folder_.write("client_config", "User root\nIdentityFile " + folder +
                                     "/user_key\nUserKnownHostsFile " + folder +
                                     "/known_hosts\nStrictHostKeyChecking no\n");
  folder_.write("ssh", "#!/bin/sh\nexec /usr/bin/ssh -F '" + folder + "/client_config' \"$@\"\n");
  std::filesystem::permissions(folder_.path() / "ssh", std::filesystem::perms(0755));

  // A user and a folder of its own, which the machine need not have, in a mount namespace.
  space.run("unshare -m sh -c \"mount --bind '" + folder +
            "/passwd' /etc/passwd && mount -t tmpfs tmpfs /run && mkdir /run/sshd && " + prepare +
            " && "
            "LD_LIBRARY_PATH='" +
            root + "/usr/lib/x86_64-linux-gnu' '" + root + "/usr/sbin/sshd' -f '" + folder +
            "/server_config' -E '" + folder + "/server_log'\"");
  const bool listens = eventually([&] {  // it goes on in the background before it does
    std::ifstream log(folder_.path() / "server_log");
    const std::string said(std::istreambuf_iterator<char>(log), {});
    return said.find("Server listening") != std::string::npos;
  });
  if (!listens) throw std::runtime_error("the tests' ssh server does not listen");
}

SshHost::~SshHost() {
  eventually([&] {
    const auto left = processes();
    for (const pid_t process : left) kill(process, SIGKILL);
    return left.empty();
  });
}

std::vector<pid_t> SshHost::processes() const {
  std::vector<pid_t> found;
  for (const auto& entry : std::filesystem::directory_iterator("/proc")) {
    struct stat status {};
    const std::string name = entry.path().filename().string();
    if (name.find_first_not_of("0123456789") != std::string::npos) continue;
    if (stat((entry.path() / "ns/net").c_str(), &status) == 0 && status.st_ino == space_)
      found.push_back(std::stoi(name));
  }
  return found;
}

std::vector<std::string> SshHost::programs() const {
  std::vector<std::string> names;
  for (const pid_t process : processes()) {
    const std::string name = program_of(process);
    if (!name.empty() && name != "sshd") names.push_back(name);
  }
  return names;
}

}  // namespace skein::test
