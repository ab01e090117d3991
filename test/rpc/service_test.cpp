#include "rpc/service/service.hpp"

#include <atomic>
#include <catch2/catch.hpp>
#include <chrono>
#include <functional>
#include <future>
#include <memory>
#include <string>
#include <thread>

#include "rpc/service/reception.hpp"
#include "skein/error.hpp"
#include "test/connector/echo_service.hpp"
#include "test/tools/eventually.hpp"

using namespace skein;
using namespace std::chrono_literals;

namespace {

/// What a service asks, and what may go once the service is closed.
struct Owner {
  std::promise<void> asked;
  std::promise<void> closed;
  std::atomic<bool> awaited{false};

  void answer() {
    asked.set_value();
    awaited = closed.get_future().wait_for(50ms) == std::future_status::timeout;
  }
};

std::shared_ptr<rpc::Service> make_service(const rpc::Service::Options& options) {
  static ManualClock clock;
  static ManualExecutor executor;
  return std::make_shared<rpc::Service>(
      std::make_shared<::test::LouderEcho::Skeleton>(std::make_shared<skein::test::EchoService>()),
      executor, clock, options);
}

/// Answers within the operation.
class PromptDesk : public ::test::Desk::Deferred {
  void ask(const std::string& question, Reply<std::string> reply) override {
    reply.answer(question);
  }
  void divide(std::int32_t, std::int32_t, const std::string&,
              Reply<::test::Desk_divide_Out> reply) override {
    reply.answer({});
  }
  void touch(Reply<void> reply) override { reply.answer(); }
  void note(const std::string&) override {}
  void count_up(std::int32_t, StreamSink<std::int32_t>&) override {}
  void label(Reply<std::string> reply) override { reply.answer("desk"); }
  void label(const std::string&, Reply<void> reply) override { reply.answer(); }
};

const OperationInfo* operation_of(const rpc::Service& service, std::string_view name) {
  for (const OperationInfo& operation : service.interface_info().operations) {
    if (operation.name == name) return &operation;
  }
  return nullptr;
}

/// Requests as a thread takes them that waits for them: `bring` says what comes while it does.
struct Requests final : calls::CallerDelivery {
  void lend() override {}
  void pause() override {}
  void take_back() override { ++given_back; }
  void deliver_until(const std::function<bool()>& over) override {
    bring();
    over();
  }
  void wake() override {}

  std::function<void()> bring = [] {};
  int given_back = 0;
};

/// A service whose own thread takes its requests, if `bring` is called in receive(); what is said
/// to it runs inside.
struct OnArrival {
  struct Hearer : skein::test::EchoService {
    std::string echo(const std::string& text) override {
      inside(text);
      return text;
    }
    std::function<void(const std::string&)> inside;
  };

  OnArrival() {
    hearer->inside = [this](const std::string& text) { heard += text; };
    rpc::Service::Options options;
    options.thread = thread;
    service = std::make_shared<rpc::Service>(std::make_shared<::test::LouderEcho::Skeleton>(hearer),
                                             executor, clock, options);
  }

  /// On the service's own thread, while it waits for requests.
  void receive(const std::string& text) {
    requests->bring = [&] { bring(text); };
    rpc::Reception(*service, requests).work_until([] { return false; });
  }

  void bring(const std::string& text) {
    auto invocation = std::make_shared<rpc::Invocation>();
    invocation->operation = operation_of(*service, "echo");
    invocation->in = {invocation->operation->in->make(), invocation->operation->in->destroy};
    *static_cast<::test::Echo_echo_In*>(invocation->in.get()) = {text};
    invocation->deadline = clock.now() + 1h;
    invocation->respond = [](const void*, const std::exception_ptr&) {};
    service->submit(invocation, [this] { return may_run; });
  }

  const CallThread thread = GENERATE(CallThread::Own, CallThread::Caller);
  const std::shared_ptr<Requests> requests = std::make_shared<Requests>();
  ManualClock clock;
  ManualExecutor executor;
  const std::shared_ptr<Hearer> hearer = std::make_shared<Hearer>();
  std::shared_ptr<rpc::Service> service;
  std::string heard;
  bool may_run = true;
};

bool never() { return false; }

void refuse_self_wait(rpc::Service& service) {
  const auto invocation = std::make_shared<rpc::Invocation>();
  invocation->operation = operation_of(service, "echo");
  invocation->chain = {service.id()};
  CHECK_THROWS_WITH(service.submit(invocation), Catch::Contains("would wait for itself"));
}

}  // namespace

TEST_CASE("close() waits for what asks the service's owner") {
  Owner owner;
  rpc::Service::Options options;
  options.open = [&](const rpc::OpenRequest&) -> std::shared_ptr<Session> {
    owner.answer();
    return nullptr;
  };
  options.name_of = [&](const Guid&) {
    owner.answer();
    return std::string("owner");
  };
  const auto service = make_service(options);
  std::function<void()> ask;
  SECTION("for a session") {
    ask = [&] { service->open({}); };
  }
  SECTION("for a name") {
    ask = [&] { refuse_self_wait(*service); };
  }
  std::thread client(ask);
  owner.asked.get_future().wait();
  service->close();
  owner.closed.set_value();
  client.join();
  CHECK(owner.awaited);
}

TEST_CASE("a closed service asks its owner nothing") {
  rpc::Service::Options options;
  options.open = [&](const rpc::OpenRequest&) -> std::shared_ptr<Session> {
    FAIL("it was asked for a session");
    return nullptr;
  };
  options.name_of = [&](const Guid&) -> std::string {
    FAIL("it was asked for a name");
    return "";
  };
  const auto service = make_service(options);
  service->close();
  CHECK_THROWS_AS(service->open({}), Unavailable);
  refuse_self_wait(*service);
}

