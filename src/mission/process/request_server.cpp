#include "request_server.hpp"

#include <sys/socket.h>

#include <array>
#include <cerrno>

#include "core/system/abstract_socket.hpp"
#include "core/system/trusted_users.hpp"

namespace skein::launch {

namespace {

bool has_gone(int client) {
  pollfd end{client, 0, 0};
  return ::poll(&end, 1, 0) == 1 && (end.revents & POLLHUP) != 0;
}

}  // namespace

void RequestServer::add_to(std::vector<pollfd>& watched) const {
  if (!is_crowded_) watched.push_back({listener_, POLLIN, 0});
  for (const Client& client : clients_) watched.push_back({client.socket.get(), POLLIN, 0});
}

void RequestServer::take_clients() {
  if (listener_ < 0) return;
  is_crowded_ = !let_in(listener_, kAcceptedInARow, [&](FileDescriptor& socket) {
    const auto owner = other_end(socket);
    if (!owner || !is_own_user_or_root(owner->uid)) return;
    if (clients_.size() == kMostClients) clients_.pop_front();
    clients_.push_back({std::move(socket), ""});
  });
}

bool RequestServer::is_done(Client& client) const {
  std::array<char, kLongestRequest> text;
  const auto size = ::read(client.socket.get(), text.data(), text.size());
  if (size < 0) return errno != EAGAIN && errno != EINTR;
  client.request.append(text.data(), static_cast<std::size_t>(size));
  const auto end = client.request.find('\n');
  const bool complete = end != std::string::npos;
  if (!complete && size > 0 && client.request.size() <= kLongestRequest) return false;
  if (!complete || end > kLongestRequest) return true;
  if (has_gone(client.socket.get())) return true;  // nobody is to be surprised later
  const std::string answer = answer_(std::string_view(client.request).substr(0, end));
  // A client that does not read gets what its socket holds.
  [[maybe_unused]] const auto sent =
      ::send(client.socket.get(), answer.data(), answer.size(), MSG_NOSIGNAL);
  return true;
}

void RequestServer::serve() {
  take_clients();
  std::erase_if(clients_, [&](Client& client) { return is_done(client); });
}

}  // namespace skein::launch
