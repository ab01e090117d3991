#pragma once

#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <cstring>
#include <ctime>
#include <string>
#include <utility>
#include <vector>

#include "core/system/file_descriptor.hpp"

namespace skein::test {

/// A TCP connection whose close() takes as long as the other end likes, at most kLinger: what was
/// sent is not acknowledged. Another process may hand it over to hold up the one that closes it.
class LingeringConnection {
 public:
  /// Longer than any test waits.
  static constexpr int kLinger = 100;

  LingeringConnection() {
    const FileDescriptor listening(::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0));
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    socklen_t size = sizeof address;
    auto* const bound = reinterpret_cast<sockaddr*>(&address);
    ::bind(listening.get(), bound, size);
    ::setsockopt(listening.get(), SOL_SOCKET, SO_RCVBUF, &kFew, sizeof kFew);
    ::listen(listening.get(), 1);
    ::getsockname(listening.get(), bound, &size);
    own_ = FileDescriptor(::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0));
    ::setsockopt(own_.get(), SOL_SOCKET, SO_SNDBUF, &kFew, sizeof kFew);
    ::connect(own_.get(), bound, size);
    other_ = FileDescriptor(::accept4(listening.get(), nullptr, nullptr, SOCK_CLOEXEC));
    const linger lingers{1, kLinger};
    ::setsockopt(own_.get(), SOL_SOCKET, SO_LINGER, &lingers, sizeof lingers);
    const std::vector<char> much(1 << 20);
    while (::send(own_.get(), much.data(), much.size(), MSG_DONTWAIT) > 0) {
    }
  }

  /// The only descriptor of it, once.
  FileDescriptor take() { return std::move(own_); }

  /// Hands it over through a local socket, together with `text` and `before`. Whether it was sent.
  bool hand_over(int socket, std::string text = "!", std::vector<int> before = {}) {
    before.push_back(own_.get());
    const std::size_t octets = before.size() * sizeof(int);
    iovec content{text.data(), text.size()};
    std::vector<char> control(CMSG_SPACE(octets));
    msghdr message{};
    message.msg_iov = &content;
    message.msg_iovlen = 1;
    message.msg_control = control.data();
    message.msg_controllen = control.size();
    cmsghdr* const header = CMSG_FIRSTHDR(&message);
    header->cmsg_level = SOL_SOCKET;
    header->cmsg_type = SCM_RIGHTS;
    header->cmsg_len = CMSG_LEN(octets);
    std::memcpy(CMSG_DATA(header), before.data(), octets);
    const bool sent =
        ::sendmsg(socket, &message, MSG_NOSIGNAL) == static_cast<ssize_t>(text.size());
    if (sent) close_own();
    return sent;
  }

  /// Hands it over to a process that turns away each client that `connect` makes, and waits until
  /// that has seen it. Some clients may be turned away before they can hand over anything.
  template <class Connect>
  bool hand_over_to_refuser(const Connect& connect) {
    FileDescriptor client = connect();
    for (int i = 0; i < 10'000 && !hand_over(client.get()); ++i) client = connect();
    pollfd turned_away{client.get(), POLLRDHUP, 0};
    return !own_ && ::poll(&turned_away, 1, 20'000) == 1;
  }

  /// Lets who closes it go on.
  void release() { other_.reset(); }

 private:
  /// The one on its way is another, so that this does not wait; unless the receiver has closed that
  /// already: then a signal ends the wait after a second.
  void close_own() {
    struct sigaction interrupts {};
    struct sigaction before {};
    interrupts.sa_handler = [](int) {};
    ::sigaction(SIGALRM, &interrupts, &before);
    sigevent alarm{};
    alarm.sigev_notify = SIGEV_THREAD_ID;
    alarm.sigev_signo = SIGALRM;
    alarm._sigev_un._tid = ::gettid();
    const itimerspec each_second{{1, 0}, {1, 0}};
    timer_t timer{};
    ::timer_create(CLOCK_MONOTONIC, &alarm, &timer);
    ::timer_settime(timer, 0, &each_second, nullptr);
    own_.reset();
    ::timer_delete(timer);
    ::sigaction(SIGALRM, &before, nullptr);
  }

  static constexpr int kFew = 4096;  // octets to fill the connection

  FileDescriptor own_;
  FileDescriptor other_;
};

/// Whether nobody's close() of a LingeringConnection held up `act`.
template <class Act>
bool returns_at_once(const Act& act) {
  const auto begin = std::chrono::steady_clock::now();
  act();
  return std::chrono::steady_clock::now() - begin <
         std::chrono::seconds(LingeringConnection::kLinger) / 2;
}

}  // namespace skein::test