TEST_CASE("a service that is to finish waits for each answer, and then refuses what comes") {
  ManualClock clock;
  ManualExecutor executor;
  const auto service = std::make_shared<rpc::Service>(std::make_shared<PromptDesk>(), executor,
                                                      clock, rpc::Service::Options{});
  const auto finished = [&] { return service->finish(clock.now()); };
  int answers = 0;
  const auto invocation = std::make_shared<rpc::Invocation>();
  invocation->operation = operation_of(*service, GENERATE("touch", "note"));
  invocation->in = {invocation->operation->in->make(), invocation->operation->in->destroy};
  invocation->deadline = clock.now() + 1s;
  invocation->respond = [&](const void*, const std::exception_ptr&) {
    ++answers;
    CHECK_FALSE(finished());
  };
  service->leave();
  service->submit(invocation);
  CHECK_FALSE(finished());
  executor.run_all();
  CHECK(answers == 1);
  CHECK(finished());
  CHECK_THROWS_AS(service->submit(invocation), NotSent);
}

TEST_CASE_METHOD(OnArrival, "a service's own thread runs a request where it takes it") {
  bring("1");  // on another thread
  CHECK(heard.empty());
  executor.run_all();
  CHECK(heard == "1");
  receive("2");
  CHECK(heard == "12");
  CHECK(requests->given_back == 0);
  may_run = false;
  receive("3");
  CHECK(heard == "12");
  executor.run_all();
  CHECK(heard == "123");
}

TEST_CASE_METHOD(OnArrival, "a call that could run on arrival does not overtake one that waits") {
  hearer->inside = [&](const std::string& text) {
    if (text == "1") std::thread([this] { bring("2"); }).join();
    heard += text;
  };
  receive("1");
  CHECK(heard == "1");
  receive("3");
  CHECK(heard == "1");
  executor.run_all();
  CHECK(heard == "123");
  receive("4");
  CHECK(heard == "1234");
}

TEST_CASE_METHOD(OnArrival, "after a call of over a millisecond what has come meanwhile queues") {
  const auto runs_on_arrival = [&](Duration time) {
    hearer->inside = [this, time](const std::string& text) {
      clock.advance(time);
      heard += text;
    };
    heard.clear();
    receive("x");
    const bool at_once = heard == "x";
    executor.run_all();
    CHECK(heard == "x");
    return at_once;
  };
  CHECK(runs_on_arrival(1ms));
  CHECK(runs_on_arrival(2ms));
  CHECK_FALSE(runs_on_arrival(2ms));
  CHECK_FALSE(runs_on_arrival(1ms));
  CHECK(runs_on_arrival(1ms));
}

TEST_CASE("a stream, and a call that is answered later, never run where they arrive") {
  ManualClock clock;
  ManualExecutor executor;
  const auto service = std::make_shared<rpc::Service>(std::make_shared<PromptDesk>(), executor,
                                                      clock, rpc::Service::Options());
  const auto bring = [&](const char* name) {
    auto invocation = std::make_shared<rpc::Invocation>();
    invocation->operation = operation_of(*service, name);
    invocation->in = {invocation->operation->in->make(), invocation->operation->in->destroy};
    invocation->deadline = clock.now() + 1h;
    invocation->respond = [](const void*, const std::exception_ptr&) {};
    if (invocation->operation->stream) {
      invocation->stream =
          std::make_shared<rpc::OutgoingStream>(*invocation->operation, clock, invocation->deadline,
                                                1, [](const void*, std::uint64_t) {});
    }
    service->submit(invocation, [] { return true; });
  };
  const auto requests = std::make_shared<Requests>();
  rpc::Reception reception(*service, requests);
  const std::string name = GENERATE("ask", "count_up");
  requests->bring = [&] { bring(name.c_str()); };
  reception.work_until(never);
  CHECK(requests->given_back == (name == "ask" ? 0 : 1));
  CHECK(executor.run_all() == 1);
}

TEST_CASE("a stream whose caller takes nothing gives its thread back to the calls that wait") {
  ManualClock clock;
  ThreadExecutor executor("echo");
  const auto service = std::make_shared<rpc::Service>(
      std::make_shared<::test::LouderEcho::Skeleton>(std::make_shared<skein::test::EchoService>()),
      executor, clock, rpc::Service::Options());
  const auto ask = [&](const char* name, std::function<void(std::exception_ptr)> answered) {
    auto invocation = std::make_shared<rpc::Invocation>();
    invocation->operation = operation_of(*service, name);
    invocation->in = {invocation->operation->in->make(), invocation->operation->in->destroy};
    invocation->deadline = clock.now() + 10min;
    invocation->respond = [answered](const void*, const std::exception_ptr& error) {
      answered(error);
    };
    if (invocation->operation->stream) {
      *static_cast<::test::Echo_count_up_In*>(invocation->in.get()) = {1 << 30, -1};
      invocation->stream =
          std::make_shared<rpc::OutgoingStream>(*invocation->operation, clock, invocation->deadline,
                                                1, [](const void*, std::uint64_t) {});
    }
    service->submit(invocation);
  };
  std::promise<void> streamed;
  std::atomic<bool> answered = false;
  ask("count_up", [&](const std::exception_ptr& error) { streamed.set_exception(error); });
  ask("echo", [&](const std::exception_ptr& error) { answered = error == nullptr; });
  CHECK(skein::test::eventually([&] {
    clock.advance(100ms);
    return answered.load();
  }));
  CHECK_THROWS_AS(streamed.get_future().get(), Overloaded);
  service->close();
}
