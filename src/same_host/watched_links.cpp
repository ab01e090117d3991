#include "watched_links.hpp"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <string>

#include "core/system/other_process.hpp"
#include "skein/error.hpp"

namespace skein::same_host {

void refuse_to_meet() {
  throw Unavailable(std::string("cannot open the socket by which callers on this host come: ") +
                    std::strerror(errno));
}

void WatchedLinks::add(const std::shared_ptr<Link>& link, std::optional<pid_t> guest) {
  const auto& socket = link->socket();
  auto added = std::make_shared<Watched>(
      Watched{0, socket, 0, other_process(*socket).descriptor, link, guest});
  added->id = epoll_.add(*socket, EPOLLRDHUP);
  if (added->id == 0) refuse_to_meet();
  if (added->process) added->process_id = epoll_.add(added->process, EPOLLIN);
  links_.emplace(added->id, added);
  if (added->process_id != 0) links_.emplace(added->process_id, added);
  if (guest) ++guests_;
}

std::shared_ptr<Link> WatchedLinks::remove(std::uint64_t id) {
  const auto found = links_.find(id);
  if (found == links_.end()) return nullptr;
  const auto ended = found->second;
  // A copy of the descriptor, in a child, must not tell of it for ever.
  epoll_.remove(*ended->socket);
  if (ended->process_id != 0) epoll_.remove(ended->process);
  links_.erase(ended->id);
  links_.erase(ended->process_id);
  if (ended->guest) --guests_;
  return ended->link.lock();
}

std::size_t WatchedLinks::guests_of(pid_t process) const {
  return static_cast<std::size_t>(std::ranges::count_if(links_, [&](const auto& each) {
    return each.first == each.second->id && each.second->guest == process;
  }));
}

bool WatchedLinks::has_guest(const Guid& client) const {
  return std::ranges::any_of(links_, [&](const auto& each) {
    if (!each.second->guest || each.first != each.second->id) return false;
    const auto link = each.second->link.lock();
    return link && link->peer() == client;
  });
}

}  // namespace skein::same_host
