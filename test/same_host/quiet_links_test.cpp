#include "same_host/quiet_links.hpp"

#include <atomic>
#include <catch2/catch.hpp>
#include <memory>
#include <vector>

#include "../tools/eventually.hpp"
#include "../tools/threads.hpp"
#include "core/abstract_socket.hpp"

using namespace skein;
using namespace skein::same_host;
using skein::test::eventually;
using skein::test::threads_named;
using namespace std::chrono_literals;

namespace {

/// Both ends of a connection.
struct Connection {
  Connection() {
    auto memory = SharedMemory::make(Link::kMemory);
    auto theirs = SharedMemory::map(memory.take_descriptor(), Link::kMemory);
    watched = std::make_shared<WatchedLink>(make(Link::Side::Provider, std::move(memory)));
    client = make(Link::Side::Client, std::move(theirs));
  }
  void send() const {
    REQUIRE(client->send(std::as_bytes(std::span("1", 1)), 1h) == Link::Sent::Yes);
  }
  static std::shared_ptr<Link> make(Link::Side side, SharedMemory memory) {
    return std::make_shared<Link>(side, std::make_shared<const FileDescriptor>(local_socket()),
                                  std::move(memory), Guid::random(), Guid::random(), [] {});
  }

  std::shared_ptr<WatchedLink> watched;
  std::shared_ptr<Link> client;
};

struct Watched {
  Watched() { links.reserve(2); }
  bool has_told() {
    return eventually([&] { return told.exchange(false); });
  }

  std::atomic<bool> told{false};
  QuietLinks links{"test-quiet", [this] { told = true; }};
};

}  // namespace

TEST_CASE("a link is quiet until something has come") {
  Watched watched;
  Connection some, other;
  REQUIRE(watched.links.add(some.watched));
  REQUIRE(watched.links.add(other.watched));
  CHECK(some.watched->quiet);
  some.send();
  CHECK(watched.has_told());
  CHECK_FALSE(some.watched->quiet);
  CHECK(other.watched->quiet);
  other.send();
  CHECK(watched.has_told());
  CHECK_FALSE(other.watched->quiet);
}

TEST_CASE("a link to which something has come already is not quiet") {
  Watched watched;
  Connection connection;
  connection.send();
  CHECK_FALSE(watched.links.add(connection.watched));
  CHECK_FALSE(connection.watched->quiet);
  CHECK(watched.links.size() == 0);
}

TEST_CASE("what somebody else takes from a quiet link has come all the same") {
  Watched watched;
  Connection connection;
  REQUIRE(watched.links.add(connection.watched));
  Bytes spare;
  connection.send();
  CHECK(connection.watched->link->receive(spare));
  connection.watched->link->release(spare);
  CHECK(watched.has_told());
  CHECK_FALSE(connection.watched->quiet);
}

TEST_CASE("a link can be quiet again, and its reader has left no sleep behind") {
  Watched watched;
  Connection connection;
  Bytes spare;
  for (int i = 0; i < 3; ++i) {
    REQUIRE(watched.links.add(connection.watched));
    connection.send();
    REQUIRE(watched.has_told());
    RingReader& in = connection.watched->link->in();
    CHECK(in.word() == 0);
    CHECK(connection.watched->link->receive(spare));
    connection.watched->link->release(spare);
  }
}

TEST_CASE("a link that is over is let go of") {
  Watched watched;
  Connection connection;
  REQUIRE(watched.links.add(connection.watched));
  const std::weak_ptr<WatchedLink> gone = connection.watched;
  connection.watched->over = true;
  connection.watched.reset();
  watched.links.drop_ended();
  CHECK(eventually([&] { return gone.expired(); }));
  CHECK_FALSE(watched.told);
}

TEST_CASE("as many threads as quiet links need wait for them, and end with the last") {
  {
    QuietLinks none("test-quiet", [] {});
    std::vector<Connection> connections(kMostWords);
    CHECK_FALSE(none.add(connections.front().watched));
    CHECK(eventually([] { return threads_named("test-quiet").empty(); }));
    Watched watched;
    watched.links.reserve(kMostWords);
    for (const Connection& each : connections) REQUIRE(watched.links.add(each.watched));
    CHECK(eventually([] { return threads_named("test-quiet").size() == 2; }));
    for (const Connection& each : connections) {
      each.send();
      CHECK(watched.has_told());
      CHECK_FALSE(each.watched->quiet);
    }
    watched.links.reserve(3 * kMostWords);
    CHECK(eventually([] { return threads_named("test-quiet").size() == 4; }));
  }
  CHECK(eventually([] { return threads_named("test-quiet").empty(); }));
}
