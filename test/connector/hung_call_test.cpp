#include <malloc.h>

#include <atomic>
#include <catch2/catch.hpp>

#include "echo_service.hpp"
#include "pairing.hpp"
#include "test/tools/eventually.hpp"
#include "test/tools/threads.hpp"

using namespace skein;
using namespace skein::test;
using namespace std::chrono_literals;
using ::test::Echo;
using ::test::LouderEcho;

namespace {

/// Hangs, whatever it is told, until it is released; then uses the Head once more, if it has one.
class DeafService final : public EchoService {
 public:
  explicit DeafService(Head* head = nullptr) : head_(head) {}

  std::string echo(const std::string& text) override {
    hang();
    return text;
  }
  void count_up(std::int32_t, std::int32_t, StreamSink<std::int32_t>& sink) override {
    hang();
    sink.push(0);
  }

  std::atomic<int> hanging{0};
  std::atomic<bool> released{false};
  std::atomic<bool> degraded{false};

 private:
  void hang() {
    ++hanging;
    released.wait(false);
    if (head_) degraded = head_->degraded();
  }

  Head* const head_;
};

/// A service whose threads hang in a call and in a stream of a client in another entity.
struct HungCalls {
  HungCalls() { mallopt(M_PERTURB, 0xa5); }  // what is used after it was freed makes no sense

  std::unique_ptr<Entity> server = make_server("deaf");
  std::unique_ptr<Entity> client = make_client();
  std::shared_ptr<DeafService> deaf;
  Guid id;
  std::optional<Call<std::string>> call;
  std::optional<Stream<std::int32_t>> stream;

  /// A CSP of the client, or a Body, which uses its Head.
  void provide(bool csp) {
    ServiceOptions options;
    options.threads = 2;
    deaf = std::make_shared<DeafService>(csp ? nullptr : &server->head());
    id = csp ? server->provide_csp<LouderEcho>("deaf", client->id(), deaf, options)
             : server->provide<LouderEcho>(deaf, options);
  }

  void call_it() {
    auto echo = client->connect<Echo>({.timeout = 20s}).within(10min);
    call.emplace(echo.async_echo("x"));
    stream.emplace(echo.count_up(1, -1));
    REQUIRE(eventually([&] { return deaf->hanging == 2; }));
  }

  /// Its threads come back, and have done all that they do.
  void release() {
    REQUIRE(!threads_named("deaf").empty());
    deaf->released = true;
    deaf->released.notify_all();
    CHECK(eventually([&] { return threads_named("deaf").empty(); }));
    CHECK_FALSE(deaf->degraded);
  }
};

}  // namespace

TEST_CASE("calls that return after their entity has been destroyed touch nothing", "[wire]") {
  HungCalls calls;
  calls.provide(GENERATE(true, false));
  calls.call_it();
  calls.server.reset();
  CHECK_THROWS_AS(calls.call->get(), Disconnected);
  calls.release();
  CHECK_THROWS_AS(calls.stream->next(), Disconnected);
}

TEST_CASE("calls that return after their service was withdrawn touch nothing") {
  HungCalls calls;
  calls.provide(GENERATE(true, false));
  calls.call_it();
  calls.server->withdraw(calls.id);
  CHECK_THROWS_AS(calls.call->get(), Disconnected);
  SECTION("while their entity is there") {}
  SECTION("after it has been destroyed, too") { calls.server.reset(); }
  calls.release();
  CHECK_THROWS_AS(calls.stream->next(), Disconnected);
}
