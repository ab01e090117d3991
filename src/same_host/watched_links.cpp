#include "watched_links.hpp"

#include <algorithm>
#include <utility>

#include "core/system/other_process.hpp"
#include "meeting_epoll.hpp"

namespace skein::same_host {

void WatchedLinks::add(const std::shared_ptr<Link>& link, std::optional<pid_t> guest,
                       std::uint64_t& last_id) {
  const auto& socket = link->socket();
  auto added = std::make_shared<Watched>(
      Watched{++last_id, socket, ++last_id, other_process(*socket).descriptor, link, guest});
  if (!control_epoll(epoll_, EPOLL_CTL_ADD, *socket, added->id, EPOLLRDHUP)) refuse_to_meet();
  if (added->process) {
    control_epoll(epoll_, EPOLL_CTL_ADD, added->process, added->process_id, EPOLLIN);
  }
  links_.emplace(added->id, added);
  links_.emplace(added->process_id, added);
  if (guest) ++guests_;
}

std::shared_ptr<Link> WatchedLinks::remove(std::uint64_t id) {
  const auto found = links_.find(id);
  if (found == links_.end()) return nullptr;
  const auto ended = found->second;
  // A copy of the descriptor, in a child, must not tell of it for ever.
  control_epoll(epoll_, EPOLL_CTL_DEL, *ended->socket, ended->id, 0);
  if (ended->process) control_epoll(epoll_, EPOLL_CTL_DEL, ended->process, ended->process_id, 0);
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
