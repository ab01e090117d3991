#include "brokerless_discovery/process_watch.hpp"

#include <pthread.h>
#include <sys/eventfd.h>
#include <sys/stat.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <fstream>
#include <mutex>
#include <optional>
#include <thread>
#include <vector>

#include "brokerless_discovery/watched_processes.hpp"
#include "brokerless_discovery/watchers.hpp"
#include "core/log.hpp"
#include "core/system/local_server.hpp"
#include "core/system/trusted_users.hpp"
#include "core/threads/stall_watch.hpp"
#include "core/threads/start_thread.hpp"
#include "skein/error.hpp"

namespace skein::brokerless_discovery {
namespace {

constexpr std::string_view kPrefix = "skein/";
constexpr std::size_t kParticipantDigits = 24;

using Time = LocalServer::Time;

// Two processes of unknown hosts may be on two hosts, where one cannot see the other's end.
const std::string& unknown_host() {
  static const std::string own = [] {
    log(LogLevel::Warning, "discovery",
        "this host cannot be told from others: /proc/sys/kernel/random/boot_id or "
        "/proc/self/ns/net cannot be read (systemd's ProcSubset=pid?); every other process counts "
        "as one of another host");
    return "unknown/" + Guid::random().hex();
  }();
  return own;
}

}  // namespace

struct ProcessWatch::State {
  std::mutex mutex;
  bool stopping = false;
  Epoll epoll;
  FileDescriptor wake{eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK)};
  LocalServer server{epoll, [](const ucred& client) { return is_own_user(client.uid); }};
  Watchers watchers{epoll};
  WatchedProcesses watched{epoll};
  std::thread thread;

  State() {
    if (!epoll || !wake || epoll.add(wake, EPOLLIN) == 0) throw_unavailable();
    thread = start_thread("skein-watch", [this] { run(); });
  }

  ~State() {
    {
      std::lock_guard lock(mutex);
      stopping = true;
    }
    eventfd_write(wake.get(), 1);
    thread.join();
  }

  [[noreturn]] static void throw_unavailable() {
    throw Unavailable(std::string("cannot open the socket by which peers see this process end: ") +
                      std::strerror(errno));
  }

  void run() {
    pthread_setname_np(pthread_self(), "skein-watch");
    std::chrono::milliseconds until_next{0};
    while (true) {
      const auto events = epoll.wait(until_next);
      std::vector<WatchedProcesses::Action> ended;
      std::optional<Time> paused_until;
      {
        std::lock_guard lock(mutex);
        if (stopping) return;
        const Time now = std::chrono::steady_clock::now();
        for (const auto& event : events) handle(event, now, ended);
        paused_until = server.resume(now);
      }
      for (const auto& action : ended) action();
      const Time now = std::chrono::steady_clock::now();
      until_next = StallWatch::of_this_process().look(now);
      if (paused_until) {
        const auto left = std::chrono::ceil<std::chrono::milliseconds>(*paused_until - now);
        until_next = std::clamp(left, std::chrono::milliseconds(0), until_next);
      }
    }
  }

  void handle(const Epoll::Event& event, Time now, std::vector<WatchedProcesses::Action>& ended) {
    const auto greet = [this](FileDescriptor& socket, const ucred& client) {
      watchers.greet(socket, client.pid);
    };
    if (server.handle(event.id, now, greet) || watchers.handle(event.id)) return;
    watched.handle(event, ended);
  }
};

ProcessWatch::ProcessWatch() : state_(std::make_unique<State>()) {}
ProcessWatch::~ProcessWatch() = default;

std::string ProcessWatch::open(const Guid& participant) {
  std::string address = std::string(kPrefix) + participant.hex().substr(0, kParticipantDigits) +
                        Guid::random().hex().substr(kParticipantDigits);
  ListeningSocket socket(local_socket());
  std::lock_guard lock(state_->mutex);
  if (!socket || !state_->server.open(socket, address)) State::throw_unavailable();
  return address;
}

void ProcessWatch::close(const std::string& address) {
  std::lock_guard lock(state_->mutex);
  state_->server.close(address);
}

bool ProcessWatch::is_address(std::string_view address) {
  return address.starts_with(kPrefix) && Guid::from_hex(address.substr(kPrefix.size())).has_value();
}

bool ProcessWatch::is_address_of(const Guid& participant, std::string_view address) {
  if (!is_address(address)) return false;
  return Guid::from_hex(address.substr(kPrefix.size()))->participant() == participant.participant();
}

std::string ProcessWatch::host() {
  std::string boot;
  std::getline(std::ifstream("/proc/sys/kernel/random/boot_id") >> std::ws, boot);
  struct stat status {};
  const bool network_known = stat("/proc/self/ns/net", &status) == 0;
  if (boot.empty() || !network_known) return unknown_host();
  return boot + "/" + std::to_string(status.st_ino);
}

void ProcessWatch::watch(const std::string& address, const void* watcher,
                         std::function<void()> ended) {
  std::unique_lock lock(state_->mutex);
  if (!is_address(address) || state_->server.listens_at(address)) return;
  const bool due = state_->watched.watch(address, watcher, ended);
  lock.unlock();
  if (due) ended();
}

void ProcessWatch::unwatch(const std::string& address, const void* watcher) {
  std::lock_guard lock(state_->mutex);
  state_->watched.unwatch(address, watcher);
}

void ProcessWatch::unwatch(const void* watcher) {
  std::lock_guard lock(state_->mutex);
  state_->watched.unwatch(watcher);
}

ProcessWatch::Counters ProcessWatch::counters() const {
  std::lock_guard lock(state_->mutex);
  return {state_->watchers.count(), state_->watched.count(), state_->server.refused()};
}

}  // namespace skein::brokerless_discovery
