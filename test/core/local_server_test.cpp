#include "core/system/local_server.hpp"

#include <poll.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <catch2/catch.hpp>
#include <cerrno>
#include <chrono>
#include <string>
#include <vector>

#include "skein/guid.hpp"
#include "test/tools/eventually.hpp"
#include "test/tools/forked_copy.hpp"

using namespace skein;
using namespace std::chrono_literals;
using skein::test::eventually;

namespace {

struct Served {
  std::string name = "skein-test/" + Guid::random().hex();
  bool trusts = true;
  LocalServer::Time now{};
  std::vector<FileDescriptor> clients{};
  Epoll epoll{};
  LocalServer server{epoll, [this](const ucred&) { return trusts; }};

  Served() { REQUIRE(open(name) == 0); }

  /// Returns 0, or the error.
  int open(const std::string& at) {
    ListeningSocket socket(local_socket());
    return server.open(socket, at) ? 0 : errno;
  }

  Contact connect() const {
    return reach(name, [](uid_t) { return true; });
  }

  /// Returns whether the kernel reported anything.
  bool serve() {
    const auto events = epoll.wait(0ms);
    for (const auto& event : events) {
      server.handle(event.id, now, [&](FileDescriptor& socket, const ucred& client) {
        CHECK(client.pid == getpid());
        clients.push_back(std::move(socket));
      });
    }
    return !events.empty();
  }
};

}  // namespace

TEST_CASE("a server accepts clients at each of its names until it is closed") {
  Served served;
  const std::string second = "skein-test/" + Guid::random().hex();
  REQUIRE(served.open(second) == 0);
  CHECK(served.open(second) == EADDRINUSE);
  const Contact at_first = served.connect();
  const Contact at_second = reach(second, [](uid_t) { return true; });
  CHECK(served.serve());
  CHECK(served.clients.size() == 2);
  CHECK_FALSE(served.serve());

  served.server.close(second);
  CHECK_FALSE(served.server.listens_at(second));
  CHECK(served.server.listens_at(served.name));
  CHECK(reach(second, [](uid_t) { return true; }).reached == Reached::Nobody);
}

TEST_CASE("a server that has turned a client away accepts nobody for a while") {
  Served served;
  served.trusts = false;
  const Contact stranger = served.connect();
  REQUIRE(served.serve());
  CHECK(served.clients.empty());
  CHECK(served.server.refused() == 1);
  pollfd look{stranger.socket.get(), POLLRDHUP, 0};
  CHECK(eventually([&] { return poll(&look, 1, 0) == 1; }));

  served.trusts = true;
  const Contact next = served.connect();
  const auto until = served.server.resume(served.now);
  REQUIRE(until == served.now + kAfterRefusal);
  served.now = *until - 1ns;
  CHECK(served.server.resume(served.now) == until);
  CHECK_FALSE(served.serve());
  served.now = *until;
  CHECK_FALSE(served.server.resume(served.now));
  CHECK(served.serve());
  CHECK(served.clients.size() == 1);
}

TEST_CASE("a name that is opened during the pause takes part in it") {
  Served served;
  served.trusts = false;
  const Contact stranger = served.connect();
  REQUIRE(served.serve());
  served.name = "skein-test/" + Guid::random().hex();
  REQUIRE(served.open(served.name) == 0);
  const Contact next = served.connect();
  CHECK_FALSE(served.serve());
  served.server.resume(served.now + kAfterRefusal);
  CHECK(served.serve());
}

TEST_CASE("a server without a free descriptor leaves its clients waiting, and tries again") {
  Served served;
  const Contact client = served.connect();
  rlimit before{};
  REQUIRE(getrlimit(RLIMIT_NOFILE, &before) == 0);
  const rlimit none{0, before.rlim_max};
  setrlimit(RLIMIT_NOFILE, &none);
  served.serve();
  const bool again = served.serve();
  setrlimit(RLIMIT_NOFILE, &before);
  CHECK_FALSE(again);
  CHECK(served.clients.empty());
  CHECK(served.server.refused() == 0);
  const auto until = served.server.resume(served.now);
  REQUIRE(until == served.now + kAfterShortage);
  served.server.resume(*until);
  CHECK(served.serve());
  CHECK(served.clients.size() == 1);
}

TEST_CASE("nothing is reported of a closed name of which a forked child has the socket") {
  Served served;
  const skein::test::ForkedCopy child;
  served.server.close(served.name);
  CHECK_FALSE(served.serve());
}
