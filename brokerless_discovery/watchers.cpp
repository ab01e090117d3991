#include "brokerless_discovery/watchers.hpp"

#include <sys/socket.h>

#include <utility>

#include "brokerless_discovery/process_watch.hpp"

namespace skein::brokerless_discovery {

void Watchers::greet(FileDescriptor& socket, pid_t process) {
  if (watchers_.size() >= ProcessWatch::kMaxWatchers) return;
  const auto of_one = of_process_.find(process);
  if (of_one != of_process_.end() && of_one->second >= ProcessWatch::kMaxWatchersOfOne) return;
  const std::uint64_t id = epoll_.add(socket, EPOLLRDHUP);
  if (id == 0) return;
  if (send(socket.get(), "!", 1, MSG_NOSIGNAL) != 1) return epoll_.remove(socket);
  ++of_process_[process];
  watchers_.emplace(id, Watcher{process, std::move(socket)});
}

bool Watchers::handle(std::uint64_t event) {
  const auto node = watchers_.extract(event);
  if (!node) return false;
  epoll_.remove(node.mapped().socket);
  const auto of_one = of_process_.find(node.mapped().process);
  if (--of_one->second == 0) of_process_.erase(of_one);
  return true;
}

}  // namespace skein::brokerless_discovery
