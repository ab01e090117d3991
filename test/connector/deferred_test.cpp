#include <atomic>
#include <catch2/catch.hpp>
#include <deque>
#include <functional>
#include <future>
#include <thread>

#include "brokerless_discovery/broker.hpp"
#include "echo_service.hpp"
#include "pairing.hpp"
#include "skein/introspection.idl.hpp"
#include "skein/loopback.hpp"
#include "test/tools/eventually.hpp"
#include "test/tools/invariant.hpp"
#include "test/tools/log.hpp"

using namespace skein;
using namespace skein::test;
using namespace std::chrono_literals;
using ::test::Desk;
using ::test::Desk_divide_Out;
using ::test::DivisionByZero;
using ::test::Echo;

namespace {

/// Keeps what it is asked until the test takes it; answers all else at once, on another thread.
class ParkingDesk : public Desk::Deferred {
 public:
  struct Parked {
    const std::string& question;  // lives as long as the reply
    Reply<std::string> reply;
  };

  ~ParkingDesk() override { join(); }

  /// Waits for those of its threads that answer. Whoever answers last may let go of the desk last,
  /// and cannot wait for itself.
  void join() {
    std::vector<std::thread> threads;
    {
      std::lock_guard lock(mutex_);
      threads.swap(threads_);
    }
    for (std::thread& each : threads) each.join();
  }

  void ask(const std::string& question, Reply<std::string> reply) override {
    if (question == "throw") throw std::runtime_error("no such luck");
    std::lock_guard lock(mutex_);
    parked_.push_back({question, std::move(reply)});
  }
  void divide(std::int32_t dividend, std::int32_t divisor, const std::string& trace,
              Reply<Desk_divide_Out> reply) override {
    later([dividend, divisor, &trace, reply]() {
      reply.answer_with([&] {
        if (divisor == 0) throw DivisionByZero(dividend);
        return Desk_divide_Out{dividend / divisor, trace + " desk", dividend % divisor};
      });
    });
  }
  void touch(Reply<void> reply) override {
    later([reply]() { reply.answer(); });
  }
  void note(const std::string&) override { ++noted; }
  void count_up(std::int32_t count, StreamSink<std::int32_t>& sink) override {
    for (std::int32_t i = 0; i < count; ++i) sink.push(i);
  }
  void label(Reply<std::string> reply) override { reply.answer(label_); }
  void label(const std::string& value, Reply<void> reply) override {
    label_ = value;
    reply.answer();
  }

  std::size_t parked() const {
    std::lock_guard lock(mutex_);
    return parked_.size();
  }
  Parked take() {
    std::lock_guard lock(mutex_);
    Parked first = std::move(parked_.front());
    parked_.pop_front();
    return first;
  }

  std::atomic<int> noted{0};

 private:
  void later(std::function<void()> task) {
    std::lock_guard lock(mutex_);
    threads_.emplace_back(std::move(task));
  }

  mutable std::mutex mutex_;
  std::deque<Parked> parked_;
  std::vector<std::thread> threads_;
  std::string label_ = "desk";
};

/// A desk with one thread, and a client: of another entity, or of the same process.
struct Office {
  explicit Office(bool same_process = false)
      : server(make_server()), client(make_client()), desk(std::make_shared<ParkingDesk>()) {
    id = server->provide<Desk>(desk);
    proxy.emplace((same_process ? server : client)->connect<Desk>());
  }
  ~Office() {
    if (desk) desk->join();
  }

  ParkingDesk::Parked take() {
    REQUIRE(eventually([&] { return desk->parked() > 0; }));
    return desk->take();
  }
  introspection::OperationStatistics statistics() const {
    return server->statistics().front().operations.front();
  }

  std::unique_ptr<Entity> server;
  std::unique_ptr<Entity> client;
  std::shared_ptr<ParkingDesk> desk;
  Guid id;
  std::optional<Desk::Proxy> proxy;
};

std::string error_of(Call<std::string>& call) {
  try {
    return "none: " + call.get();
  } catch (const Error& error) {
    return std::string(to_string(error.code())) + ": " + error.what();
  }
}

}  // namespace

