#include "skein/brokerless_discovery/process_watch.hpp"

#include <pthread.h>
#include <sys/epoll.h>
#include <sys/eventfd.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <fstream>
#include <mutex>
#include <set>
#include <thread>
#include <unordered_map>
#include <vector>

#include "abstract_socket.hpp"
#include "skein/core/error.hpp"
#include "skein/core/guid.hpp"

namespace skein::brokerless_discovery {
namespace {

constexpr std::string_view kPrefix = "skein/";

std::string system_error(const char* what) {
  return std::string(what) + ": " + std::strerror(errno);
}

}  // namespace

struct ProcessWatch::State {
  std::string address = std::string(kPrefix) + Guid::random().hex();
  int listener = -1;
  int epoll = -1;
  int wake = -1;
  std::mutex mutex;
  bool stopping = false;
  std::set<std::string> watched;
  std::unordered_map<int, std::function<void()>> connections;  // accepted ones have no action
  std::thread thread;

  State() {
    listener = socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0);
    epoll = epoll_create1(EPOLL_CLOEXEC);
    wake = eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK);
    sockaddr_un name;
    const socklen_t length = fill(name, address);
    if (listener < 0 || epoll < 0 || wake < 0 ||
        bind(listener, reinterpret_cast<sockaddr*>(&name), length) != 0 ||
        ::listen(listener, SOMAXCONN) != 0) {
      const std::string text =
          system_error("cannot open the socket by which peers see this process end");
      close_all();
      throw Unavailable(text);
    }
    add(listener, EPOLLIN);
    add(wake, EPOLLIN);
    thread = std::thread([this] { run(); });
  }

  ~State() {
    {
      std::lock_guard lock(mutex);
      stopping = true;
    }
    eventfd_write(wake, 1);
    thread.join();
    close_all();
  }

  void close_all() {
    for (const auto& [fd, action] : connections) close(fd);
    for (const int fd : {listener, epoll, wake}) {
      if (fd >= 0) close(fd);
    }
  }

  void add(int fd, std::uint32_t events) {
    epoll_event event{};
    event.events = events;
    event.data.fd = fd;
    epoll_ctl(epoll, EPOLL_CTL_ADD, fd, &event);
  }

  void run() {
    pthread_setname_np(pthread_self(), "skein-watch");
    while (true) {
      epoll_event events[32];
      const int count = epoll_wait(epoll, events, 32, -1);
      std::vector<std::function<void()>> ended;
      {
        std::lock_guard lock(mutex);
        if (stopping) return;
        for (int i = 0; i < count; ++i) handle(events[i].data.fd, ended);
      }
      for (const auto& action : ended) action();
    }
  }

  void handle(int fd, std::vector<std::function<void()>>& ended) {
    if (fd == listener) {
      const int accepted = accept4(listener, nullptr, nullptr, SOCK_CLOEXEC | SOCK_NONBLOCK);
      if (accepted < 0) return;
      connections.emplace(accepted, nullptr);
      add(accepted, EPOLLRDHUP);
    } else if (fd == wake) {
      eventfd_t count;
      eventfd_read(wake, &count);
    } else if (auto node = connections.extract(fd)) {
      close(fd);
      if (node.mapped()) ended.push_back(std::move(node.mapped()));
    }
  }

  void watch(const std::string& target, std::function<void()> action) {
    std::unique_lock lock(mutex);
    if (!watched.insert(target).second) return;
    const int fd = socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0);
    sockaddr_un name;
    const socklen_t length = fill(name, target);
    if (fd < 0 || connect(fd, reinterpret_cast<sockaddr*>(&name), length) != 0) {
      const bool refused = fd >= 0 && errno == ECONNREFUSED;
      if (fd >= 0) close(fd);
      lock.unlock();
      // Anything but "nobody listens" proves nothing; the lease will tell then.
      if (refused) action();
      return;
    }
    connections.emplace(fd, std::move(action));
    add(fd, EPOLLRDHUP);
  }
};

ProcessWatch::ProcessWatch() : state_(std::make_unique<State>()) {}
ProcessWatch::~ProcessWatch() = default;

const std::string& ProcessWatch::address() const noexcept { return state_->address; }

std::string ProcessWatch::host() {
  std::string boot;
  std::getline(std::ifstream("/proc/sys/kernel/random/boot_id") >> std::ws, boot);
  struct stat status {};
  stat("/proc/self/ns/net", &status);
  return boot + "/" + std::to_string(status.st_ino);
}

void ProcessWatch::watch(const std::string& address, std::function<void()> ended) {
  state_->watch(address, std::move(ended));
}

}  // namespace skein::brokerless_discovery
