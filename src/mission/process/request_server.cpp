#include "request_server.hpp"

#include <poll.h>
#include <sys/socket.h>

#include <array>
#include <cerrno>
#include <chrono>
#include <utility>
#include <vector>

#include "core/system/trusted_users.hpp"
#include "wake_up.hpp"

namespace skein::launch {

namespace {

constexpr int kWaitingClients =
    128;  // some stay free for own clients while strangers are kept waiting

bool has_gone(int client) {
  pollfd end{client, 0, 0};
  return ::poll(&end, 1, 0) == 1 && (end.revents & POLLHUP) != 0;
}

/// Reads from the client, and answers a complete request. Returns whether the client is done.
bool hear_client(int client, std::string& request, const RequestServer::Answer& answer) {
  constexpr std::size_t kLongest = RequestServer::kLongestRequest;
  std::array<char, kLongest> part;
  const auto size = ::read(client, part.data(), part.size());
  if (size < 0) return errno != EAGAIN && errno != EINTR;
  request.append(part.data(), static_cast<std::size_t>(size));
  const auto end = request.find('\n');
  const bool complete = end != std::string::npos;
  if (!complete && size > 0 && request.size() <= kLongest) return false;
  if (!complete || end > kLongest) return true;
  if (has_gone(client)) return true;  // nobody is to be surprised later
  const std::string text = answer(std::string_view(request).substr(0, end));
  // A client that does not read gets as much as its socket holds.
  [[maybe_unused]] const auto sent = ::send(client, text.data(), text.size(), MSG_NOSIGNAL);
  return true;
}

}  // namespace

RequestServer::RequestServer()
    : server_(epoll_, [](const ucred& client) { return is_own_user_or_root(client.uid); }) {
  if (!epoll_) throw_system_error("an epoll descriptor");
}

bool RequestServer::open(ListeningSocket& socket, const std::string& name) {
  return server_.open(socket, name, kWaitingClients);
}

std::optional<RequestServer::Time> RequestServer::serve(Time now, const Answer& answer) {
  std::vector<std::uint64_t> due;
  const auto accept = [&](FileDescriptor& socket, const ucred&) {
    // The request of a new client is often there already.
    if (const auto id = take(socket)) due.push_back(id);
  };
  for (const auto& event : epoll_.wait(std::chrono::milliseconds(0)))
    if (!server_.handle(event.id, now, accept)) due.push_back(event.id);
  for (const std::uint64_t id : due) {
    const auto found = clients_.find(id);
    if (found == clients_.end()) continue;
    auto& [socket, request] = found->second;
    if (hear_client(socket.get(), request, answer)) drop(found);
  }
  return server_.resume(now);
}

std::uint64_t RequestServer::take(FileDescriptor& socket) {
  const std::uint64_t id = epoll_.add(socket, EPOLLIN);
  if (id == 0) return 0;
  if (clients_.size() == kMostClients) drop(clients_.begin());
  clients_.emplace(id, Client{std::move(socket), ""});
  return id;
}

void RequestServer::drop(Clients::iterator client) {
  epoll_.remove(client->second.socket);
  clients_.erase(client);
}

}  // namespace skein::launch
