#include "brokerless_discovery/process_watch.hpp"

#include <pthread.h>
#include <sys/epoll.h>
#include <sys/eventfd.h>
#include <sys/stat.h>
#include <sys/timerfd.h>

#include <cerrno>
#include <chrono>
#include <cstring>
#include <fstream>
#include <map>
#include <mutex>
#include <thread>
#include <unordered_map>
#include <utility>
#include <vector>

#include "core/log.hpp"
#include "core/system/abstract_socket.hpp"
#include "core/system/other_process.hpp"
#include "core/system/trusted_users.hpp"
#include "core/threads/stall_watch.hpp"
#include "core/threads/start_thread.hpp"
#include "skein/error.hpp"

namespace skein::brokerless_discovery {
namespace {

constexpr std::string_view kPrefix = "skein/";
constexpr std::size_t kParticipantDigits = 24;

constexpr std::uint64_t kWake = 0;
constexpr std::uint64_t kTimer = 1;

using Action = std::function<void()>;
using Actions = std::vector<Action>;

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
  struct Listener {
    std::string address;
    ListeningSocket socket;
  };
  struct Watcher {
    pid_t process;
    FileDescriptor socket;
  };
  struct Watched {
    std::uint64_t id = 0;
    FileDescriptor socket;
    std::uint64_t process_id = 0;
    FileDescriptor process;  // a child of it may keep the other end of the socket open
    bool greeted = false;
    bool second = false;  // whether the first connection ended without a greeting
    std::map<const void*, Action> actions;
  };

  FileDescriptor epoll{epoll_create1(EPOLL_CLOEXEC)};
  FileDescriptor wake{eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK)};
  FileDescriptor timer{timerfd_create(CLOCK_MONOTONIC, TFD_CLOEXEC | TFD_NONBLOCK)};
  mutable std::mutex mutex;
  bool stopping = false;
  // What the kernel tells of is known by a number that is never used again, as descriptors are.
  std::uint64_t last_id = kTimer;
  std::map<std::uint64_t, Listener> listeners;
  std::unordered_map<std::uint64_t, Watcher> watchers;
  std::unordered_map<pid_t, std::size_t> watchers_of;
  std::unordered_map<std::string, Watched> watched;
  std::unordered_map<std::uint64_t, std::string> watched_addresses;
  std::uint64_t refused = 0;
  std::thread thread;

