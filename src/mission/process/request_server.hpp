#pragma once

#include <poll.h>

#include <deque>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "core/system/file_descriptor.hpp"

namespace skein::launch {

/// Answers requests of one line that come over a listening Unix socket: from processes of this user
/// and of root alone, a few at a time, and of bounded length. It never waits: whoever calls it
/// polls its descriptors. A request whose client has gone is not carried out.
class RequestServer {
 public:
  static constexpr std::size_t kMostClients = 8;
  static constexpr std::size_t kLongestRequest = 1024;
  using Answer = std::function<std::string(std::string_view request)>;

  /// `listener` is non-blocking and outlives this object; negative: nobody ever asks.
  RequestServer(int listener, Answer answer) : listener_(listener), answer_(std::move(answer)) {}

  void add_to(std::vector<pollfd>& watched) const;
  /// Whether it lets nobody in, for want of descriptors, and its caller is to call serve() again
  /// after kAfterShortage.
  bool is_crowded() const noexcept { return is_crowded_; }
  /// Takes new clients and answers those whose request has come.
  void serve();

 private:
  struct Client {
    FileDescriptor socket;
    std::string request;
  };

  void take_clients();
  bool is_done(Client& client) const;

  int listener_;
  Answer answer_;
  std::deque<Client> clients_;
  bool is_crowded_ = false;
};

}  // namespace skein::launch
