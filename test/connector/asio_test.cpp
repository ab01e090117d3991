#include "skein/asio.hpp"

#include <asio.hpp>
#include <catch2/catch.hpp>
#include <future>
#include <thread>

#include "echo_service.hpp"
#include "pairing.hpp"
#include "test/tools/eventually.hpp"

using namespace skein;
using namespace skein::test;
using namespace std::chrono_literals;
using ::test::Echo;
using ::test::LouderEcho;

namespace {

// A service in one entity, a client of it in another.
struct Called {
  std::unique_ptr<Entity> server = make_server();
  std::shared_ptr<EchoService> service = std::make_shared<EchoService>();
  Guid id = server->provide<LouderEcho>(service);
  std::unique_ptr<Entity> client = make_client();
  Echo::Proxy echo = client->connect<Echo>();
};

asio::awaitable<std::string> echo_twice(Echo::Proxy echo, std::string text) {
  const std::string once = co_await async_wait(echo.async_echo(text), asio::use_awaitable);
  co_return co_await async_wait(echo.async_echo(once + once), asio::use_awaitable);
}

template <class Error>
bool is(const std::exception_ptr& error) {
  try {
    if (error) std::rethrow_exception(error);
  } catch (const Error&) {
    return true;
  } catch (...) {
  }
  return false;
}

}  // namespace

TEST_CASE_METHOD(Called,
                 "with use_future a call is a std::future of its result, or of what ended it") {
  CHECK(async_wait(echo.async_echo("x"), asio::use_future).get() == "x");
  async_wait(echo.async_label("new"), asio::use_future).get();
  CHECK(echo.label() == "new");
  auto failed = async_wait(echo.async_divide(1, 0), asio::use_future);
  CHECK_THROWS_AS(failed.get(), ::test::DivisionByZero);
}

TEST_CASE_METHOD(Called, "with use_awaitable a coroutine of Asio waits for calls") {
  asio::io_context context;
  auto twice = asio::co_spawn(context, echo_twice(echo, "ab"), asio::use_future);
  context.run();
  CHECK(twice.get() == "abab");
}

TEST_CASE_METHOD(Called,
                 "a callback bound to an executor runs there, and the executor waits for it") {
  asio::io_context context;
  std::thread::id ran_on;
  std::string result;
  async_wait(echo.async_echo("x"),
             asio::bind_executor(context, [&](std::exception_ptr error, std::string text) {
               CHECK_FALSE(error);
               result = std::move(text);
               ran_on = std::this_thread::get_id();
             }));
  context.run();  // returns when nothing is outstanding any more
  CHECK(result == "x");
  CHECK(ran_on == std::this_thread::get_id());
}

TEST_CASE_METHOD(Called, "a callback may be movable only") {
  std::promise<std::string> done;
  auto future = done.get_future();
  async_wait(echo.async_echo("x"),
             [done = std::move(done)](std::exception_ptr, std::string text) mutable {
               done.set_value(std::move(text));
             });
  CHECK(future.get() == "x");
}

TEST_CASE_METHOD(Called,
                 "the cancellation slot's signal cancels the call, here and at the server") {
  asio::io_context context;
  asio::cancellation_signal signal;
  bool cancelled = false;
  async_wait(echo.within(10min).async_wait(600'000),
             asio::bind_cancellation_slot(
                 signal.slot(), asio::bind_executor(context, [&](std::exception_ptr error, bool) {
                   cancelled = is<Cancelled>(error);
                 })));
  REQUIRE(eventually([&] { return service->inside == 1; }));
  asio::post(context, [&] { signal.emit(asio::cancellation_type::terminal); });
  context.run();
  CHECK(cancelled);
  CHECK(eventually([&] { return service->saw_cancellation.load(); }));
}

TEST_CASE_METHOD(Called, "a signal after the end of a call does nothing") {
  asio::io_context context;
  asio::cancellation_signal signal;
  int ended = 0;
  async_wait(
      echo.async_count(),
      asio::bind_cancellation_slot(
          signal.slot(), asio::bind_executor(context, [&](std::exception_ptr error, std::uint64_t) {
            ended += error ? 10 : 1;
          })));
  context.run();
  signal.emit(asio::cancellation_type::terminal);
  CHECK(ended == 1);
}
