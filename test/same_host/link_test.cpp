#include "same_host/link.hpp"

#include <sched.h>

#include <catch2/catch.hpp>

#include "../tools/eventually.hpp"
#include "connection.hpp"

using namespace skein;
using namespace skein::same_host;
using skein::test::Connection;
using skein::test::eventually;

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

/// The server answers the next request, while the client sleeps if it has nothing; whether it
/// still does.
bool answer_lets_sleep(const Connection& connection) {
  while (!connection.client->in().prepare_to_sleep()) connection.take_answer();
  connection.take_request();
  const Link::Answering answering(*connection.server);
  connection.answer();
  return connection.client->in().word() != 0;
}

}  // namespace

TEST_CASE("a client that sleeps where its requests are answered is woken for several answers") {
  const OneCore one_core;
  const Connection connection;
  for (int i = 0; i < 3; ++i) connection.request();
  CHECK_FALSE(answer_lets_sleep(connection));  // nobody knows yet how long answers take
  // On a busy machine the next one may come late.
  REQUIRE(eventually([&] {
    connection.request();
    return answer_lets_sleep(connection);
  }));
  connection.server->wake_peer();
  CHECK(connection.client->in().word() == 0);
}

TEST_CASE("a client is woken by the answer to its last request") {
  const OneCore one_core;
  const Connection connection;
  for (int i = 0; i < 100; ++i) connection.request();
  for (int i = 0; i < 99; ++i) answer_lets_sleep(connection);
  CHECK_FALSE(answer_lets_sleep(connection));
}

TEST_CASE("a client is woken at once by what is no answer, or comes from another thread") {
  const OneCore one_core;
  const Connection connection;
  for (int i = 0; i < 20; ++i) {
    connection.request();
    connection.request();
    while (!connection.client->in().prepare_to_sleep()) connection.take_answer();
    connection.answer();
    CHECK(connection.client->in().word() == 0);
  }
}
