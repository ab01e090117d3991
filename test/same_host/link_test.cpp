#include "same_host/link.hpp"

#include <catch2/catch.hpp>
#include <chrono>
#include <cstddef>
#include <initializer_list>
#include <vector>

#include "link_pair.hpp"
#include "test/tools/eventually.hpp"
#include "test/tools/one_core.hpp"

using namespace skein;
using namespace skein::same_host;
using skein::test::eventually;
using skein::test::LinkPair;
using skein::test::OneCore;

namespace {

/// Who answers the requests of connections, on this thread.
struct Server {
  /// The next request of one, whose client sleeps if it has nothing; whether it still does.
  bool answer_lets_sleep(const LinkPair& connection, bool others_wait = false) {
    while (!connection.client->in().ring().prepare_to_sleep()) connection.take_answer();
    connection.take_request();
    const LinkWriter::Answering answering(connection.server->out(), connection.server->in().ring(),
                                          sleepers, others_wait);
    connection.answer();
    return sleeps(connection);
  }
  static bool sleeps(const LinkPair& connection) {
    return connection.client->in().ring().word() != 0;
  }

  void wake(std::initializer_list<const LinkPair*> connections) {
    sleepers.clear();
    Wakes wakes;
    for (const LinkPair* each : connections) each->server->out().wake_peer(wakes);
  }

  bool replaced = false;
  Sleepers sleepers{[this] { return replaced; }};
};

}  // namespace

// On a busy machine calls may take too long to let anybody sleep.
TEST_CASE("a client that sleeps where its requests are answered is woken for several answers") {
  const OneCore one_core;
  const LinkPair connection;
  Server server;
  connection.request();
  REQUIRE(eventually([&] {
    connection.request();
    return server.answer_lets_sleep(connection);
  }));
  server.wake({&connection});
  CHECK_FALSE(Server::sleeps(connection));
}

TEST_CASE("clients that sleep where their requests are answered are woken together") {
  const OneCore one_core;
  const LinkPair connections[3];
  const LinkPair& first = connections[0];
  const LinkPair& second = connections[1];
  const LinkPair& last = connections[2];
  Server server;
  REQUIRE(eventually([&] {
    for (const LinkPair& each : connections) each.request();
    const bool first_sleeps = server.answer_lets_sleep(first, true);
    const bool second_sleeps = server.answer_lets_sleep(second, true);
    const bool last_sleeps = server.answer_lets_sleep(last);
    if (first_sleeps && second_sleeps && last_sleeps) return true;
    server.wake({&first, &second, &last});
    return false;
  }));
  CHECK(server.sleepers.any());
  server.wake({&first, &second, &last});
  for (const LinkPair& each : connections) CHECK_FALSE(Server::sleeps(each));
}

TEST_CASE("a client is woken by the answer to the last request of all") {
  const OneCore one_core;
  const LinkPair connection;
  Server server;
  connection.request();
  CHECK_FALSE(server.answer_lets_sleep(connection));
}

TEST_CASE("a client is woken at once while one has been let sleep for long") {
  const OneCore one_core;
  const LinkPair some, other;
  Server server;
  REQUIRE(eventually([&] {
    some.request();
    return server.answer_lets_sleep(some, true);
  }));
  REQUIRE(eventually([&] { return server.sleepers.due(); }));
  for (int i = 0; i < 10; ++i) {  // The first call is too long, the others are quick.
    other.request();
    CHECK_FALSE(server.answer_lets_sleep(other, true));
  }
}

TEST_CASE("a client is woken at once where another thread goes on") {
  const OneCore one_core;
  const LinkPair connection;
  Server server;
  server.replaced = true;
  CHECK(eventually([&] {
    server.sleepers.clear();
    connection.request();
    REQUIRE_FALSE(server.answer_lets_sleep(connection, true));
    return server.sleepers.any();  // It would have been let sleep.
  }));
}

TEST_CASE("a client is woken at once where there is no room for its answer") {
  const OneCore one_core;
  const LinkPair connection;
  Server server;
  const std::vector<std::byte> longer(2 * Link::kCapacity);
  connection.request();
  REQUIRE(connection.client->in().ring().prepare_to_sleep());
  const LinkWriter::Answering answering(connection.server->out(), connection.server->in().ring(),
                                        server.sleepers, true);
  CHECK(connection.server->out().send(longer, std::chrono::milliseconds(1)) ==
        LinkWriter::Sent::NoRoom);
  CHECK_FALSE(Server::sleeps(connection));
}

TEST_CASE("a client is woken at once by what is no answer, or comes from another thread") {
  const OneCore one_core;
  const LinkPair connection;
  for (int i = 0; i < 20; ++i) {
    connection.request();
    connection.request();
    while (!connection.client->in().ring().prepare_to_sleep()) connection.take_answer();
    connection.answer();
    CHECK_FALSE(Server::sleeps(connection));
  }
}
