#include "rpc/service/fair_queue.hpp"

#include <catch2/catch.hpp>
#include <string>

#include "rpc/service/service.hpp"
#include "skein/error.hpp"
#include "test/connector/echo_service.hpp"

using namespace skein;
using rpc::FairQueue;
using rpc::Invocation;

namespace {

Guid client(char name) {
  Guid guid;
  guid.bytes[0] = static_cast<std::uint8_t>(name);
  return guid;
}

std::shared_ptr<Invocation> call_of(char name) {
  auto invocation = std::make_shared<Invocation>();
  invocation->connection = client(name);
  return invocation;
}

std::size_t fill(FairQueue& queue, char name) {
  std::size_t count = 0;
  for (; queue.has_room(client(name)); ++count) queue.push(call_of(name));
  return count;
}

std::string drain(FairQueue& queue) {
  std::string order;
  while (const auto next = queue.pop()) order += static_cast<char>(next->connection.bytes[0]);
  return order;
}

/// A service whose calls run when the test says so.
struct Office {
  explicit Office(std::size_t queue) {
    rpc::Service::Options options;
    options.queue = queue;
    service = std::make_shared<rpc::Service>(std::make_shared<::test::LouderEcho::Skeleton>(
                                                 std::make_shared<skein::test::EchoService>()),
                                             executor, clock, options);
  }

  /// False where it was refused as Overloaded.
  bool submit(char name) {
    const OperationInfo& echo = service->interface_info().operations[0];
    auto invocation = call_of(name);
    invocation->operation = &echo;
    invocation->in = {echo.in->make(), echo.in->destroy};
    invocation->deadline = clock.now() + std::chrono::seconds(1);
    invocation->respond = [this, name](const void* out, std::exception_ptr) {
      (out ? answered : failed) += name;
    };
    try {
      service->submit(invocation);
      return true;
    } catch (const Overloaded&) {
      return false;
    }
  }

  ManualClock clock;
  ManualExecutor executor;
  std::shared_ptr<rpc::Service> service;
  std::string answered;
  std::string failed;
};

}  // namespace

TEST_CASE("connections take turns, and each keeps its order") {
  FairQueue queue(100);
  for (const char name : std::string("aaaaabbc")) queue.push(call_of(name));
  CHECK(queue.size() == 8);
  CHECK(drain(queue) == "abcabaaa");
  CHECK(queue.size() == 0);
  std::vector<std::shared_ptr<Invocation>> calls;
  for (int i = 0; i < 4; ++i) queue.push(calls.emplace_back(call_of('a')));
  for (const auto& call : calls) CHECK(queue.pop() == call);
}

TEST_CASE("a connection that comes late waits for one call of each of the others at most") {
  FairQueue queue(100);
  for (const char name : std::string("aaabbb")) queue.push(call_of(name));
  CHECK(queue.pop()->connection == client('a'));
  queue.push(call_of('c'));
  CHECK(drain(queue) == "bacbab");
}

TEST_CASE("however many connections take all the room they get, there is room for one more") {
  FairQueue queue(64);
  CHECK(fill(queue, 'a') == 32);
  CHECK(fill(queue, 'b') == 16);
  CHECK(fill(queue, 'c') == 8);
  CHECK_FALSE(queue.has_room(client('a')));
  CHECK(queue.has_room(client('d')));
  for (char name = 'd'; queue.size() < 64; ++name) REQUIRE(fill(queue, name) > 0);
  CHECK_FALSE(queue.has_room(client('z')));
  CHECK(drain(queue).size() == 64);
}

TEST_CASE("a peer with many connections has one peer's room and one peer's turns") {
  FairQueue queue(64);
  const auto connection = [](char peer, std::uint8_t number) {
    auto invocation = call_of(peer);
    invocation->connection.bytes[15] = number;
    return invocation;
  };
  std::size_t taken = 0;
  for (std::uint8_t i = 0; i < 100; ++i) {
    auto call = connection('a', i);
    if (!queue.has_room(call->connection)) continue;
    queue.push(std::move(call));
    ++taken;
  }
  CHECK(taken == 32);
  for (int i = 0; i < 3; ++i) queue.push(connection('b', 1));
  queue.push(connection('b', 2));
  std::string order;
  for (int i = 0; i < 8; ++i) {
    const auto next = queue.pop();
    order += static_cast<char>(next->connection.bytes[0]);
    order += std::to_string(next->connection.bytes[15]);
  }
  CHECK(order == "a0b1a1b2a2b1a3b1");
}

TEST_CASE("ten thousand waiting invocations go without harm to the stack") {
  FairQueue queue(100'000);
  for (int i = 0; i < 10'000; ++i) queue.push(call_of('a'));
  CHECK(queue.size() == 10'000);
}

TEST_CASE("a client with one call is served second, however many another has waiting") {
  Office office(2048);
  int accepted = 0;
  for (int i = 0; i < 5000; ++i) accepted += office.submit('a');
  CHECK(accepted == 1024);
  CHECK(office.submit('b'));
  office.executor.run_all();
  REQUIRE(office.answered.size() == 1025);
  CHECK(office.answered.substr(0, 3) == "aba");
}

TEST_CASE("what waits beyond its deadline is answered as failed, and none is forgotten") {
  Office office(64);
  for (int i = 0; i < 10; ++i) REQUIRE(office.submit('a'));
  office.clock.advance(std::chrono::seconds(2));
  REQUIRE(office.submit('b'));
  office.executor.run_all();
  CHECK(office.failed == std::string(10, 'a'));
  CHECK(office.answered == "b");
}
