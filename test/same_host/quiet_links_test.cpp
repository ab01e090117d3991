#include "same_host/quiet_links.hpp"

#include <atomic>
#include <catch2/catch.hpp>
#include <memory>
#include <vector>

#include "link_pair.hpp"
#include "test/tools/eventually.hpp"
#include "test/tools/threads.hpp"

using namespace skein;
using namespace skein::same_host;
using skein::test::eventually;
using skein::test::LinkPair;
using skein::test::threads_named;

namespace {

/// A connection whose server is waited for.
struct WatchedPair : LinkPair {
  std::shared_ptr<WatchedLink> watched = std::make_shared<WatchedLink>(server);
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
  WatchedPair some, other;
  REQUIRE(watched.links.add(some.watched));
  REQUIRE(watched.links.add(other.watched));
  CHECK(some.watched->quiet);
  some.request();
  CHECK(watched.has_told());
  CHECK_FALSE(some.watched->quiet);
  CHECK(other.watched->quiet);
  other.request();
  CHECK(watched.has_told());
  CHECK_FALSE(other.watched->quiet);
}

TEST_CASE("a link to which something has come already is not quiet") {
  Watched watched;
  WatchedPair connection;
  connection.request();
  CHECK_FALSE(watched.links.add(connection.watched));
  CHECK_FALSE(connection.watched->quiet);
  CHECK(watched.links.size() == 0);
}

TEST_CASE("what somebody else takes from a quiet link has come all the same") {
  Watched watched;
  WatchedPair connection;
  REQUIRE(watched.links.add(connection.watched));
  connection.request();
  connection.take_request();
  CHECK(watched.has_told());
  CHECK_FALSE(connection.watched->quiet);
}

TEST_CASE("a link can be quiet again, and its reader has left no sleep behind") {
  Watched watched;
  WatchedPair connection;
  for (int i = 0; i < 3; ++i) {
    REQUIRE(watched.links.add(connection.watched));
    connection.request();
    REQUIRE(watched.has_told());
    CHECK(connection.server->in().word() == 0);
    connection.take_request();
  }
}

TEST_CASE("a link that is over is let go of") {
  Watched watched;
  WatchedPair connection;
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
    std::vector<WatchedPair> connections(kMostWords);
    CHECK_FALSE(none.add(connections.front().watched));
    CHECK(eventually([] { return threads_named("test-quiet").empty(); }));
    Watched watched;
    watched.links.reserve(kMostWords);
    for (const WatchedPair& each : connections) REQUIRE(watched.links.add(each.watched));
    CHECK(eventually([] { return threads_named("test-quiet").size() == 2; }));
    for (const WatchedPair& each : connections) {
      each.request();
      CHECK(watched.has_told());
      CHECK_FALSE(each.watched->quiet);
    }
    watched.links.reserve(3 * kMostWords);
    CHECK(eventually([] { return threads_named("test-quiet").size() == 4; }));
  }
  CHECK(eventually([] { return threads_named("test-quiet").empty(); }));
}