TEST_CASE("calls that are answered later occupy no thread meanwhile", "[wire]") {
  Office office(GENERATE(false, true));
  std::vector<Call<std::string>> calls;
  for (int i = 0; i < 20; ++i) calls.push_back(office.proxy->async_ask(std::to_string(i)));
  REQUIRE(eventually([&] { return office.desk->parked() == 20; }));
  office.proxy->touch();  // the one thread is free
  CHECK(office.server->statistics().front().running == 20);
  for (int i = 0; i < 20; ++i) {
    auto [question, reply] = office.take();
    CHECK(reply.answer("answer " + question));
  }
  for (int i = 0; i < 20; ++i) {
    INVARIANT(calls[static_cast<std::size_t>(i)].get() == "answer " + std::to_string(i));
  }
  CHECK(eventually([&] { return office.server->statistics().front().running == 0; }));
}

TEST_CASE("an implementation that answers later has all that an interface may have", "[wire]") {
  Office office(GENERATE(false, true));
  std::string trace = "client";
  std::int32_t remainder = 0;
  CHECK(office.proxy->divide(17, 5, trace, remainder) == 3);
  CHECK(trace == "client desk");
  CHECK(remainder == 2);
  CHECK_THROWS_AS(office.proxy->divide(17, 0, trace, remainder), DivisionByZero);
  office.proxy->label("other");
  CHECK(office.proxy->label() == "other");
  office.proxy->note("this");
  CHECK(eventually([&] { return office.desk->noted == 1; }));
  std::int32_t expected = 0;
  for (const std::int32_t number : office.proxy->count_up(30)) CHECK(number == expected++);
  CHECK(expected == 30);
}

TEST_CASE("what a call is answered with later arrives as if it had been thrown", "[wire]") {
  Office office(GENERATE(false, true));
  auto call = office.proxy->async_ask("what?");
  auto [question, reply] = office.take();
  SECTION("one of Skein's errors as itself") {
    CHECK(reply.fail(Overloaded("not now")));
    CHECK_THROWS_AS(call.get(), Overloaded);
  }
  SECTION("what the operation does not declare as Internal") {
    CHECK(reply.fail(DivisionByZero(1)));
    CHECK_THROWS_AS(call.get(), Internal);
  }
  SECTION("what CDR cannot carry as Internal") {
    CHECK(reply.answer(std::string("a\0b", 3)));
    if (office.proxy->channel()->peer().find("this process") == std::string::npos)
      CHECK_THROWS_AS(call.get(), Internal);
  }
}

TEST_CASE("what an operation throws ends a call that was to be answered later", "[wire]") {
  Office office(GENERATE(false, true));
  auto call = office.proxy->async_ask("throw");
  CHECK(error_of(call).find("'ask' failed: no such luck") != std::string::npos);
}

TEST_CASE("a reply that is dropped gives the caller an error that says so", "[wire]") {
  Office office(GENERATE(false, true));
  auto call = office.proxy->async_ask("what?");
  {
    const auto parked = office.take();
    const auto copy = parked.reply;
    CHECK_FALSE(call.ready());
  }
  CHECK_THAT(error_of(call),
             Catch::StartsWith("Internal") &&
                 Catch::EndsWith("'ask' was not answered: its implementation dropped the Reply"));
}

TEST_CASE("the second answer to a call has no effect, and is told", "[wire]") {
  const Log log;
  Office office(GENERATE(false, true));
  auto call = office.proxy->async_ask("what?");
  auto [question, reply] = office.take();
  auto copy = reply;
  CHECK(reply.answer("this"));
  CHECK_FALSE(copy.answer("that"));
  CHECK_FALSE(reply.fail(Internal("or nothing")));
  CHECK(call.get() == "this");
  CHECK(log.count("test/Desk: an answer to 'ask' goes nowhere: it was answered before") == 2);
}

