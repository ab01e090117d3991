#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <string_view>

#include "core/system/epoll.hpp"
#include "core/system/local_server.hpp"

namespace skein::launch {

/// Answers requests of one line that come over a Unix socket: from processes of this user and of
/// root alone, a few at a time, and of bounded length. It never waits: its owner polls its
/// descriptor. A request is not carried out if its client has gone.
class RequestServer {
 public:
  static constexpr std::size_t kMostClients = 8;
  static constexpr std::size_t kLongestRequest = 1024;
  using Answer = std::function<std::string(std::string_view request)>;
  using Time = LocalServer::Time;

  /// Throws SystemError if the kernel gives no descriptor.
  RequestServer();

  /// See LocalServer.
  bool open(ListeningSocket& socket, const std::string& name);

  /// Readable if serve() has something to do.
  int descriptor() const noexcept { return epoll_.descriptor(); }

  /// Takes new clients and answers complete requests. Returns when to call it again
  /// even if nothing comes, if it accepts nobody for a while.
  std::optional<Time> serve(Time now, const Answer& answer);

 private:
  struct Client {
    FileDescriptor socket;
    std::string request;
  };
  using Clients = std::map<std::uint64_t, Client>;  // the oldest first

  std::uint64_t take(FileDescriptor& socket);  // the client's id; 0 if the kernel refuses it
  void drop(Clients::iterator client);

  Epoll epoll_;
  LocalServer server_;
  Clients clients_;
};

}  // namespace skein::launch
