#include "core/system/local_server.hpp"

#include <algorithm>
#include <utility>

namespace skein {

bool LocalServer::open(ListeningSocket& socket, const std::string& name, int backlog) {
  if (!listen_at(socket, name, backlog)) return false;
  const std::uint64_t id = epoll_.add(socket, paused_until_ ? 0U : std::uint32_t{EPOLLIN});
  if (id == 0) return false;
  listeners_.emplace(id, Listener{name, std::move(socket)});
  return true;
}

void LocalServer::close(const std::string& name) {
  std::erase_if(listeners_, [&](const auto& each) {
    if (each.second.name != name) return false;
    epoll_.remove(each.second.socket);
    return true;
  });
}

bool LocalServer::listens_at(const std::string& name) const {
  return std::ranges::any_of(listeners_,
                             [&](const auto& each) { return each.second.name == name; });
}

bool LocalServer::handle(std::uint64_t event, Time now, const Take& take) {
  const auto listener = listeners_.find(event);
  if (listener == listeners_.end()) return false;
  const std::uint64_t before = refused_;
  const bool served =
      let_in(listener->second.socket.get(), kAcceptedInARow, [&](FileDescriptor& socket) {
        const auto client = other_end(socket);
        if (client && trusts_(*client)) take(socket, *client);
        if (socket) ++refused_;
      });
  if (!served) {
    pause(now + kAfterShortage);
  } else if (refused_ > before) {
    pause(now + kAfterRefusal);
  }
  return true;
}

void LocalServer::pause(Time until) {
  paused_until_ = until;
  for (const auto& [id, listener] : listeners_) epoll_.change(listener.socket, id, 0);
}

std::optional<LocalServer::Time> LocalServer::resume(Time now) {
  if (paused_until_ && now >= *paused_until_) {
    paused_until_.reset();
    for (const auto& [id, listener] : listeners_) epoll_.change(listener.socket, id, EPOLLIN);
  }
  return paused_until_;
}

}  // namespace skein