TEST_CASE("the implementation hears that a call was cancelled", "[wire]") {
  const Log log;
  Office office(GENERATE(false, true));
  std::optional<Call<std::string>> call = office.proxy->async_ask("what?");
  auto [question, reply] = office.take();
  CHECK_FALSE(reply.call().cancelled());
  std::atomic<int> told{0};
  reply.on_cancel([&] { ++told; });
  SECTION("by its caller") {
    call.reset();
    CHECK(eventually([&] { return told == 1; }));
  }
  SECTION("as its client has left") {
    office.proxy->disconnect();
    CHECK(eventually([&] { return told == 1; }));
  }
  CHECK(reply.call().cancelled());
  std::atomic<bool> at_once{false};
  reply.on_cancel([&] { at_once = true; });
  CHECK(at_once);
  CHECK(reply.answer("nobody hears it"));
  CHECK(told == 1);
  CHECK(log.text() == "");
}

TEST_CASE("a call that is not answered in time ends at its deadline, and the answer goes nowhere",
          "[wire]") {
  Office office(GENERATE(false, true));
  auto call = office.proxy->within(50ms).async_ask("what?");
  auto [question, reply] = office.take();
  CHECK(reply.call().remaining() <= 50ms);
  CHECK_THROWS_AS(call.get(), TimedOut);
  CHECK(eventually([&] { return reply.call().cancelled(); }));
  CHECK(reply.answer("too late"));
  office.proxy->touch();
  CHECK(office.statistics().failed + office.statistics().answered == 1);
}

TEST_CASE("when its service is withdrawn, a call that has no answer ends", "[wire]") {
  const Log log;
  Office office(GENERATE(false, true));
  auto call = office.proxy->async_ask("what?");
  auto [question, reply] = office.take();
  bool told = false;
  reply.on_cancel([&] { told = true; });
  SECTION("with the service") { office.server->withdraw(office.id); }
  SECTION("with the entity") { office.server.reset(); }
  SECTION("as it was drained, and the patience is over") {
    CHECK_FALSE(office.server->drain(0s));
    office.server.reset();
  }
  CHECK(told);
  CHECK_THROWS_AS(call.get(), Disconnected);
  CHECK(reply.call().cancelled());
  CHECK_FALSE(reply.answer("too late"));
  CHECK(log.count("'ask' goes nowhere: its service was withdrawn") == 1);
}

TEST_CASE("a provider that is drained waits for the answers that it owes", "[wire]") {
  const Log log;
  const bool same_process = GENERATE(false, true);
  Office office(same_process);
  auto call = office.proxy->within(10min).async_ask("what?");
  auto [question, reply] = office.take();
  const auto copy = reply;
  auto drained = std::async(std::launch::async, [&] { return office.server->drain(10min); });
  auto& broker = (same_process ? office.server : office.client)->broker();
  REQUIRE(eventually([&] { return broker.find_service(broker.query("test::Desk")).empty(); }));
  CHECK(drained.wait_for(0s) == std::future_status::timeout);
  CHECK(reply.answer("that"));
  CHECK(call.get() == "that");
  CHECK(drained.get());
  office.server.reset();
  CHECK_FALSE(copy.answer("this"));
  CHECK(log.count("'ask' goes nowhere: it was answered before") == 1);
}

TEST_CASE("an entity ends at once, whatever answers its implementations owe", "[wire]") {
  Office office(GENERATE(false, true));
  std::vector<Call<std::string>> calls;
  for (int i = 0; i < 5; ++i) calls.push_back(office.proxy->async_ask("what?"));
  REQUIRE(eventually([&] { return office.desk->parked() == 5; }));
  const std::weak_ptr<ParkingDesk> desk = office.desk;
  office.desk.reset();
  office.server.reset();
  CHECK(desk.expired());
  for (auto& call : calls) CHECK_THROWS_AS(call.get(), Disconnected);
}

TEST_CASE_METHOD(Office, "a client that is gone cancels its calls, and their answers go nowhere",
                 "[wire]") {
  auto call = proxy->async_ask("what?");
  auto [question, reply] = take();
  client.reset();
  CHECK_THROWS_AS(call.get(), Disconnected);
  CHECK(eventually([&] { return reply.call().cancelled(); }));
  CHECK(reply.answer("nobody hears it"));
}

namespace {

/// Asks another service, and answers when that has.
class Forwarding : public ParkingDesk {
 public:
  explicit Forwarding(Desk::Proxy next) : next_(std::move(next)) {}

