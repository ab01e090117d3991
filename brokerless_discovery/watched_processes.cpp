#include "brokerless_discovery/watched_processes.hpp"

#include <sys/socket.h>

#include <iterator>
#include <utility>

#include "brokerless_discovery/process_watch.hpp"
#include "core/system/other_process.hpp"
#include "core/system/trusted_users.hpp"

namespace skein::brokerless_discovery {

bool WatchedProcesses::watch(const std::string& address, const void* watcher, Action& action) {
  if (const auto found = watched_.find(address); found != watched_.end()) {
    found->second.actions.try_emplace(watcher, std::move(action));
    return false;
  }
  if (watched_.size() >= ProcessWatch::kMaxWatched) return false;
  Watched other;
  const Reached connected = join(other, address);
  if (connected != Reached::Yes) return connected == Reached::Nobody;
  other.actions.emplace(watcher, std::move(action));
  watched_.emplace(address, std::move(other));
  return false;
}

Reached WatchedProcesses::join(Watched& other, const std::string& address) {
  Contact contact = reach(address, is_own_user);
  if (contact.reached != Reached::Yes) return contact.reached;
  const std::uint64_t id = epoll_.add(contact.socket, EPOLLIN | EPOLLRDHUP);
  if (id == 0) return Reached::Unknown;
  other.id = id;
  other.socket = std::move(contact.socket);
  addresses_.emplace(id, address);
  other.process = other_process(other.socket).descriptor;
  other.process_id = other.process ? epoll_.add(other.process, EPOLLIN) : 0;
  if (other.process_id != 0) addresses_.emplace(other.process_id, address);
  return Reached::Yes;
}

void WatchedProcesses::unwatch(const std::string& address, const void* watcher) {
  const auto found = watched_.find(address);
  if (found == watched_.end()) return;
  found->second.actions.erase(watcher);
  if (found->second.actions.empty()) drop(found);
}

void WatchedProcesses::unwatch(const void* watcher) {
  for (auto position = watched_.begin(); position != watched_.end();) {
    position->second.actions.erase(watcher);
    position = position->second.actions.empty() ? drop(position) : std::next(position);
  }
}

void WatchedProcesses::handle(const Epoll::Event& event, std::vector<Action>& ended) {
  const auto address = addresses_.find(event.id);
  if (address == addresses_.end()) return;
  const auto position = watched_.find(address->second);
  if (event.id != position->second.process_id) return heard(position, event.events, ended);
  leave(position->second);
  tell(position, ended);
}

void WatchedProcesses::heard(Position position, std::uint32_t events, std::vector<Action>& ended) {
  Watched& other = position->second;
  char greeting;
  if (!other.greeted && recv(other.socket.get(), &greeting, 1, MSG_DONTWAIT) == 1) {
    other.greeted = true;
    epoll_.change(other.socket, other.id, EPOLLRDHUP);
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
      watched_.erase(position);
      return;
    }
  }
  tell(position, ended);
}

void WatchedProcesses::tell(Position position, std::vector<Action>& ended) {
  for (auto& [watcher, action] : position->second.actions) ended.push_back(std::move(action));
  watched_.erase(position);
}

void WatchedProcesses::leave(const Watched& other) {
  epoll_.remove(other.socket);
  if (other.process) epoll_.remove(other.process);
  addresses_.erase(other.id);
  addresses_.erase(other.process_id);
}

WatchedProcesses::Position WatchedProcesses::drop(Position position) {
  leave(position->second);
  return watched_.erase(position);
}

}  // namespace skein::brokerless_discovery
