#include "brokerless_discovery/watchers.hpp"

#include <signal.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <catch2/catch.hpp>
#include <chrono>
#include <utility>

#include "test/tools/eventually.hpp"
#include "test/tools/forked_copy.hpp"

using namespace skein::brokerless_discovery;
using skein::Epoll;
using skein::FileDescriptor;

namespace {

/// This process's end of a connection, and that of the process that watches it.
std::pair<FileDescriptor, FileDescriptor> connection() {
  std::array<int, 2> ends{};
  REQUIRE(socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends.data()) == 0);
  return {FileDescriptor(ends[0]), FileDescriptor(ends[1])};
}

}  // namespace

TEST_CASE("a watcher is greeted, and forgotten when it hangs up", "[R27]") {
  Epoll epoll;
  Watchers watchers(epoll);
  auto [own, other] = connection();
  watchers.greet(own, getpid());
  CHECK_FALSE(own);
  CHECK(watchers.count() == 1);
  char greeting = 0;
  CHECK(recv(other.get(), &greeting, 1, MSG_DONTWAIT) == 1);
  CHECK(greeting == '!');

  other.reset();
  const auto events = epoll.wait(skein::test::kPatience);
  REQUIRE(events.size() == 1);
  CHECK(watchers.handle(events.front().id));
  CHECK(watchers.count() == 0);
  CHECK_FALSE(watchers.handle(events.front().id));
}

TEST_CASE("a watcher that cannot be greeted keeps its socket, of which nothing is reported",
          "[R27]") {
  Epoll epoll;
  Watchers watchers(epoll);
  auto [own, other] = connection();
  other.reset();
  watchers.greet(own, getpid());
  CHECK(own);
  CHECK(watchers.count() == 0);
  CHECK(epoll.wait(std::chrono::milliseconds(0)).empty());
}

TEST_CASE("a hang-up is reported once, also if a forked child has a copy of the socket", "[R27]") {
  Epoll epoll;
  Watchers watchers(epoll);
  auto [own, other] = connection();
  watchers.greet(own, getpid());
  const skein::test::ForkedCopy child;
  shutdown(other.get(), SHUT_RDWR);  // the child has a copy of this end, too
  for (const auto& event : epoll.wait(skein::test::kPatience)) watchers.handle(event.id);
  CHECK(watchers.count() == 0);
  CHECK(epoll.wait(std::chrono::milliseconds(0)).empty());
}