  void ask(const std::string& question, Reply<std::string> reply) override {
    auto call = next_.within(reply.call().remaining()).async_ask(question);
    reply.on_cancel(call.canceller());
    std::move(call).then(
        [reply](Call<std::string> ended) { reply.answer_with([&] { return ended.get() + "!"; }); });
  }

 private:
  Desk::Proxy next_;
};

/// A desk, and a service that forwards to it, each with one thread.
struct Chain : Office {
  Chain() : middle(make_entity("middle", Pairing::get().server)) {
    middle->provide<Desk>(std::make_shared<Forwarding>(server->connect<Desk>({.name = "server"})));
    proxy.emplace(client->connect<Desk>({.name = "middle"}));
  }
  std::unique_ptr<Entity> middle;
};

}  // namespace

TEST_CASE("a service that calls another one holds no thread meanwhile", "[wire]") {
  Chain chain;
  std::vector<Call<std::string>> calls;
  for (int i = 0; i < 20; ++i) calls.push_back(chain.proxy->async_ask("hello"));
  REQUIRE(eventually([&] { return chain.desk->parked() == 20; }));  // all of them, by one thread
  for (int i = 0; i < 20; ++i) chain.take().reply.answer("yes");
  for (auto& call : calls) INVARIANT(call.get() == "yes!");
}

TEST_CASE("cancelling a call that is answered later cancels those that it waits for", "[wire]") {
  Chain chain;
  std::optional<Call<std::string>> call = chain.proxy->async_ask("hello");
  const auto [question, reply] = chain.take();
  call.reset();
  CHECK(eventually([&] { return reply.call().cancelled(); }));
}

TEST_CASE_METHOD(Office,
                 "a call that is answered later waits for no thread, and so not for itself") {
  auto call = proxy->async_ask("what?");
  auto [question, reply] = take();
  {
    const CallContextScope scope(reply.call());
    CHECK(proxy->label() == "desk");  // blocking, and by the thread that the call is not on
  }
  CHECK(reply.answer("that"));
  CHECK(call.get() == "that");
}

TEST_CASE("a service that answers later cannot run on its callers' threads") {
  const auto server = make_server();
  CHECK_THROWS_WITH(
      server->provide<Desk>(std::make_shared<ParkingDesk>(), {.thread = CallThread::Caller}),
      Catch::Contains("answers later") && Catch::Contains("give it CallThread::Own"));
}

TEST_CASE("a service owes a client no more than half of the answers that it may owe") {
  const auto server = make_server();
  const auto client = make_client();
  const auto desk = std::make_shared<ParkingDesk>();
  server->provide<Desk>(desk, {.queue = 8});
  auto proxy = client->connect<Desk>();
  std::vector<Call<std::string>> calls;
  for (std::size_t i = 0; i < 4; ++i) {
    calls.push_back(proxy.async_ask("what?"));
    REQUIRE(eventually([&] { return desk->parked() == i + 1; }));
  }
  CHECK_THROWS_AS(proxy.ask("one more"), Overloaded);
  auto other = server->connect<Desk>().async_ask("of another one");
  CHECK(eventually([&] { return desk->parked() == 5; }));
  CHECK(desk->take().reply.answer("room again"));
  CHECK(calls.front().get() == "room again");
  auto again = proxy.async_ask("what?");
  CHECK(eventually([&] { return desk->parked() == 5; }));
}

TEST_CASE("a call that is answered later runs until its answer, by the statistics") {
  const auto clock = std::make_shared<ManualClock>();
  dds::LoopbackNetwork network(*clock);
  Entity server(
      {.name = "server", .vendor = network.vendor(), .process = std::make_shared<Process>(clock)});
  const auto desk = std::make_shared<ParkingDesk>();
  server.provide<Desk>(desk);
  auto proxy = server.connect<Desk>();
  auto call = proxy.async_ask("what?");
  REQUIRE(eventually([&] { return desk->parked() == 1; }));
  clock->advance(1s);
  desk->take().reply.answer("that");
  CHECK(call.get() == "that");
  const auto statistics = server.statistics().front().operations.front();
  CHECK(statistics.answered == 1);
  CHECK(statistics.ran.mean == 1'000'000'000);
}
