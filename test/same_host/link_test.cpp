#include "same_host/link.hpp"

#include <sched.h>

#include <catch2/catch.hpp>
#include <memory>

#include "../tools/eventually.hpp"
#include "core/abstract_socket.hpp"

using namespace skein;
using namespace skein::same_host;
using skein::test::eventually;
using namespace std::chrono_literals;

namespace {

/// Keeps this thread on the core where it is.
struct OneCore {
  OneCore() {
    sched_getaffinity(0, sizeof before, &before);
    cpu_set_t here;
    CPU_ZERO(&here);
    CPU_SET(static_cast<std::size_t>(sched_getcpu()), &here);
    REQUIRE(sched_setaffinity(0, sizeof here, &here) == 0);
  }
  ~OneCore() { sched_setaffinity(0, sizeof before, &before); }

  cpu_set_t before{};
};

/// Both ends of a connection, of which this thread plays each.
struct Connection {
  Connection() {
    auto memory = SharedMemory::make(Link::kMemory);
    auto theirs = SharedMemory::map(memory.take_descriptor(), Link::kMemory);
    server = make(Link::Side::Provider, std::move(memory));
    client = make(Link::Side::Client, std::move(theirs));
  }
  static std::shared_ptr<Link> make(Link::Side side, SharedMemory memory) {
    return std::make_shared<Link>(side, std::make_shared<const FileDescriptor>(local_socket()),
                                  std::move(memory), Guid::random(), Guid::random(), [] {});
  }
  static void send(Link& from) {
    REQUIRE(from.send(std::as_bytes(std::span("1", 1)), 1h) == Link::Sent::Yes);
  }
  void take(Link& from) {
    REQUIRE(from.receive(spare));
    from.release(spare);
  }
  /// The next request is answered, while the client sleeps if it has nothing; whether it still
  /// does.
  bool answer_lets_sleep() {
    while (!client->in().prepare_to_sleep()) take(*client);
    take(*server);
    const Link::Answering answering(*server);
    send(*server);
    return client->in().word() != 0;
  }

  std::shared_ptr<Link> server;
  std::shared_ptr<Link> client;
  Bytes spare;
};

}  // namespace

TEST_CASE("a client that sleeps where its requests are answered is woken for several answers") {
  const OneCore one_core;
  Connection connection;
  for (int i = 0; i < 3; ++i) connection.send(*connection.client);
  CHECK_FALSE(connection.answer_lets_sleep());  // nobody knows yet how long answers take
  // On a busy machine the next one may come late.
  REQUIRE(eventually([&] {
    connection.send(*connection.client);
    return connection.answer_lets_sleep();
  }));
  connection.server->wake_peer();
  CHECK(connection.client->in().word() == 0);
}

TEST_CASE("a client is woken by the answer to its last request") {
  const OneCore one_core;
  Connection connection;
  for (int i = 0; i < 100; ++i) connection.send(*connection.client);
  for (int i = 0; i < 99; ++i) connection.answer_lets_sleep();
  CHECK_FALSE(connection.answer_lets_sleep());
}

TEST_CASE("a client is woken at once by what is no answer, or comes from another thread") {
  const OneCore one_core;
  Connection connection;
  for (int i = 0; i < 20; ++i) {
    connection.send(*connection.client);
    connection.send(*connection.client);
    while (!connection.client->in().prepare_to_sleep()) connection.take(*connection.client);
    connection.send(*connection.server);
    CHECK(connection.client->in().word() == 0);
  }
}
