#include <catch2/catch.hpp>
#include <csignal>
#include <optional>

#include "test/connector/echo_service.hpp"
#include "test/faults/processes.hpp"
#include "test/tools/invariant.hpp"

using namespace skein;
using namespace skein::test;
using namespace std::chrono_literals;
using ::test::LouderEcho;

namespace {

/// So long that the server's silence is nobody's end.
constexpr std::chrono::milliseconds kLongLease{60'000};

/// A provider that has answered one call.
struct OneProvider {
  OneProvider() {
    echo.emplace(client->connect<LouderEcho>({.timeout = 20s}));
    CHECK(echo->within(20s).wait(0));
  }
  ChildProcess server = start_provider("server", *Pairing::get().server, {"lease=60000"});
  const std::unique_ptr<Entity> client =
      entity_with_lease("client", Pairing::get().client, kLongLease);
  std::optional<LouderEcho::Proxy> echo;
};

}  // namespace

TEST_CASE_METHOD(
    OneProvider,
    "what waited in a stopped server's socket until its time was over is not executed") {
  CHECK(server.ask("calls") == "calls 1");

  server.signal(SIGSTOP);
  for (int round = 0; round < 5; ++round) {
    std::vector<Call<bool>> calls;
    for (int i = 0; i < 10; ++i) calls.push_back(echo->within(200ms).async_wait(0));
    for (auto& call : calls) CHECK_THROWS_AS(call.get(), TimedOut);
  }
  let_last(kNear);
  server.signal(SIGCONT);
  CHECK(echo->within(20s).wait(0));
  const std::string executed = server.ask("calls");
  INVARIANT(executed == "calls 2");
}

TEST_CASE_METHOD(OneProvider,
                 "a call with time left is executed by a server that was stopped meanwhile") {
  server.signal(SIGSTOP);
  auto patient = echo->within(20s).async_wait(0);
  CHECK_THROWS_AS(echo->within(200ms).wait(0), TimedOut);
  server.signal(SIGCONT);
  CHECK(patient.get());
}