  State() {
    if (!epoll || !wake || !timer) throw_unavailable();
    control(EPOLL_CTL_ADD, wake, kWake, EPOLLIN);
    control(EPOLL_CTL_ADD, timer, kTimer, EPOLLIN);
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

  bool control(int operation, const FileDescriptor& of, std::uint64_t id, std::uint32_t events) {
    epoll_event event{};
    event.events = events;
    event.data.u64 = id;
    return epoll_ctl(epoll.get(), operation, of.get(), &event) == 0;
  }

  void run() {
    pthread_setname_np(pthread_self(), "skein-watch");
    std::chrono::milliseconds until_look{0};
    while (true) {
      epoll_event events[32];
      const int count = epoll_wait(epoll.get(), events, 32, static_cast<int>(until_look.count()));
      Actions ended;
      {
        std::lock_guard lock(mutex);
        if (stopping) return;
        for (int i = 0; i < count; ++i) handle(events[i].data.u64, events[i].events, ended);
      }
      for (const auto& action : ended) action();
      until_look = StallWatch::of_this_process().look(std::chrono::steady_clock::now());
    }
  }

  void handle(std::uint64_t id, std::uint32_t events, Actions& ended) {
    if (id == kTimer) return let_in_again();
    if (const auto listener = listeners.find(id); listener != listeners.end()) {
      return let_in(listener->second);
    }
    if (const auto node = watchers.extract(id)) return forget(node.mapped().process);
    if (const auto address = watched_addresses.find(id); address != watched_addresses.end()) {
      const auto position = watched.find(address->second);
      if (id == position->second.process_id) return end(position, ended);
      heard(position, events, ended);
    }
  }

  // ---- those who watch this process

  std::string open(const Guid& participant) {
    Listener listener{std::string(kPrefix) + participant.hex().substr(0, kParticipantDigits) +
                          Guid::random().hex().substr(kParticipantDigits),
                      ListeningSocket(local_socket())};
    std::lock_guard lock(mutex);
    const std::uint64_t id = ++last_id;
    if (!listener.socket || !listen_at(listener.socket, listener.address) ||
        !control(EPOLL_CTL_ADD, listener.socket, id, EPOLLIN)) {
      throw_unavailable();
    }
    std::string address = listener.address;
    listeners.emplace(id, std::move(listener));
    return address;
  }

  void let_in(const Listener& listener) {
    const std::uint64_t before = refused;
    const bool served =
        skein::let_in(listener.socket.get(), kAcceptedInARow, [&](FileDescriptor& socket) {
          if (!greet(socket)) ++refused;
        });
    if (!served) return let_nobody_in(kAfterShortage);
    if (refused > before) let_nobody_in(kAfterRefusal);
  }

  /// Moves from the socket if its process may watch this one.
  bool greet(FileDescriptor& socket) {
    const auto owner = other_end(socket);
    if (!owner || !is_own_user(owner->uid) || watchers.size() >= kMaxWatchers) return false;
    std::size_t& of_one = watchers_of[owner->pid];
    if (of_one >= kMaxWatchersOfOne) return false;
    const std::uint64_t id = ++last_id;
    if (!control(EPOLL_CTL_ADD, socket, id, EPOLLRDHUP) ||
        send(socket.get(), "!", 1, MSG_NOSIGNAL) != 1) {
      if (of_one == 0) watchers_of.erase(owner->pid);
      return false;
    }
    ++of_one;
    watchers.emplace(id, Watcher{owner->pid, std::move(socket)});
    return true;
  }

  void forget(pid_t process) {
    const auto of_one = watchers_of.find(process);
    if (--of_one->second == 0) watchers_of.erase(of_one);
  }

  void let_nobody_in(std::chrono::milliseconds time) {
    for (const auto& [id, listener] : listeners) control(EPOLL_CTL_MOD, listener.socket, id, 0);
    itimerspec until{};
    until.it_value.tv_nsec = std::chrono::nanoseconds(time).count();
    timerfd_settime(timer.get(), 0, &until, nullptr);
  }

  void let_in_again() {
    std::uint64_t times;
    [[maybe_unused]] const auto size = read(timer.get(), &times, sizeof times);
    for (const auto& [id, listener] : listeners) {
      control(EPOLL_CTL_MOD, listener.socket, id, EPOLLIN);
    }
  }

  // ---- those whom this process watches

  void watch(const std::string& address, const void* watcher, Action action) {
    std::unique_lock lock(mutex);
    if (!is_address(address) || is_own(address)) return;
    if (const auto found = watched.find(address); found != watched.end()) {
      found->second.actions.try_emplace(watcher, std::move(action));
      return;
    }
    if (watched.size() >= kMaxWatched) return;
    Watched other;
    const Reached connected = join(other, address);
    if (connected == Reached::Nobody) {
      lock.unlock();
      action();
    }
    if (connected != Reached::Yes) return;
    other.actions.emplace(watcher, std::move(action));
    watched.emplace(address, std::move(other));
  }

  Reached join(Watched& other, const std::string& address) {
    Contact contact = reach(address, is_own_user);
    if (contact.reached != Reached::Yes) return contact.reached;
    const std::uint64_t id = ++last_id;
    if (!control(EPOLL_CTL_ADD, contact.socket, id, EPOLLIN | EPOLLRDHUP)) return Reached::Unknown;
    other.id = id;
    other.socket = std::move(contact.socket);
    watched_addresses.emplace(id, address);
    other.process_id = ++last_id;
    other.process = other_process(other.socket).descriptor;
    if (other.process) control(EPOLL_CTL_ADD, other.process, other.process_id, EPOLLIN);
    watched_addresses.emplace(other.process_id, address);
    return Reached::Yes;
  }

  bool is_own(const std::string& address) const {
    for (const auto& [id, listener] : listeners) {
      if (listener.address == address) return true;
    }
    return false;
  }

  using Position = std::unordered_map<std::string, Watched>::iterator;

  void heard(Position position, std::uint32_t events, Actions& ended) {
    Watched& other = position->second;
    char greeting;
    if (!other.greeted && recv(other.socket.get(), &greeting, 1, MSG_DONTWAIT) == 1) {
      other.greeted = true;
      control(EPOLL_CTL_MOD, other.socket, other.id, EPOLLRDHUP);
    }
    if ((events & (EPOLLRDHUP | EPOLLHUP | EPOLLERR)) == 0) return;
    leave(other);
    if (!other.greeted) {
      // The process turned this connection away, or is ending, and closed it before its listener.
      // Then nobody takes the next one, which ends with the listener. That one needs a descriptor,
      // and this connection's may be the last.
      other.socket = {};
      other.process = {};
      const bool first = !std::exchange(other.second, true);
      const Reached again =
          first ? join(other, position->first) : reach(position->first, is_own_user).reached;
      if (first && again == Reached::Yes) return;
      if (again != Reached::Nobody) {
        watched.erase(position);
        return;
      }
    }
    tell(position, ended);
  }

  void end(Position position, Actions& ended) {
    leave(position->second);
    tell(position, ended);
  }

  void tell(Position position, Actions& ended) {
    for (auto& [watcher, action] : position->second.actions) ended.push_back(std::move(action));
    watched.erase(position);
  }

  /// A copy of the descriptor, in a child, must not tell of it for ever.
  void leave(const Watched& other) {
    control(EPOLL_CTL_DEL, other.socket, other.id, 0);
    if (other.process) control(EPOLL_CTL_DEL, other.process, other.process_id, 0);
    watched_addresses.erase(other.id);
    watched_addresses.erase(other.process_id);
  }

  Position drop(Position position) {
    leave(position->second);
    return watched.erase(position);
  }

  void unwatch(const std::string& address, const void* watcher) {
    std::lock_guard lock(mutex);
    const auto found = watched.find(address);
    if (found == watched.end()) return;
    found->second.actions.erase(watcher);
    if (found->second.actions.empty()) drop(found);
  }

  void unwatch(const void* watcher) {
    std::lock_guard lock(mutex);
    for (auto position = watched.begin(); position != watched.end();) {
      position->second.actions.erase(watcher);
      position = position->second.actions.empty() ? drop(position) : std::next(position);
    }
  }
};

ProcessWatch::ProcessWatch() : state_(std::make_unique<State>()) {}
ProcessWatch::~ProcessWatch() = default;

std::string ProcessWatch::open(const Guid& participant) { return state_->open(participant); }

void ProcessWatch::close(const std::string& address) {
  std::lock_guard lock(state_->mutex);
  std::erase_if(state_->listeners,
                [&](const auto& listener) { return listener.second.address == address; });
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
  state_->watch(address, watcher, std::move(ended));
}

void ProcessWatch::unwatch(const std::string& address, const void* watcher) {
  state_->unwatch(address, watcher);
}

void ProcessWatch::unwatch(const void* watcher) { state_->unwatch(watcher); }

ProcessWatch::Counters ProcessWatch::counters() const {
  std::lock_guard lock(state_->mutex);
  return {state_->watchers.size(), state_->watched.size(), state_->refused};
}

}  // namespace skein::brokerless_discovery
